#include "core/engine/hearers.hpp"

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {
namespace {

// Reception needs a range test only where the floor is larger than the range.
bool covers(const Box& floor, double range_m) { return range_m > (floor.high_m - floor.low_m).norm(); }

Box floor_of(const LogicalMap& map) {
  Box box;
  for (const Station& station : map.layout().stations) box.add(station.position_m);
  for (const Segment& segment : map.layout().segments) {
    for (const Vec2& point : segment.control_points_m) box.add(point);
  }
  return box;
}

}  // namespace

Hearers::Hearers(RunContext& run)
    : run_(run), sent_to_(run.agvs.size()), near_(run.agvs.size() + 3), found_(run.agvs.size() + 3) {
  const Box floor = floor_of(*run.scenario.map);
  if (covers(floor, run.scenario.radio.range_m)) return;
  reach_.emplace(run.agvs.size(), run.scenario.radio.range_m, floor);
  for (std::size_t i = 0; i < run.agvs.size(); ++i) reach_->piece_begins(run.world.body(AgvId{i}).piece);
}

bool Hearers::is_in_range(AgvId receiver, const Vec2& from_m) const {
  return (run_.pose_now(receiver).position_m - from_m).norm() <= run_.scenario.radio.range_m;
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
  run_.counters.out_of_range += sent_to_.size() - 1 - agvs.size();
  return agvs;
}

std::span<const Hearer> Hearers::of(AgvId sender, std::uint32_t receiver, const Vec2& from_m) {
  SentTo& sent = sent_to_[sender.index()];
  if (sent.counts.empty()) sent.counts.resize(sent_to_.size());
  count_ = 0;
  if (receiver != FP_NONE) {
    if (are_everybody() || is_in_range(AgvId{receiver}, from_m)) {
      add_one(AgvId{receiver}, sent);
    } else {
      ++run_.counters.out_of_range;
    }
    return {found_.data(), count_};
  }
  if (are_everybody()) {
    for (std::uint32_t i = 0; i < sent_to_.size(); ++i) {
      if (i != sender.value) add(AgvId{i}, sent);
    }
  } else {
    for (const std::uint32_t agv : in_range(sender, from_m)) add(AgvId{agv}, sent);
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
