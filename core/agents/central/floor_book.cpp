#include "core/agents/central/floor_book.hpp"

#include <algorithm>

namespace fleetproof::agents::central {

void FloorBook::recall(std::span<const AgvRecord> records) {
  for (std::uint32_t agv = 0; agv < records.size(); ++agv) {
    const auto& [state, grant, goals, charging] = records[agv];
    Way& way = ways_[agv];
    server_boot_ = state.way.server_boot;
    begin(way, state);
    way.done = way.known = grant.first;
    way.steps.assign(grant.steps.begin(), grant.steps.end());
    for (const Step& step : grant.steps) {
      if (step.drives()) way.held.append(step.what);
    }
  }
}

AgvRecord FloorBook::record_of(std::uint32_t agv) const {
  const Way& way = ways_[agv];
  AgvRecord record;
  record.state.way = number_of(agv);
  record.state.station = way.held.station;
  record.state.heading = way.held.heading;
  record.state.load = way.first_load;
  record.grant = {number_of(agv), way.done, {way.steps.begin(), way.steps.end()}};
  return record;
}

bool FloorBook::all_joined() const {
  return std::ranges::all_of(
      ways_, [&](const Way& way) { return way.joined || (way.out_of_order && !options_.failed_ones_join); });
}

FloorBook::News FloorBook::hear(std::uint32_t agv, const State& state) {
  Way& way = ways_[agv];
  if (!way.joined) way.out_of_order = state.out_of_order;
  const bool fails_early = state.out_of_order && state.known == 0 && way.granted() > 0;
  const bool starts_again = way.boot > 0 && way.granted() == 0 && state.way.agv_boot > way.boot && !state.stands;
  way.lost = (fails_early && !options_.failures_keep_floor) || (starts_again && !options_.restarts_keep_floor);
  if (state.way.server_boot != server_boot_ || !state.stands) return News::None;
  if (way.joined && state.way.agv_boot < way.boot) return News::None;
  const bool joins = !way.joined || state.way.agv_boot > way.boot;
  if (joins && !options_.restarts_are_believed && !way.steps.empty()) return News::None;
  if (joins) begin(way, state);
  if (joins || state.number > way.newest) {
    way.newest = state.number;
    way.battery = state.battery;
    way.out_of_order = state.out_of_order;
  }
  way.known = std::clamp(state.known, way.known, way.granted());
  const bool passed = pass(way, state.done);
  return joins ? News::Joined : passed ? News::Progress : News::None;
}

void FloorBook::begin(Way& way, const State& state) {
  const std::uint32_t changes = way.changes + 1;
  way = {};
  way.changes = changes;
  way.joined = true;
  way.boot = state.way.agv_boot;
  way.held.station = state.station;
  way.held.heading = state.heading;
  way.first_load = state.load;
}

bool FloorBook::pass(Way& way, std::uint32_t done) {
  const bool passes = way.done < done && !way.steps.empty();
  while (way.done < done && !way.steps.empty()) {
    if (way.steps.front().drives()) pass_first_lane(map_, way.held);
    way.steps.pop_front();
    ++way.done;
  }
  way.changes += passes ? 1 : 0;
  return passes;
}

bool FloorBook::is_free(std::uint32_t agv, const Path& path) {
  for (std::uint32_t other = 0; other < fleet_count(); ++other) {
    if (is_held_by(other, agv, path)) return false;
  }
  return true;
}

bool FloorBook::grant(std::uint32_t agv, std::span<const Step> steps) {
  Way& way = ways_[agv];
  if (!all_joined()) return false;
  Path longer = way.held, added = end_of(map_, way.held);
  for (const Step& step : steps) {
    if (step.drives() && (!longer.append(step.what) || !added.append(step.what))) return false;
  }
  if (!is_driveable(map_, longer) || !is_free(agv, added)) return false;
  way.held = longer;
  ++way.changes;
  way.steps.insert(way.steps.end(), steps.begin(), steps.end());
  return true;
}

Grant FloorBook::unknown_steps(std::uint32_t agv) const {
  const Way& way = ways_[agv];
  Grant grant{number_of(agv), std::max(way.known, way.done), {}};
  for (std::uint32_t i = grant.first; i < way.granted() && grant.steps.size() < kMostStepsInAMessage; ++i)
    grant.steps.push_back(way.steps[i - way.done]);
  return grant;
}

}  // namespace fleetproof::agents::central
