#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/oracle/brute_force.hpp"

// Whole runs under the exact law, and under a clock that looks at every pair of bodies every 2.5 ms with the distance
// of the oracle. Where a body is, the clock takes from the product (Piece::pose_at); the tests of trajectories compare
// that with the oracle. So this finds what the law makes of poses, not a wrong pose.
namespace fleetproof::oracle {

class GlobalClock final : public Law {
 public:
  static constexpr Duration kStep{2'500'000};

  struct Seen {
    double lowest_m = 1e9;
    int steps_below = 0;
    SimTime at, last_at, lowest_at;
  };
  using Pairs = std::map<std::pair<std::uint64_t, std::uint64_t>, Seen>;

  GlobalClock(const Scenario& scenario, Pairs& below)
      : agvs_(scenario.agvs.size()), below_(below), safety_distance_m_(scenario.law.safety_distance_m) {
    pieces_.resize(agvs_ + scenario.obstacles.size());
  }
  void piece_ended(const Piece& piece) override { pieces_[piece.entity.index()].push_back(piece); }
  void finish(SimTime end) override {
    std::vector<std::size_t> now(pieces_.size());
    std::vector<Placed> placed(pieces_.size());
    for (SimTime t = kStart; t <= end; t += kStep) {
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        const std::size_t before = now[i];
        while (now[i] + 1 < pieces_[i].size() && pieces_[i][now[i]].end <= t) ++now[i];
        const Piece& piece = pieces_[i][now[i]];
        if (piece.manner == fleetproof::Manner::Rest && before == now[i] && t > kStart) continue;
        placed[i] = place(piece, t);
      }
      look(placed, t);
    }
  }
  LawResults findings() const override { return {}; }
  double safety_distance_m() const { return safety_distance_m_; }
  // At any instant of the run, once it is over.
  double apart_m(EntityId a, EntityId b, SimTime t) const {
    return distance_m(place(piece_at(a, t), t).corners, place(piece_at(b, t), t).corners);
  }
  // A body on a curve may come 10 micrometres nearer.
  double allowance_m(EntityId a, EntityId b, SimTime t) const {
    constexpr double kOnACurve_m = 1e-5;
    const auto of = [&](EntityId body) {
      const Piece& piece = piece_at(body, t);
      return piece.manner == fleetproof::Manner::Drive && !piece.curve->is_straight() ? kOnACurve_m : 0.0;
    };
    return of(a) + of(b);
  }

 private:
  struct Placed {
    Point centre;
    double reach_m = 0.0;
    Corners corners;
  };

  static Placed place(const Piece& piece, SimTime t) {
    const Pose pose = piece.pose_at(t);
    const Point nose{pose.heading.x(), pose.heading.y()},
        centre = Point{pose.position_m.x(), pose.position_m.y()} + piece.footprint.centre_ahead_m * nose;
    const Point l = 0.5 * piece.footprint.length_m * nose, w = 0.5 * piece.footprint.width_m * left_of(nose);
    return {centre,
            0.5 * std::hypot(piece.footprint.length_m, piece.footprint.width_m),
            {centre + l + w, centre - l + w, centre - l - w, centre + l - w}};
  }

  const Piece& piece_at(EntityId body, SimTime t) const {
    const auto& pieces = pieces_[body.index()];
    return *std::ranges::find_if(pieces.begin(), pieces.end() - 1, [&](const Piece& piece) { return piece.end >= t; });
  }

  void look(const std::vector<Placed>& placed, SimTime t) {
    const double level_m = safety_distance_m_ - 1e-6;
    for (std::size_t b = 1; b < placed.size(); ++b) {
      for (std::size_t a = 0; a < std::min(b, agvs_); ++a) {
        if (length(placed[b].centre - placed[a].centre) > placed[a].reach_m + placed[b].reach_m + level_m) continue;
        const double apart_m = distance_m(placed[a].corners, placed[b].corners);
        if (apart_m >= level_m) continue;
        Seen& seen = below_[{a, b}];
        if (seen.steps_below++ == 0) seen.at = t;
        seen.last_at = t;
        if (apart_m >= seen.lowest_m) continue;
        seen.lowest_m = apart_m;
        seen.lowest_at = t;
      }
    }
  }

  std::size_t agvs_;
  Pairs& below_;
  double safety_distance_m_;
  std::vector<std::vector<Piece>> pieces_;
};

struct Comparison {
  int runs = 0, pairs = 0, same = 0, only_exact = 0;
  std::vector<std::string> differences;
};

