// Placements in pairs, judged by an oracle of its own: Dijkstra in seconds over the plain layout, times of drives and
// turns in closed form.
#include "generators/worlds/encounter_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <queue>
#include <set>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/worlds/world_maker.hpp"
#include "independent_check.hpp"
#include "laws/laws.hpp"

namespace fleetproof::encounter_pairs_test {
namespace {

double rest_to_rest_s(double way, const MotionLimits& m) {
  const double up = m.acceleration_mps2, down = m.deceleration_mps2, v = m.speed_mps,
               ramps = 0.5 * v * v / up + 0.5 * v * v / down;
  return way <= ramps ? std::sqrt(2.0 * way * (up + down) / (up * down)) : v / up + v / down + (way - ramps) / v;
}

// One way to drive a segment, with the headings at its ends.
struct Way {
  std::size_t segment, from, to;
  double drive_s;
  Vec2 start, end;
};

std::vector<Way> ways_of(const Layout& layout, const VehicleType& type) {
  std::vector<Way> ways;
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    const auto& s = layout.segments[i];
    std::vector<Vec2> p{layout.stations[s.from.index()].position_m};
    p.insert(p.end(), s.control_points_m.begin(), s.control_points_m.end());
    p.push_back(layout.stations[s.to.index()].position_m);
    const Vec2 out = (p[1] - p[0]).normalized(), in = (p.back() - p[p.size() - 2]).normalized();
    const double time_s = rest_to_rest_s(independent::length_m(layout, s), type.drive);
    ways.push_back({i, s.from.index(), s.to.index(), time_s, out, in});
    if (s.bidirectional) ways.push_back({i, s.to.index(), s.from.index(), time_s, -in, -out});
  }
  return ways;
}

struct Leg {
  const Way* way;
  double begins_s, ends_s;
};

// The quickest way from a to b with the times on it.
std::vector<Leg> quickest(const Layout& layout, const std::vector<Way>& ways, const VehicleType& type, std::size_t a,
                          std::size_t b) {
  std::vector<double> cost(layout.stations.size(), 1e300);
  std::vector<const Way*> last(layout.stations.size(), nullptr);
  using Open = std::pair<double, std::size_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  cost[a] = 0.0;
  open.push({0.0, a});
  while (!open.empty()) {
    const auto [c, here] = open.top();
    open.pop();
    if (c > cost[here]) continue;
    for (const auto& w : ways) {
      if (w.from != here || c + w.drive_s >= cost[w.to]) continue;
      cost[w.to] = c + w.drive_s;
      last[w.to] = &w;
      open.push({cost[w.to], w.to});
    }
  }
  std::vector<Leg> legs;
  for (std::size_t s = b; s != a && last[s] != nullptr; s = last[s]->from) legs.push_back({last[s], 0.0, 0.0});
  std::ranges::reverse(legs);
  double t = 0.0;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (i > 0) {
      const double angle = std::acos(std::clamp(legs[i - 1].way->end.dot(legs[i].way->start), -1.0, 1.0));
      if (angle > 1e-4) t += rest_to_rest_s(angle, type.turn.as_motion());
    }
    legs[i].begins_s = t;
    legs[i].ends_s = t += legs[i].way->drive_s;
  }
  return legs;
}

struct Encounter {
  double head_on_s = 1e300, station_s = 1e300;  // least difference in time, of AGVs that leave when they are told to
};

Encounter encounter(const Scenario& s, const AgvSetup& one, const AgvSetup& two) {
  const Layout& layout = s.map->layout();
  const auto ways = ways_of(layout, s.vehicle_types[0]);
  const auto a = quickest(layout, ways, s.vehicle_types[0], one.start.index(), one.transports[0].from.index());
  const auto b = quickest(layout, ways, s.vehicle_types[0], two.start.index(), two.transports[0].from.index());
  const double later_s = 1e-9 * static_cast<double>((two.transports[0].release - one.transports[0].release).count());
  Encounter found;
  for (const auto& x : a) {
    for (const auto& y : b) {
      if (x.way->segment == y.way->segment && x.way->from == y.way->to)
        found.head_on_s = std::min(found.head_on_s, std::abs(x.begins_s - y.begins_s - later_s));
      if (x.way->to == y.way->to && x.way->segment != y.way->segment)
        found.station_s = std::min(found.station_s, std::abs(x.ends_s - y.ends_s - later_s));
    }
  }
  return found;
}

