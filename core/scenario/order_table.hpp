#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The transports of a scenario by their numbers: those of the AGVs, one AGV after the other, then the open ones.
class OrderTable {
 public:
  // Requires: the scenario outlives the object and keeps its transports.
  explicit OrderTable(const Scenario& scenario) {
    std::size_t count = scenario.open_orders.size();
    for (const AgvSetup& agv : scenario.agvs) count += agv.transports.size();
    lines_.reserve(count), first_of_.reserve(scenario.agvs.size());
    for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
      first_of_.push_back(static_cast<std::uint32_t>(lines_.size()));
      for (const TransportOrder& order : scenario.agvs[i].transports) lines_.push_back({&order, AgvId{i}});
    }
    first_open_ = static_cast<std::uint32_t>(lines_.size());
    for (const TransportOrder& order : scenario.open_orders) lines_.push_back({&order, AgvId{}});
  }

  std::size_t size() const { return lines_.size(); }
  bool has(TransportId transport) const { return transport.index() < lines_.size(); }
  // Requires, of these: there is such a transport.
  const TransportOrder& order(TransportId transport) const { return *lines_[transport.index()].order; }
  // The AGV to which the scenario gives the transport. Invalid: it is open.
  AgvId agv_of(TransportId transport) const { return lines_[transport.index()].agv; }
  bool is_open(TransportId transport) const { return !agv_of(transport).valid(); }
  // Its place in the list of that AGV, or in the list of the open ones.
  std::uint32_t place_of(TransportId transport) const { return transport.value - first_of(agv_of(transport)); }
  // The transport at this place of the list of the AGV; of an invalid one, of the open ones.
  TransportId at(AgvId agv, std::uint64_t place) const {
    return TransportId{static_cast<std::uint32_t>(first_of(agv) + place)};
  }

 private:
  std::uint32_t first_of(AgvId agv) const { return agv.valid() ? first_of_[agv.index()] : first_open_; }

  struct Line {
    const TransportOrder* order;
    AgvId agv;
  };
  std::vector<Line> lines_;              // by number of the transport
  std::vector<std::uint32_t> first_of_;  // by AGV: the number of its first transport
  std::uint32_t first_open_ = 0;
};

}  // namespace fleetproof
