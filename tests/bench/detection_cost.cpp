// What a law costs, apart from the run it watches: the pieces of one run are recorded and announced to the law again.
//
//   detection_cost FLEET SECONDS LAW...      times, in one process; ratios to the first law. Means of WORLDS worlds
//   (environment variable; 1) detection_cost --walk FLEET SECONDS LAW  one replay, for valgrind --tool=callgrind
// --toggle-collect='*replay_to*'
//
// LAW may be "none", or "all-pairs": the exact distance of every pair of bodies every 2.5 ms. Runs are those of the
// whole-run benchmark (simulation_bench.cpp); their agent is hull-lock, or what the environment variable AGENT names. A
// walk is no run but pieces made up: on 400 m2 for each AGV, as in those runs, every AGV turns, drives and waits about
// its own middle and now and then passes a neighbour. It is as dense for 500 AGVs as for 5, and no agent slows it down.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "laws/laws.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/grid_world.hpp"

namespace fleetproof {
namespace {

struct Announcement {
  Piece piece;
  bool started = false;
};

class Recorder final : public Law {
 public:
  Recorder(std::vector<Announcement>& all, SimTime& end) : all_(all), end_(end) {}
  void piece_started(const Piece& piece) override { all_.push_back({piece, true}); }
  void piece_ended(const Piece& piece) override { all_.push_back({piece, false}); }
  void finish(SimTime end) override { end_ = end; }
  LawResults findings() const override { return {}; }

 private:
  std::vector<Announcement>& all_;
  SimTime& end_;
};

// The plainest detector: a global step, and the kernel's distance of all pairs.
class AllPairs final : public Law {
 public:
  explicit AllPairs(const Scenario& scenario) : agvs_(scenario.agvs.size()), step_(seconds(scenario.law.snapshot_s)) {
    pieces_.resize(agvs_ + scenario.obstacles.size());
  }
  void piece_ended(const Piece& piece) override { pieces_[piece.entity.index()].push_back(piece); }
  void finish(SimTime end) override {
    std::vector<std::size_t> now(pieces_.size());
    std::vector<OrientedRectangle> bodies(pieces_.size());
    for (SimTime t = kStart; t <= end; t += step_) {
      for (std::size_t i = 0; i < pieces_.size(); ++i) {
        while (now[i] + 1 < pieces_[i].size() && pieces_[i][now[i]].end <= t) ++now[i];
        bodies[i] = pieces_[i][now[i]].body_at(t);
      }
      for (std::size_t b = 1; b < bodies.size(); ++b) {
        for (std::size_t a = 0; a < std::min(b, agvs_); ++a)
          smallest_m_ = std::min(smallest_m_, clearance_m(bodies[a], bodies[b])), ++findings_.distance_evaluations;
      }
    }
  }
  LawResults findings() const override {
    LawResults findings = findings_;
    findings.min_clearance_m = smallest_m_;
    return findings;
  }

 private:
  std::size_t agvs_;
  Duration step_;
  double smallest_m_ = 1e9;
  std::vector<std::vector<Piece>> pieces_;
  LawResults findings_;
};
std::unique_ptr<Law> make_all_pairs(const Scenario& scenario) { return std::make_unique<AllPairs>(scenario); }

MakeLaw law_named(const std::string& name) {
  if (name == "none") return nullptr;
  if (name == "all-pairs") return &make_all_pairs;
  if (const auto* law = find_law(name)) return law->make;
  fmt::print(stderr, "there is no law {}\n", name);
  std::exit(2);
}

struct Recording {
  Scenario scenario;
  std::vector<Announcement> all;
  SimTime end;
  std::uint64_t drives = 0;
};

Scenario world(std::uint32_t fleet, double horizon_s, std::uint64_t seed) {
  Scenario scenario =
      fleet <= 5 ? test::grid_world(4, 8, fleet, horizon_s, seed) : test::grid_world(12, 24, fleet, horizon_s, seed);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  return scenario;
}

const fp_agent_type& agent(const AgentPrograms& programs) {
  const char* name = std::getenv("AGENT");
  return programs.find(name != nullptr ? name : "hull-lock", "bench");
}

Recording record(std::uint32_t fleet, double horizon_s, std::uint64_t seed) {
  const AgentPrograms programs;
  Recording recording{world(fleet, horizon_s, seed), {}, kStart, 0};
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Recorder>(recording.all, recording.end));
  simulate(recording.scenario, agent(programs), laws);
  for (const Announcement& a : recording.all) recording.drives += a.started && a.piece.manner == Manner::Drive;
  return recording;
}

test::Scene walk(std::uint32_t fleet, double horizon_s) {
  constexpr double kPitch_m = 20.0, kReach_m = 10.5;
  test::Scene scene(horizon_s);
  Draws draws(7);
  const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(fleet)));
  for (std::uint32_t i = 0; i < fleet; ++i) {
    const Vec2 middle(kPitch_m * (i % columns), kPitch_m * (i / columns));
    test::Timeline& body = scene.agv({middle, Vec2::UnitX()});
    while (body.now() < scene.end) {
      body.wait_until(to_seconds(body.now()) + draws.uniform(0.0, 8.0));
      const double length_m = draws.uniform(3.0, 9.0);
      const int quarters = static_cast<int>(draws.below(4));
      const Vec2 heading = rotated(body.pose().heading, unit_vector(0.5 * kPi * (quarters - 1)));
      if (((body.pose().position_m + length_m * heading) - middle).cwiseAbs().maxCoeff() > kReach_m) continue;
      if (quarters != 1) body.turn(0.5 * kPi * (quarters - 1));
      body.drive(length_m);
    }
  }
  return scene;
}

