// Laws look at bodies only that had company, and at messages only when they matter. That is the same as looking always.
#include <gtest/gtest.h>

#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/support/reference_agent.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test::shortcuts_test {
namespace {

// Tells a law of all other bodies as company, and of all pieces, and makes it hear all records at once.
class Eager final : public Law {
 public:
  explicit Eager(std::unique_ptr<Law> law) : law_(std::move(law)) {}
  double looks_within_m() const override { return law_->looks_within_m() > 0.0 ? kEverywhere_m : 0.0; }
  void had_company(const Piece& piece, std::span<const Piece* const> others) override {
    law_->had_company(piece, others);
  }
  void piece_started(const Piece& piece) override { law_->piece_started(piece); }
  void piece_ended(const Piece& piece) override { law_->piece_ended(piece); }
  TraceKinds reads() const override { return law_->reads(); }
  void happened(const TraceRecord& record) override {
    if (source_ != nullptr) source_->hand_over();
    law_->happened(record);
  }
  bool hears_together() const override { return law_->hears_together(); }
  void together(const TracePart& part) override { law_->together(part); }
  void hears_from(TraceSource& source) override { law_->hears_from(*(source_ = &source)); }
  void finish(SimTime end) override { law_->finish(end); }
  LawResults findings() const override { return law_->findings(); }

 private:
  static constexpr double kEverywhere_m = 1e6;
  std::unique_ptr<Law> law_;
  TraceSource* source_ = nullptr;
};

struct Judged {
  Outcome usual, eager;
};

Judged judged(const Scenario& scenario, const fp_agent_type& agent) {
  Judged both;
  auto laws = make_default_laws(scenario);
  both.usual = simulate(scenario, agent, laws);
  laws = make_default_laws(scenario);
  for (auto& law : laws) law = std::make_unique<Eager>(std::move(law));
  both.eager = simulate(scenario, agent, laws);
  return both;
}

using test::reference_agent;

TEST(Company, DecidesNoFindingOfWholeRuns) {
  std::size_t violations = 0, measured = 0;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    WorldSpec spec;
    spec.layout = seed % 2 == 0 ? "dense-crossing" : "aisle-grid/stress";
    spec.fleet_size = 4;
    spec.horizon = std::chrono::seconds(200);
    spec.faults.obstacles_per_hour = 60.0;
    Scenario scenario = generate_world(spec, seed, counts);
    scenario.contact_stops = seed % 3 != 0;
    scenario.operator_help.on = seed % 4 == 0;
    if (seed % 5 == 0) scenario.law.safety_distance_m = 0.7;
    const auto [usual, eager] = judged(scenario, reference_agent(seed % 3 == 0 ? "hull-lock" : "reckless"));
    EXPECT_EQ(usual.violations, eager.violations) << seed;
    EXPECT_EQ(usual.min_clearance_um, eager.min_clearance_um) << seed;
    EXPECT_EQ(usual.incidents, eager.incidents) << seed;
    EXPECT_EQ(usual.probes, eager.probes) << seed;
    violations += usual.violations.size();
    measured += usual.min_clearance_um ? 1 : 0;
  }
  EXPECT_GT(violations, 50U);
  EXPECT_GT(measured, 20U);
}

// AGVs send all the time, and say now and then that they stand still because of the radio.
const Handler kUneasy = [](const fp_host& host, fp_controller* c, const fp_briefing& briefing, const fp_event& event) {
  constexpr std::int64_t kPeriod_ns = 250'000'000;
  if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
  const std::int64_t now_ns = host.now_ns(c), number = now_ns / kPeriod_ns;
  host.send_broadcast(c, "here", 4);
  host.set_timer(c, 0, (number + 1) * kPeriod_ns);
  host.safe_mode(c, number / (37 + 11 * briefing.self) % 3 == 2 ? 1 : 0);
};

