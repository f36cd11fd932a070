// A thousand drawn plants with rules, and AGVs that try anything: the controller accepts just what the rules allow, as
// judged here from the layout alone; and the detector sees what a clock sees.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/engine/simulation.hpp"
#include "laws/laws.hpp"
#include "tests/oracle/whole_runs.hpp"
#include "tests/support/source_and_sink.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::oracle::plant_rules_test {
namespace {

constexpr double kAligned = 1e-6;  // rad, far above rounding and below any drawn angle

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937 engine_;
};

// Stations on a grid of 4 m, each joined to the next in its row and column by segments with drawn rules.
Layout draw_plant(Draw& draw) {
  constexpr std::uint32_t kSide = 3;
  Layout layout;
  layout.name = "rules";
  layout.floor_low_m = {-4.0, -4.0};
  layout.floor_high_m = {12.0, 12.0};
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    Station station;
    station.name = "s" + std::to_string(i);
    station.position_m = {4.0 * (i % kSide), 4.0 * (i / kSide)};
    station.turning = !draw.one_in(3);
    if (draw.one_in(3)) station.heading = draw.one_in(2) ? Vec2(1.0, 0.0) : Vec2(0.0, -1.0);
    layout.stations.push_back(station);
  }
  const auto join = [&](std::uint32_t from, std::uint32_t to) {
    Segment segment;
    segment.name = "e" + std::to_string(layout.segments.size());
    segment.from = StationId{from};
    segment.to = StationId{to};
    segment.bidirectional = !draw.one_in(4);
    segment.travel = static_cast<Travel>(draw.below(3));
    if (segment.bidirectional) segment.back_travel = static_cast<Travel>(draw.below(3));
    if (draw.one_in(3))
      segment.permissions.push_back({draw.one_in(2) ? "" : "a", static_cast<LoadState>(draw.below(3))});
    if (draw.one_in(4)) segment.permissions.push_back({"b", LoadState::Any});
    layout.segments.push_back(segment);
  };
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    if (i % kSide + 1 < kSide) join(i, i + 1);
    if (i + kSide < kSide * kSide) join(i, i + kSide);
  }
  return layout;
}

// What an AGV may do, from the layout alone: where it stands, its nose as an angle, and whether it carries a load.
struct Judge {
  const Layout& layout;
  std::string type;
  std::uint32_t station = 0;
  double nose_rad = 0.0;

  static bool same(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)) < kAligned; }

  struct Answer {
    std::int32_t result = FP_REFUSED;
    std::uint32_t station = 0;
    double nose_rad = 0.0;
  };

  bool permitted(const Segment& segment, bool loaded) const {
    if (segment.permissions.empty()) return true;
    for (const Permission& one : segment.permissions) {
      const bool load_fits = one.load == LoadState::Any || (one.load == LoadState::Loaded) == loaded;
      if (load_fits && (one.vehicle_type.empty() || one.vehicle_type == type)) return true;
    }
    return false;
  }

  Answer answer(fp_call call, std::uint32_t called, bool loaded) const {
    Answer to{FP_REFUSED, station, nose_rad};
    if (called != FP_HERE) {
      const bool asks_backward = (called & FP_BACKWARD) != 0;
      const Segment& segment = layout.segments[called & ~FP_BACKWARD];
      const bool there = segment.from.value == station, back = segment.to.value == station && segment.bidirectional;
      if (!there && !back) return to;
      const Travel travel = there ? segment.travel : segment.back_travel;
      if (asks_backward && travel == Travel::Forward) return to;
      const bool backward = asks_backward || travel == Travel::Backward;
      const std::uint32_t end = there ? segment.to.value : segment.from.value;
      const Vec2 way = layout.stations[end].position_m - layout.stations[station].position_m;
      to.nose_rad = std::atan2(way.y(), way.x()) + (backward ? std::numbers::pi : 0.0);
      if (!permitted(segment, loaded)) return to;
      if (!layout.stations[station].turning && !same(to.nose_rad, nose_rad)) return to;
      to.station = end;
    } else if (call == FP_CALL_MOVE) {
      to.result = FP_INVALID;
      return to;
    }
    const auto& wanted = layout.stations[to.station].heading;
    const bool stays = call != FP_CALL_MOVE;
    if (stays && wanted && !same(to.nose_rad, std::atan2(wanted->y(), wanted->x()))) return to;
    to.result = FP_OK;
    return to;
  }
};