inline Scenario run_of(int number, std::string_view family, double horizon_s) {
  WorldSpec spec;
  spec.layout = std::string(family);
  spec.fleet_size = 4 + static_cast<std::uint32_t>(number % 5);
  spec.demand.transports_per_agv_hour = 120.0;
  spec.horizon = seconds(horizon_s);
  RejectionCounts counts;
  Scenario scenario = generate_world(spec, 7'000 + static_cast<std::uint64_t>(number), counts);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  scenario.contact_stops = number % 4 != 1;
  return scenario;
}

// A pair that only the exact law accuses was below for less than a step, or no instant of the clock fell into its
// episodes.
inline bool between_steps(const Violation& violation) {
  const std::int64_t step = GlobalClock::kStep.count();
  return to_ns(violation.last) / step * step < to_ns(violation.first);
}

constexpr double kTolerance_m = 2e-6;

inline void expect_kept_at(const std::string& which, const GlobalClock& clock, EntityId a, EntityId b, SimTime t) {
  EXPECT_GE(clock.apart_m(a, b, t), clock.safety_distance_m() - clock.allowance_m(a, b, t) - kTolerance_m)
      << which << " at " << to_seconds(t) << " s";
}

// The law files the clearance that the oracle measures at the same instant. A violation is dated to a few microseconds:
// before its first and behind its last instant, the safety distance is kept.
inline void expect_measured(const std::string& which, const Scenario& scenario, const GlobalClock& clock,
                            const Violation& v) {
  constexpr Duration kBeside{10'000};
  EXPECT_NEAR(clock.apart_m(v.a, v.b, v.closest_at), 1e-6 * static_cast<double>(v.min_clearance_um), kTolerance_m)
      << which << " at " << to_seconds(v.closest_at) << " s";
  for (const SimTime edge : {v.first, v.last}) {
    EXPECT_LE(clock.apart_m(v.a, v.b, edge), clock.safety_distance_m() + kTolerance_m)
        << which << " at " << to_seconds(edge) << " s";
  }
  if (v.first > kStart) expect_kept_at(which, clock, v.a, v.b, v.first - kBeside);
  if (v.last < kStart + scenario.horizon) expect_kept_at(which, clock, v.a, v.b, v.last + kBeside);
}

// What the clock saw lies in the episodes of the law, and is no closer than these. An edge of an episode may be dated
// a little off where the clearance hardly differs from the safety distance.
inline void expect_same_episodes(const std::string& which, const GlobalClock& clock, const GlobalClock::Seen& seen,
                                 const std::vector<Violation>& violations) {
  for (const SimTime t : {seen.at, seen.lowest_at, seen.last_at}) {
    if (std::ranges::any_of(violations, [&](const Violation& v) { return v.first <= t && t <= v.last; })) continue;
    expect_kept_at(which, clock, violations.front().a, violations.front().b, t);
  }
  const auto closest = std::ranges::min_element(violations, {}, &Violation::min_clearance_um);
  EXPECT_LE(1e-6 * static_cast<double>(closest->min_clearance_um), seen.lowest_m + 1e-9) << which;
}

inline void compare(int number, const Scenario& scenario, const fp_agent_type& agent, Comparison& sum) {
  GlobalClock::Pairs seen;
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law("exact")->make(scenario));
  auto& clock = static_cast<GlobalClock&>(*laws.emplace_back(std::make_unique<GlobalClock>(scenario, seen)));
  simulate(scenario, agent, laws);
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<Violation>> found;
  for (const Violation& v : laws[0]->findings().violations) found[{v.a.index(), v.b.index()}].push_back(v);
  ++sum.runs;
  for (const auto& [pair, below] : seen) {
    ++sum.pairs;
    sum.same += found.contains(pair);
    EXPECT_TRUE(found.contains(pair)) << "run " << number << ": the clock sees " << pair.first << " and " << pair.second
                                      << " " << below.lowest_m << " m apart, first at " << to_seconds(below.at)
                                      << " s; the exact law does not";
  }
  for (const auto& [pair, violations] : found) {
    const std::string which = fmt::format("run {}, pair {} and {}", number, pair.first, pair.second);
    for (const Violation& violation : violations) expect_measured(which, scenario, clock, violation);
    if (const auto both = seen.find(pair); both != seen.end()) {
      expect_same_episodes(which, clock, both->second, violations);
      continue;
    }
    ++sum.pairs, ++sum.only_exact;
    const Violation& v = violations[0];
    sum.differences.push_back(fmt::format("{}: between two steps, {:.3f} ms from {:.6f} s, closest {} um", which,
                                          1e3 * to_seconds(v.last - v.first), to_seconds(v.first), v.min_clearance_um));
    for (const Violation& violation : violations) EXPECT_TRUE(between_steps(violation)) << sum.differences.back();
  }
}

// Every family in turn, two of three runs with the reckless agent, one with timeout-grant.
inline Comparison compare_runs(int first, int runs, double horizon_s) {
  const AgentPrograms programs;
  const auto families = layout_families();
  Comparison sum;
  for (int i = first; i < first + runs; ++i) {
    const auto& family = families[static_cast<std::size_t>(i) % families.size()];
    const bool grant = (static_cast<std::size_t>(i) / families.size()) % 3 == 2;
    compare(i, run_of(i, family.name, horizon_s), programs.find(grant ? "timeout-grant" : "reckless", "test"), sum);
  }
  fmt::print("{} runs: {} violated pairs, {} of them seen by both; {} fell between two steps of the clock\n", sum.runs,
             sum.pairs, sum.same, sum.only_exact);
  for (const std::string& difference : sum.differences) fmt::print("  {}\n", difference);
  EXPECT_EQ(sum.same + sum.only_exact, sum.pairs);
  EXPECT_GT(sum.same, runs / 4);
  return sum;
}

}  // namespace fleetproof::oracle
