#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/byte_text.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// An AGV sets out from one station for the next. It may be stopped on the way.
struct Departure {
  AgvId agv;
  SimTime at{}, arrives{};  // arrives: as planned, at last; a stop may have come after it
  StationId from, to;
  Vec2 heading = Vec2::UnitX(), heading_there = Vec2::UnitX();
};
// A load is where it was to be brought.
struct DoneTransport {
  AgvId agv;
  TransportId transport;
  SimTime at{};
};

// Where the AGVs of a run were, and what they had done by then.
struct Itinerary {
  std::vector<Departure> departures;
  std::vector<Departure> turns;  // on the spot: from and to are one station, and the headings are not known
  std::vector<DoneTransport> done;
};
void put(ByteSink& sink, const Itinerary& itinerary);
Itinerary take_itinerary(ByteSource& source);

// Keeps them while the run goes on. Requires: the scenario outlives the object.
class ItineraryKeeper final : public TraceSink {
 public:
  explicit ItineraryKeeper(const Scenario& scenario) : scenario_(scenario) {}
  void record(const TraceRecord& record, std::string_view text) override;
  void piece_started(const Piece& piece) override;
  Itinerary take() { return std::move(found_); }

 private:
  void turned(const TraceRecord& record);

  const Scenario& scenario_;
  Itinerary found_;
};

}  // namespace fleetproof