struct Tried {
  int accepted = 0, refused = 0, backward = 0;
};

// One AGV after the other tries drawn calls until one is accepted.
class Tries {
 public:
  Tries(const Scenario& scenario, Draw& draw, Tried& tried) : draw_(draw), tried_(tried) {
    for (const AgvSetup& agv : scenario.agvs)
      judges_.push_back({scenario.map->layout(), scenario.type_of(agv).name, agv.start.value,
                         std::atan2(agv.heading.y(), agv.heading.x())});
  }

  void operator()(const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& event) {
    if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_ACTION_DONE && event.kind != FP_EVENT_TIMER) return;
    if (event.kind == FP_EVENT_ACTION_DONE && event.result != FP_OK) return;
    Judge& judge = judges_[b.self];
    std::uint32_t loaded = 0;
    host.is_loaded(c, &loaded);
    const auto segments = static_cast<std::uint32_t>(judge.layout.segments.size());
    for (int i = 0; i < 12; ++i) {
      const auto call = draw_.one_in(3) ? static_cast<fp_call>(draw_.below(4)) : FP_CALL_MOVE;
      const bool here = call != FP_CALL_MOVE && draw_.one_in(2);
      const std::uint32_t called = here ? FP_HERE : draw_.below(segments) | (draw_.one_in(3) ? FP_BACKWARD : 0U);
      const Judge::Answer expected = judge.answer(call, called, loaded != 0);
      const auto action = call == FP_CALL_MOVE   ? host.move
                          : call == FP_CALL_PICK ? host.pick
                          : call == FP_CALL_DROP ? host.drop
                                                 : host.park;
      const std::int32_t answer = action(c, called);
      ASSERT_EQ(answer, expected.result) << "call " << call << " of " << called << " at " << judge.station;
      ++(answer == FP_OK ? tried_.accepted : tried_.refused);
      if (answer != FP_OK) continue;
      const bool moved = expected.station != judge.station;
      if (moved) tried_.backward += nose_against_way(judge, expected) ? 1 : 0;
      judge.station = expected.station;
      judge.nose_rad = expected.nose_rad;
      return;
    }
    host.set_timer(c, 1, event.now_ns + 1'000'000'000);
  }

 private:
  static bool nose_against_way(const Judge& judge, const Judge::Answer& to) {
    const Vec2 way = judge.layout.stations[to.station].position_m - judge.layout.stations[judge.station].position_m;
    return way.x() * std::cos(to.nose_rad) + way.y() * std::sin(to.nose_rad) < 0.0;
  }

  Draw& draw_;
  Tried& tried_;
  std::vector<Judge> judges_;
};

Scenario draw_scene(Draw& draw) {
  Scenario scenario = test::row_scenario(2, {0, 1}, 60.0);
  scenario.map = std::make_shared<const LogicalMap>(draw_plant(draw));
  scenario.vehicle_types[0].name = "a";
  scenario.vehicle_types.push_back(scenario.vehicle_types[0]);
  scenario.vehicle_types[1].name = "b";
  scenario.vehicle_types[1].footprint = {1.8, 0.9, 0.5};
  scenario.vehicle_types[1].reverse_speed_mps = 0.6;
  scenario.agvs[1].type = 1;
  scenario.contact_stops = false;
  const std::uint32_t first = draw.below(9);
  scenario.agvs[0].start = StationId{first};
  scenario.agvs[1].start = StationId{(first + 1 + draw.below(8)) % 9};
  for (AgvSetup& agv : scenario.agvs) {
    agv.heading = draw.one_in(2) ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0);
    for (int i = 0; i < 4; ++i)
      agv.transports.push_back({StationId{draw.below(9)}, StationId{draw.below(9)}, Duration{}});
  }
  return scenario;
}

