// Laws look at bodies only that had company, and at messages only when they matter. That is the same as looking always.
#include <gtest/gtest.h>

#include "core/agents/agents.h"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::test {
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
  LawFindings findings() const override { return law_->findings(); }

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

const fp_agent_type& reference_agent(std::string_view name) {
  for (const fp_agent_type* agent : std::span(fp_reference_agents, fp_reference_agent_count)) {
    if (name == agent->name) return *agent;
  }
  throw std::invalid_argument(std::string(name));
}

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

}  // namespace
}  // namespace fleetproof::test