std::vector<std::string> all_ranges() {
  std::vector<std::string> names;
  for (const auto& family : layout_families()) {
    names.emplace_back(family.name);
    names.push_back(family_name(family.name, Range::Stress));
  }
  return names;
}

class Encounters : public testing::TestWithParam<std::string> {
 protected:
  WorldSpec spec(Placement placement) const {
    WorldSpec s;
    s.layout = GetParam();
    s.placement = placement;
    s.fleet_size = 4;
    return s;
  }
};

TEST_P(Encounters, AdversarialPairsMeetWithinASecond) {
  constexpr int kWorlds = 200;
  RejectionCounts counts;
  int worlds = 0, met = 0, head_on = 0;
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    const Scenario s = generate_world(spec(Placement::Adversarial), seed, counts);
    ASSERT_TRUE(problems_of(s).empty()) << seed << ": " << problems_of(s)[0].sentence;
    if (std::ranges::none_of(s.map->layout().segments, &Segment::bidirectional)) continue;
    ++worlds;
    const bool together = s.agvs[0].transports[0].release == s.agvs[1].transports[0].release;
    const auto found = encounter(s, s.agvs[0], s.agvs[1]);
    met += together && std::min(found.head_on_s, found.station_s) < 1.0 ? 1 : 0;
    head_on += together && found.head_on_s < 1.0 ? 1 : 0;
  }
  std::cout << GetParam() << ": " << met << " of " << worlds << " worlds meet, " << head_on << " head-on; pairs made "
            << counts.pairs_made << " of " << counts.pairs_wanted << "\n";
  EXPECT_GE(met, worlds * 19 / 20);
  EXPECT_GE(head_on, worlds * 17 / 20);
}

TEST_P(Encounters, RandomPlacementsSeldomDo) {
  RejectionCounts counts;
  int met = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Scenario s = generate_world(spec(Placement::Random), seed, counts);
    const auto found = encounter(s, s.agvs[0], s.agvs[1]);
    met += std::min(found.head_on_s, found.station_s) < 1.0 ? 1 : 0;
  }
  EXPECT_LT(met, 60) << "the oracle can say no";
}

// To the oracle's own rounding. On one-way rings, two AGVs seldom reach a station within a second of each other by
// different segments; an AGV without a partner starts at random.
double share_at_once(std::string_view layout) {
  if (layout.starts_with("plant")) return 0.1;
  return layout == "loop-spurs/stress" || layout == "close-pass/stress" ? 0.5 : 0.9;
}

TEST_P(Encounters, SymmetricPairsReachOneStationAtOnce) {
  RejectionCounts counts;
  int worlds = 0, at_once = 0, told_together = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scenario s = generate_world(spec(Placement::Symmetric), seed, counts);
    ASSERT_TRUE(problems_of(s).empty()) << seed;
    const auto &one = s.agvs[0].transports, &two = s.agvs[1].transports;
    ++worlds;
    at_once += encounter(s, s.agvs[0], s.agvs[1]).station_s < 1e-5 ? 1 : 0;
    told_together += std::abs((one[0].release - two[0].release).count()) < 10'000'000 ? 1 : 0;
    for (const auto* orders : {&one, &two})
      EXPECT_TRUE(std::ranges::is_sorted(*orders, {}, &TransportOrder::release)) << seed;
  }
  std::cout << GetParam() << ": " << at_once << " of " << worlds << " worlds meet to 10 us, " << told_together
            << " told to leave within 10 ms\n";
  EXPECT_GE(at_once, worlds * share_at_once(GetParam()));
}

