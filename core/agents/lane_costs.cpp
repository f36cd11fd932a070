#include "core/agents/lane_costs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/agents/aisles.hpp"
#include "core/agents/fleet.hpp"
#include "core/agents/least_costs.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/opposite_lanes.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {
namespace {

// So much dearer is a lane against the convention of aisles. To a goal near by, an AGV drives against it.
constexpr double kAgainstAisle = 2.0;

// Both fit: a map for hull-lock has at most 2^16 stations, and a campaign not so many AGVs.
constexpr std::uint32_t kModelShift = 16;

// Requires: not below 0.
float rounded_down(double value) {
  const auto near = static_cast<float>(value);
  return near > value ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(near) - 1) : near;
}

// For LeastCosts. The question names the model of the AGV.
std::span<const std::byte> costs_back(const fp_facts& facts, std::uint64_t question) {
  return ask<std::byte>(
      facts,
      [](const fp_facts* from, std::uint64_t of, fp_answer* to) {
        const MapView map(*from);
        const auto costs_s = lane_costs_s(HullParts(map, *from, HullKey(of)), HullKey::item_of(of));
        answer(*from, to, LeastCosts(map, costs_s, true).bytes());
      },
      question);
}

}  // namespace

std::uint32_t model_of(const fp_facts& facts, std::uint32_t agv) {
  constexpr std::size_t kMembers = offsetof(fp_agv, vehicle_type) + sizeof(fp_agv::vehicle_type);
  const std::size_t size = std::min<std::size_t>(facts.agv_stride, kMembers);
  std::uint32_t model = 0;
  while (std::memcmp(&agv_of(facts, model), &agv_of(facts, agv), size) != 0) ++model;
  return model;
}

std::span<const double> lane_times_s(const fp_facts& facts, std::uint32_t agv) {
  return ask<double>(
      facts,
      [](const fp_facts* from, std::uint64_t model, fp_answer* to) {
        const MapView map(*from);
        const fp_agv& like = agv_of(*from, static_cast<std::uint32_t>(model));
        std::vector<double> times_s;
        times_s.reserve(map.lane_count());
        for (std::uint32_t id = 0; id < map.lane_count(); ++id) times_s.push_back(lane_time_s(map, id, like));
        answer(*from, to, times_s);
      },
      model_of(facts, agv));
}

std::span<const double> lane_costs_s(const HullParts& parts, std::uint32_t agv) {
  return ask<double>(
      parts.facts(),
      [](const fp_facts* from, std::uint64_t question, fp_answer* to) {
        const MapView map(*from);
        const auto times_s = lane_times_s(*from, HullKey::item_of(question));
        std::vector<double> costs_s(times_s.begin(), times_s.end());
        const auto against_aisle = lanes_against_aisles(*from);
        const auto against_opposite = lanes_against_opposite(HullParts(map, *from, HullKey(question)));
        for (std::uint32_t id = 0; id < map.lane_count(); ++id) {
          if (against_aisle[id] != 0) costs_s[id] *= kAgainstAisle;
          if (against_opposite[id] != 0) costs_s[id] *= OppositeLanes::kPrice;
        }
        answer(*from, to, costs_s);
      },
      parts.key().question(model_of(parts.facts(), agv)));
}

std::span<const float> remaining_costs_s(const HullParts& parts, std::uint32_t model, std::uint32_t goal) {
  return ask<float>(
      parts.facts(),
      [](const fp_facts* from, std::uint64_t question, fp_answer* to) {
        const std::uint32_t item = HullKey::item_of(question);
        const LeastCosts least(costs_back(*from, HullKey(question).question(item >> kModelShift)));
        std::vector<float> table_s;
        table_s.reserve(MapView(*from).station_count());
        for (const double value : least.from(item & ((1U << kModelShift) - 1U))) table_s.push_back(rounded_down(value));
        answer(*from, to, table_s);
      },
      parts.key().question(goal | (model << kModelShift)));
}

}  // namespace fleetproof::agents