TEST(Messages, MatterInTimeForSafeModeAndStandstill) {
  std::size_t safe = 0, still = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Scenario scenario = row_scenario(6, {0, 3, 5}, 300.0);
    scenario.seed = seed;
    scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, std::chrono::seconds(5)}};
    scenario.radio.loss = 0.3;
    scenario.radio.outages.mean_outage_s = 8.0;
    scenario.law.reaction_s = 2.0;
    scenario.stuck_after = std::chrono::seconds(15);
    current_handler = &kUneasy;
    const auto [usual, eager] = judged(scenario, handler_agent());
    current_handler = nullptr;
    EXPECT_EQ(usual.incidents, eager.incidents) << seed;
    for (const Incident& incident : usual.incidents) {
      safe += incident.kind == IncidentKind::SafeModeInContract ? 1 : 0;
      still += incident.kind == IncidentKind::StandstillInContract ? 1 : 0;
    }
  }
  EXPECT_GT(safe, 50U);
  EXPECT_GT(still, 0U);
}

// The incidents of this kind if the law lets messages go. It follows the links all the time if a floor is set to the
// throughput: that finds the same.
std::vector<Incident> found_either_way(Scenario scenario, const Handler& handler, IncidentKind kind) {
  const auto found = [&](double floor) {
    scenario.law.min_transports_per_agv_hour = floor;
    current_handler = &handler;
    auto laws = make_default_laws(scenario);
    Outcome outcome = simulate(scenario, handler_agent(), laws);
    current_handler = nullptr;
    std::erase_if(outcome.incidents, [&](const Incident& incident) { return incident.kind != kind; });
    return outcome.incidents;
  };
  std::vector<Incident> usual = found(0.0);
  EXPECT_EQ(usual, found(1e-6)) << scenario.seed;
  return usual;
}

Scenario talkative(std::vector<std::uint32_t> starts, double loss, std::uint64_t seed) {
  Scenario scenario = row_scenario(20, starts, 400.0);
  scenario.seed = seed;
  scenario.radio.loss = loss;
  scenario.radio.outages.mean_outage_s = 8.0;
  scenario.radio.outages.loss_good = 0.0;
  scenario.law.reaction_s = 6.0;
  return scenario;
}

// More messages than the law keeps. Shortly after it has let some go, AGVs go into safe mode, one after the other.
TEST(Messages, AreLetGoOnlyIfTheyCannotMatterForSafeMode) {
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& briefing,
                             const fp_event& event) {
    if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
    const std::int64_t now_ms = host.now_ns(c) / 1'000'000, phase_ms = now_ms % 50'000 - 1000 * briefing.self;
    host.send_broadcast(c, "here", 4);
    host.set_timer(c, 0, (now_ms + 40) * 1'000'000);
    host.safe_mode(c, phase_ms >= 0 && phase_ms < 4000 ? 1 : 0);
  };
  std::size_t found = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Scenario scenario = talkative({0, 2, 4, 6, 8, 10, 12, 14, 16, 18}, 0.1, seed);
    found += found_either_way(scenario, handler, IncidentKind::SafeModeInContract).size();
  }
  EXPECT_GT(found, 20U);
}

// One AGV drives, and then nothing happens; now and then, a link fails.
TEST(Messages, AreLetGoOnlyIfTheyCannotMatterForStandstill) {
  const Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing& briefing,
                             const fp_event& event) {
    if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
    const std::int64_t now_ms = host.now_ns(c) / 1'000'000;
    host.send_broadcast(c, "here", 4);
    host.set_timer(c, 0, (now_ms + 4) * 1'000'000);
    if (briefing.self == 0 && now_ms == 100'000) host.move(c, 0);
  };
  std::size_t later = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Scenario scenario = talkative({0, 3, 5}, 0.02, seed);
    scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, std::chrono::seconds(50)}};
    scenario.stuck_after = std::chrono::seconds(45);
    for (const Incident& incident : found_either_way(scenario, handler, IncidentKind::StandstillInContract))
      later += incident.first > kStart + std::chrono::seconds(120) ? 1 : 0;
  }
  EXPECT_GT(later, 4U);
}

}  // namespace
}  // namespace fleetproof::test::shortcuts_test