TEST_P(Encounters, SameSeedSameWorld) {
  for (const auto placement : kPlacements) {
    RejectionCounts counts;
    const Scenario a = generate_world(spec(placement), 5, counts), b = generate_world(spec(placement), 5, counts);
    ASSERT_EQ(a.agvs.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(a.agvs[i].start, b.agvs[i].start);
      EXPECT_EQ(a.agvs[i].name, "AGV " + std::to_string(i));
      EXPECT_EQ(a.agvs[i].transports[0].from, b.agvs[i].transports[0].from);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Encounters, testing::ValuesIn(all_ranges()), [](const auto& test) {
  std::string name = test.param;
  for (char& c : name) c = c == '-' || c == '/' ? '_' : c;
  return name;
});

// The rules are read from the plain layout: every leg of a quickest way has permission, and a pair starts along it.
TEST(AdversarialPlacement, PairsAreNotSentWhereThePlantForbidsIt) {
  WorldSpec spec;
  spec.fleet_size = 4;
  spec.placement = Placement::Adversarial;
  spec.layout = std::string("random-planar");
  RejectionCounts counts;
  Layout layout = generate_world(spec, 1, counts).map->layout();
  std::set<std::size_t> forbidden;
  for (std::size_t i = 0; i < layout.segments.size(); ++i) {
    layout.segments[i].permissions = {{"", LoadState::Loaded}};
    if (Reachability(LogicalMap(layout)).starts().size() == layout.stations.size())
      forbidden.insert(i);
    else
      layout.segments[i].permissions.clear();
  }
  ASSERT_GE(forbidden.size(), 5U);
  spec.layout = std::make_shared<const LogicalMap>(layout);
  int pairs = 0, rest = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RejectionCounts of_world;
    const Scenario s = generate_world(spec, seed, of_world);
    if (of_world.pairs_made == 0) {
      ++rest;
      continue;
    }
    ++pairs;
    for (const std::size_t i : {0, 1}) {
      const auto ways = ways_of(layout, s.vehicle_types[0]);
      const auto legs =
          quickest(layout, ways, s.vehicle_types[0], s.agvs[i].start.index(), s.agvs[i].transports[0].from.index());
      ASSERT_FALSE(legs.empty());
      EXPECT_LT((legs[0].way->start - s.agvs[i].heading).norm(), 1e-9) << seed;
      for (const Leg& leg : legs) EXPECT_FALSE(forbidden.contains(leg.way->segment)) << seed;
    }
  }
  EXPECT_GE(pairs, 50) << rest << " worlds without a pair";
}

TEST(ChargerBank, TheFleetStandsRoundOneCharger) {
  WorldSpec bank, random;
  bank.placement = Placement::ChargerBank;
  RejectionCounts counts;
  double together_m = 0.0, apart_m = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scenario s = generate_world(bank, seed, counts), r = generate_world(random, seed, counts);
    ASSERT_TRUE(problems_of(s).empty());
    EXPECT_TRUE(s.map->station(s.agvs[0].start).purposes.has(Purpose::Charging)) << seed;
    const auto spread = [](const Scenario& world) {
      double sum = 0.0;
      for (const auto& agv : world.agvs)
        sum += (world.map->station(agv.start).position_m - world.map->station(world.agvs[0].start).position_m).norm();
      return sum;
    };
    together_m += spread(s);
    apart_m += spread(r);
  }
  EXPECT_LT(together_m, 0.5 * apart_m);
}

TEST(MixedPlacement, ThirtyPercentAdversarialAndMore) {
  std::map<Placement, int> drawn;
  for (std::uint64_t seed = 0; seed < 1000; ++seed)
    ++drawn[placement_of_world(Placement::Mixed, stream_key(seed, Stream::Placement))];
  EXPECT_EQ(drawn.size(), 4U);
  EXPECT_GE(drawn[Placement::Adversarial], 320);  // of 400 expected: five standard deviations
  EXPECT_EQ(drawn[Placement::Mixed], 0);
}

TEST(AdversarialPlacement, TheRecklessAgentViolatesMoreOftenPerRun) {
  const AgentPrograms programs;
  const auto violating = [&](Placement placement) {
    WorldSpec spec;
    spec.placement = placement;
    spec.horizon = std::chrono::seconds(60);
    spec.fleet_size = 2;  // larger fleets violate in almost every run anyway
    RejectionCounts counts;
    int runs = 0;
    for (const auto& family : {"aisle-grid", "corridor-sidings", "loop-spurs", "fishbone"}) {
      spec.layout = std::string(family);
      for (std::uint64_t seed = 0; seed < 25; ++seed) {
        const Scenario s = generate_world(spec, seed, counts);
        std::vector<std::unique_ptr<Law>> laws;
        laws.push_back(find_law("exact")->make(s));
        runs += simulate(s, programs.find("reckless", "test"), laws).violation ? 1 : 0;
      }
    }
    return runs;
  };
  const int adversarial = violating(Placement::Adversarial), random = violating(Placement::Random);
  std::cout << "violating runs of two AGVs in 100: " << adversarial << " adversarial, " << random << " random\n";
  EXPECT_GT(adversarial, random + 10);
}

}  // namespace
}  // namespace fleetproof::encounter_pairs_test