LawResults __attribute__((noinline)) replay_to(Law& law, const Recording& recording) {
  test::Teller teller(law, recording.scenario.entity_count());
  for (const Announcement& a : recording.all) a.started ? teller.begins(a.piece) : teller.ends(a.piece);
  law.finish(recording.end);
  return law.findings();
}

double seconds_of(auto&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// Median of an odd number of repetitions; fewer where one takes long.
double median_s(auto&& work) {
  std::vector<double> all{seconds_of(work)};
  const int more = all[0] > 2.0 ? 0 : all[0] > 0.1 ? 4 : 20;
  for (int i = 0; i < more; ++i) all.push_back(seconds_of(work));
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  return all[all.size() / 2];
}

void compare(std::uint32_t fleet, double horizon_s, std::span<char*> names) {
  const char* worlds = std::getenv("WORLDS");
  std::vector<Recording> recordings;
  for (int seed = 1; seed <= (worlds != nullptr ? std::atoi(worlds) : 1); ++seed)
    recordings.push_back(record(fleet, horizon_s, static_cast<std::uint64_t>(seed)));
  std::uint64_t drives = 0, pieces = 0;
  for (const Recording& recording : recordings) drives += recording.drives, pieces += recording.all.size() / 2;
  fmt::print("{} worlds of {} AGVs, {} s: {} pieces, {} drives\n", recordings.size(), fleet, horizon_s, pieces, drives);
  const auto worlds_count = static_cast<double>(recordings.size());
  const AgentPrograms programs;
  double first_alone_s = 0.0, first_whole_s = 0.0;
  for (const std::string name : names) {
    const MakeLaw make = law_named(name);
    std::uint64_t evaluations = 0, checks = 0, violations = 0;
    double alone_s = 0.0, whole_s = 0.0;
    for (const Recording& recording : recordings) {
      LawResults findings;
      if (make != nullptr)
        alone_s += median_s([&] { findings = replay_to(*make(recording.scenario), recording); }) / worlds_count;
      whole_s += median_s([&] {
                   std::vector<std::unique_ptr<Law>> laws;
                   if (make != nullptr) laws.push_back(make(recording.scenario));
                   simulate(recording.scenario, agent(programs), laws);
                 }) /
                 worlds_count;
      evaluations += findings.distance_evaluations, checks += findings.perimeter_checks,
          violations += findings.violations.size();
    }
    if (first_whole_s == 0.0) first_alone_s = alone_s, first_whole_s = whole_s;
    fmt::print(
        "{:12} detection {:12.4f} ms ({:8.1f}x)  run {:12.3f} ms ({:6.2f}x)  {} evaluations, {} checks, {} "
        "violations\n",
        name, 1e3 * alone_s, alone_s / first_alone_s, 1e3 * whole_s, whole_s / first_whole_s, evaluations, checks,
        violations);
    std::fflush(stdout);
  }
}

void replay_walk(std::uint32_t fleet, double horizon_s, const char* name) {
  const test::Scene scene = walk(fleet, horizon_s);
  Recording recording{scene.scenario, {}, kStart, 0};
  Recorder recorder(recording.all, recording.end);
  test::Announcer(scene, recorder).announce(test::Order::ByEntity);
  for (const Announcement& a : recording.all) recording.drives += a.started && a.piece.manner == Manner::Drive;
  LawResults findings;
  const auto law = law_named(name)(recording.scenario);
  const double spent_s = seconds_of([&] { findings = replay_to(*law, recording); });
  fmt::print("{} AGVs, {} s, {}: {} pieces, {} drives, {} evaluations, {} violations, {:.0f} ns a drive\n", fleet,
             horizon_s, name, recording.all.size() / 2, recording.drives, findings.distance_evaluations,
             findings.violations.size(), 1e9 * spent_s / static_cast<double>(recording.drives));
}

}  // namespace
}  // namespace fleetproof

int main(int argc, char** argv) {
  const bool once = argc > 1 && std::strcmp(argv[1], "--walk") == 0;
  const std::span<char*> words(argv + (once ? 2 : 1), argv + argc);
  if (words.size() < 3) return fmt::print("detection_cost [--walk] FLEET SECONDS LAW...\n"), 2;
  const auto fleet = static_cast<std::uint32_t>(std::atoi(words[0]));
  const double horizon_s = std::atof(words[1]);
  if (once) {
    fleetproof::replay_walk(fleet, horizon_s, words[2]);
  } else {
    fleetproof::compare(fleet, horizon_s, words.subspan(2));
  }
  return 0;
}
