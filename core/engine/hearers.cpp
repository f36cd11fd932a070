#include "core/engine/hearers.hpp"

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {
namespace {

// Reception needs a range test only where the floor is larger than the range.
bool covers(const Box& floor, double range_m) { return range_m > (floor.high_m - floor.low_m).norm(); }

// With all antennas.
Box floor_of(const Scenario& scenario) {
  const Layout& layout = scenario.map->layout();
  Box box;
  for (const Station& station : layout.stations) box.add(station.position_m);
  for (const Segment& segment : layout.segments) {
    for (const Vec2& point : segment.control_points_m) box.add(point);
  }
  for (const ComputerSetup& computer : scenario.computers) {
    if (computer.at_m) box.add(*computer.at_m);
  }
  return box;
}

}  // namespace

Hearers::Hearers(RunContext& run)
    : run_(run),
      sent_to_(run.scenario.participant_count()),
      near_(run.agvs.size() + 3),
      found_(run.scenario.participant_count() + 3) {
  const Box floor = floor_of(run.scenario);
  if (covers(floor, run.scenario.radio.range_m)) return;
  reach_.emplace(run.agvs.size(), run.scenario.participant_count(), run.scenario.radio.range_m, floor);
  for (std::size_t i = 0; i < run.agvs.size(); ++i) reach_->piece_begins(run.world.body(AgvId{i}).piece);
}

bool Hearers::is_in_range(EntityId receiver, const std::optional<Vec2>& from_m) const {
  const std::optional<Vec2> at_m = run_.antenna_m(receiver);
  return !from_m || !at_m || (*at_m - *from_m).norm() <= run_.scenario.radio.range_m;
}

// The wire between two computers has no range.
bool Hearers::hears(EntityId receiver, EntityId sender, const std::optional<Vec2>& from_m) const {
  return are_everybody() || run_.scenario.are_wired(sender, receiver) || is_in_range(receiver, from_m);
}

std::span<const std::uint32_t> Hearers::in_range(AgvId sender, const Vec2& from_m) {
  auto [agvs, is_exact] = reach_->near(sender, from_m);
  if (!is_exact) {
    std::size_t count = 0;
    for (const std::uint32_t agv : agvs) {
      if (is_in_range(AgvId{agv}, from_m)) near_[count++] = agv;
    }
    agvs = std::span(near_).first(count);
  }
  run_.counters.out_of_range += run_.agvs.size() - (run_.scenario.is_agv(sender) ? 1 : 0) - agvs.size();
  return agvs;
}

std::span<const Hearer> Hearers::of(EntityId sender, std::uint32_t receiver, const std::optional<Vec2>& from_m) {
  SentTo& sent = sent_to_[sender.index()];
  if (sent.counts.empty()) sent.counts.resize(sent_to_.size());
  count_ = 0;
  if (receiver != FP_NONE) {
    if (hears(EntityId{receiver}, sender, from_m)) {
      add_one(EntityId{receiver}, sent);
    } else {
      ++run_.counters.out_of_range;
    }
    return {found_.data(), count_};
  }
  const bool all_agvs = are_everybody() || !from_m;
  if (all_agvs) {
    for (std::uint32_t i = 0; i < run_.agvs.size(); ++i) {
      if (i != sender.value) add(AgvId{i}, sent);
    }
  } else {
    for (const std::uint32_t agv : in_range(sender, *from_m)) add(AgvId{agv}, sent);
  }
  for (EntityId computer = run_.scenario.first_computer(); computer < run_.scenario.first_obstacle();
       ++computer.value) {
    if (computer == sender) continue;
    if (hears(computer, sender, from_m)) {
      add(computer, sent);
    } else {
      ++run_.counters.out_of_range;
    }
  }
  ++sent.to_all;
  return {found_.data(), count_};
}

void Hearers::add_one(AgvId receiver, SentTo& sent) {
  add(receiver, sent);
  std::uint32_t& count = sent.counts[receiver.index()];
  if (count == 0) sent.receivers.push_back(receiver);
  ++count;
}

}  // namespace fleetproof
