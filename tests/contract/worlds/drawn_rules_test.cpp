// The floors of the families, with the rules that real plants have at their spurs: AGVs back in, sources and sinks,
// chargers for AGVs without a load, slow lanes. The reference agent gets on there, within the rules.
#include <gtest/gtest.h>

#include "campaign/run/agent_programs.hpp"
#include "core/base/random.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/map/core_only.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"

namespace fleetproof::drawn_rules_test {
namespace {

constexpr const char* kFamilies[] = {"plant/40", "aisle-grid",       "loop-spurs",
                                     "fishbone", "corridor-sidings", "random-planar"};

bool is_dead_end(const Layout& layout, std::size_t station) {
  return std::ranges::count_if(layout.segments, [&](const Segment& segment) {
           return segment.from.index() == station || segment.to.index() == station;
         }) == 1;
}

// AGVs come empty and leave with a load (a source), or the other way round.
void split_by_load(Layout& layout, std::size_t segment, bool source, bool leads_in) {
  Segment back = layout.segments[segment];
  back.name += " back";
  std::swap(back.from, back.to);
  std::ranges::reverse(back.control_points_m);
  Segment& there = layout.segments[segment];
  there.bidirectional = back.bidirectional = false;
  const LoadState in = source ? LoadState::Empty : LoadState::Loaded,
                  out = source ? LoadState::Loaded : LoadState::Empty;
  there.permissions = {{"", leads_in ? in : out}};
  back.permissions = {{"", leads_in ? out : in}};
  layout.segments.push_back(std::move(back));
}

void draw_rules(Layout& layout, Draws& draws) {
  const std::size_t segments = layout.segments.size();
  for (std::size_t i = 0; i < segments; ++i) {
    if (draws.below(5) == 0) layout.segments[i].speed_limit_mps = 0.6;
    Segment& segment = layout.segments[i];
    const bool leads_in = is_dead_end(layout, segment.to.index());
    if (!segment.bidirectional || (!leads_in && !is_dead_end(layout, segment.from.index()))) continue;
    Station& spur = layout.stations[(leads_in ? segment.to : segment.from).index()];
    const std::uint32_t n = draws.below(10);
    if (n < 3) {
      (leads_in ? segment.travel : segment.back_travel) = Travel::Backward;
      spur.turning = false;
    } else if (spur.purposes.has(Purpose::Charging) && n < 7) {
      segment.permissions = {{"", LoadState::Empty}};
    } else if (spur.purposes.has(Purpose::Storage) && n < 8) {
      split_by_load(layout, i, n % 2 == 0, leads_in);
    }
  }
}

TEST(DrawnRules, TheReferenceAgentGetsOn) {
  const AgentPrograms programs;
  std::size_t layouts_with_rules = 0, limited = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draws draws(seed);
    WorldSpec spec;
    Layout layout = draw_map(family_range(kFamilies[seed % std::size(kFamilies)]), draws, 3)->layout();
    draw_rules(layout, draws);
    EXPECT_TRUE(keep_core(layout).empty()) << seed;
    layouts_with_rules += has_rules(layout) ? 1 : 0;
    limited += limited_uses(layout).empty() ? 0 : 1;
    spec.layout = std::make_shared<const LogicalMap>(layout);
    spec.demand.transports_per_agv_hour = 60.0;
    spec.placement = Placement::Mixed;
    spec.horizon = std::chrono::minutes(10);
    for (const std::uint32_t fleet : {1U, 2U, 3U}) {
      spec.fleet_size = fleet;
      RejectionCounts counts;
      Scenario scenario = generate_world(spec, seed, counts);
      scenario.radio.loss = seed % 2 == 0 ? 0.0 : 0.4;
      scenario.radio.delay_s = seed % 2 == 0 ? 0.0 : 2.0;
      std::vector<std::unique_ptr<Law>> laws;
      laws.push_back(find_law("exact")->make(scenario));
      const Outcome outcome = simulate(scenario, programs.find("hull-lock", "test"), laws);
      const std::string run = layout.name + ", seed " + std::to_string(seed) + ", " + std::to_string(fleet) + " AGVs";
      EXPECT_TRUE(laws[0]->findings().violations.empty()) << run;
      EXPECT_EQ(outcome.counters.refused_calls, 0U) << run;
      EXPECT_FALSE(outcome.stuck) << run;
      EXPECT_GT(outcome.counters.transports_done, 0U) << run;
    }
  }
  EXPECT_GE(layouts_with_rules, 50U);
  EXPECT_GE(limited, 30U) << "with a source or a sink";
}

}  // namespace
}  // namespace fleetproof::drawn_rules_test