TEST(PlantRulesOracle, TheControllerAcceptsWhatTheRulesAllowInAThousandDrawnPlants) {
  Tried tried;
  for (unsigned seed = 0; seed < 1'000; ++seed) {
    Draw draw(seed);
    const Scenario scenario = draw_scene(draw);
    Tries tries(scenario, draw, tried);
    test::simulate_with(scenario, std::ref(tries));
    ASSERT_FALSE(testing::Test::HasFatalFailure()) << "seed " << seed;
  }
  EXPECT_GT(tried.accepted, 5'000);
  EXPECT_GT(tried.refused, 20'000);
  EXPECT_GT(tried.backward, 1'000);
}

// Bodies that drive backward, and turn about a point that is not their centre.
TEST(PlantRulesOracle, TheDetectorSeesWhatAClockSees) {
  Tried tried;
  int pairs = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const Scenario scenario = draw_scene(draw);
    Tries tries(scenario, draw, tried);
    GlobalClock::Pairs seen;
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(find_law("exact")->make(scenario));
    laws.push_back(std::make_unique<GlobalClock>(scenario, seen));
    const test::Handler handler = std::ref(tries);
    test::current_handler = &handler;
    simulate(scenario, test::handler_agent(), laws);
    test::current_handler = nullptr;
    const auto violations = laws[0]->findings().violations;
    EXPECT_TRUE(seen.empty() || !violations.empty()) << "seed " << seed;
    for (const Violation& violation : violations)
      EXPECT_TRUE(!seen.empty() || between_steps(violation)) << "seed " << seed;
    pairs += seen.empty() ? 0 : 1;
  }
  EXPECT_GT(pairs, 100);
}

// A ring with five spurs: two that AGVs back into, one by choice, one with a heading, one for loads in and empties out.
Layout ring_with_spurs() {
  Layout layout;
  layout.name = "spurs";
  layout.floor_low_m = {-10.0, -10.0};
  layout.floor_high_m = {30.0, 20.0};
  const auto station = [&](const char* name, double x, double y, Purposes purposes) {
    layout.stations.push_back({name, {x, y}, purposes});
    return StationId{layout.stations.size() - 1};
  };
  const auto segment = [&](StationId from, StationId to, bool both) -> Segment& {
    layout.segments.push_back({"e" + std::to_string(layout.segments.size()), from, to, both});
    return layout.segments.back();
  };
  std::vector<StationId> ring;
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {10.0, 0.0}, {20.0, 0.0}, {20.0, 8.0}, {10.0, 8.0}, {0.0, 8.0}})
    ring.push_back(station(("r" + std::to_string(ring.size())).c_str(), x, y, Purpose::Routing));
  for (std::size_t i = 0; i < ring.size(); ++i) segment(ring[i], ring[(i + 1) % ring.size()], false);
  const auto spur = [&](StationId from, const char* name, double dy) {
    const Vec2 at = layout.stations[from.index()].position_m;
    const StationId end = station(name, at.x(), at.y() + dy, Purpose::Storage);
    layout.stations.back().turning = false;
    return end;
  };
  for (const std::size_t i : {0U, 1U})
    segment(ring[i], spur(ring[i], i == 0 ? "dock" : "rack", -5.0), true).travel = Travel::Backward;
  Segment& either = segment(ring[2], spur(ring[2], "gate", -5.0), true);
  either.travel = either.back_travel = Travel::Either;
  Segment& headed = segment(ring[3], spur(ring[3], "lift", 5.0), true);
  headed.travel = Travel::Either;
  headed.back_travel = Travel::Either;
  layout.stations.back().heading = Vec2(0.0, -1.0);
  const StationId last = spur(ring[4], "bay", 5.0);
  layout.stations.back().turning = true;
  segment(ring[4], last, true);
  segment(last, ring[5], false).permissions = {{"", LoadState::Loaded}};
  return layout;
}

// A dock that asks for a heading, and allows turns: an AGV that starts there with its nose out has to come back.
TEST(PlantRulesOracle, AnAgvLeavesADockInWhichItStandsTheWrongWay) {
  Layout layout;
  layout.name = "dock";
  layout.floor_low_m = {-5.0, -10.0};
  layout.floor_high_m = {15.0, 5.0};
  layout.stations = {{"a", {0.0, 0.0}, Purpose::Storage}, {"b", {6.0, 0.0}}, {"dock", {6.0, -6.0}, Purpose::Storage}};
  layout.stations[2].heading = Vec2(0.0, -1.0);
  layout.segments.push_back({"a-b", StationId{0U}, StationId{1U}, true});
  layout.segments.push_back({"b-dock", StationId{1U}, StationId{2U}, true});
  Scenario scenario = test::row_scenario(4, {2}, 300.0);
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.agvs[0].heading = Vec2(0.0, 1.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}},
                                 {StationId{2U}, StationId{0U}, Duration{}}};
  const AgentPrograms programs;
  for (const char* agent : {"hull-lock", "reckless"}) {
    const Outcome outcome = simulate(scenario, programs.find(agent, "test"), {});
    EXPECT_EQ(outcome.counters.transports_done, 2U) << agent;
    EXPECT_EQ(outcome.counters.refused_calls, 0U) << agent;
  }
}

