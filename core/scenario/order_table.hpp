#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The transports of a scenario by their numbers: those of the AGVs, one AGV after the other.
class OrderTable {
 public:
  // Requires: the scenario outlives the object and keeps its transports.
  explicit OrderTable(const Scenario& scenario) {
    std::size_t count = 0;
    for (const AgvSetup& agv : scenario.agvs) count += agv.transports.size();
    lines_.reserve(count), first_of_.reserve(scenario.agvs.size());
    for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
      first_of_.push_back(static_cast<std::uint32_t>(lines_.size()));
      for (const TransportOrder& order : scenario.agvs[i].transports) lines_.push_back({&order, AgvId{i}});
    }
  }

  std::size_t size() const { return lines_.size(); }
  bool has(TransportId transport) const { return transport.index() < lines_.size(); }
  // Requires, of these: there is such a transport.
  const TransportOrder& order(TransportId transport) const { return *lines_[transport.index()].order; }
  // The AGV to which the scenario gives the transport.
  AgvId agv_of(TransportId transport) const { return lines_[transport.index()].agv; }
  // Its place in the list of that AGV.
  std::uint32_t own_number(TransportId transport) const {
    return transport.value - first_of_[agv_of(transport).index()];
  }
  TransportId of_agv(AgvId agv, std::uint64_t own_number) const {
    return TransportId{static_cast<std::uint32_t>(first_of_[agv.index()] + own_number)};
  }

 private:
  struct Line {
    const TransportOrder* order;
    AgvId agv;
  };
  std::vector<Line> lines_;              // by number of the transport
  std::vector<std::uint32_t> first_of_;  // by AGV: the number of its first transport
};

}  // namespace fleetproof