// Agents that plan within the rules are refused nothing, and the loads arrive.
TEST(PlantRulesOracle, TheReferenceAgentsKeepTheRules) {
  const AgentPrograms programs;
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(ring_with_spurs());
  spec.demand.transports_per_agv_hour = 60.0;
  spec.vehicles[0].type.footprint = {1.6, 0.9, 0.4};
  std::uint64_t done = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    spec.fleet_size = seed % 3 == 0 ? 1 : 2;
    RejectionCounts counts;
    Scenario scenario = generate_world(spec, seed, counts);
    scenario.radio.loss = seed % 2 == 0 ? 0.0 : 0.4;
    scenario.radio.delay_s = 1.0;
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(find_law("exact")->make(scenario));
    const Outcome outcome = simulate(scenario, programs.find("hull-lock", "test"), laws);
    EXPECT_TRUE(laws[0]->findings().violations.empty()) << "seed " << seed;
    EXPECT_EQ(outcome.counters.refused_calls, 0U) << "seed " << seed;
    done += outcome.counters.transports_done;
    if (spec.fleet_size > 1) continue;
    const Outcome alone = simulate(scenario, programs.find("reckless", "test"), {});
    EXPECT_EQ(alone.counters.refused_calls, 0U) << "reckless, seed " << seed;
    EXPECT_GT(alone.counters.transports_done, 3U) << "reckless, seed " << seed;
  }
  EXPECT_GT(done, 60U);
}

// No AGV makes way into the source, from where it would not come back without a load, and none announces a way that is
// not permitted with the load that it has then: the others would believe no word of it.
TEST(PlantRulesOracle, LoadsGoFromSourceToSink) {
  const AgentPrograms programs;
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(test::source_and_sink());
  spec.demand.transports_per_agv_hour = 60.0;
  spec.horizon = std::chrono::minutes(20);
  std::uint64_t alone = 0, together = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const std::uint32_t fleet : {1U, 2U, 3U}) {
      spec.fleet_size = fleet;
      RejectionCounts counts;
      Scenario scenario = generate_world(spec, seed, counts);
      scenario.radio.loss = seed % 2 == 0 ? 0.0 : 0.4;
      scenario.radio.delay_s = seed % 2 == 0 ? 0.0 : 1.0;
      std::vector<std::unique_ptr<Law>> laws;
      laws.push_back(find_law("exact")->make(scenario));
      const Outcome outcome = simulate(scenario, programs.find("hull-lock", "test"), laws);
      EXPECT_TRUE(laws[0]->findings().violations.empty()) << "seed " << seed;
      EXPECT_EQ(outcome.counters.refused_calls, 0U) << "seed " << seed;
      EXPECT_GT(outcome.counters.transports_done, 3U) << "seed " << seed << ", " << fleet << " AGVs";
      (fleet == 1 ? alone : together) += outcome.counters.transports_done;
    }
  }
  EXPECT_GT(together, 2 * alone) << "of 2 and 3 AGVs together";
}

TEST(PlantRulesOracle, AnOrderThatThePlantForbidsHoldsUpNobodyElse) {
  const AgentPrograms programs;
  WorldSpec spec;
  spec.layout = std::make_shared<const LogicalMap>(test::source_and_sink());
  spec.demand.transports_per_agv_hour = 0.0;
  spec.fleet_size = 2;
  spec.horizon = std::chrono::minutes(20);
  RejectionCounts counts;
  Scenario scenario = generate_world(spec, 1, counts);
  const StationId source{6U}, sink{7U}, charger{8U}, shelf{9U};
  scenario.agvs[0].start = charger, scenario.agvs[0].heading = {1.0, 0.0};
  scenario.agvs[1].start = StationId{4U}, scenario.agvs[1].heading = {-1.0, 0.0};
  scenario.agvs[0].transports = {{shelf, source, Duration{}}, {source, sink, Duration{}}};
  for (int i = 0; i < 4; ++i) scenario.agvs[1].transports.push_back({source, sink, Duration{}});
  const Outcome outcome = simulate(scenario, programs.find("hull-lock", "test"), {});
  EXPECT_EQ(outcome.counters.transports_done, 4U);
}

}  // namespace
}  // namespace fleetproof::oracle::plant_rules_test
