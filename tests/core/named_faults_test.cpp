// Faults that a scenario names by a word, and that only the program understands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "laws/laws.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::named_faults_test {
namespace {

// The agent of these tests knows words that begin with "known".
Fault named(std::uint32_t participant, const std::string& word, std::uint32_t number, double at_s, double lasts_s) {
  Fault fault = test::fault(Fault::Kind::Named, at_s, lasts_s);
  fault.agv = EntityId{participant};
  fault.word = word;
  fault.number = number;
  return fault;
}

Scenario with(std::vector<Fault> faults) {
  Scenario scenario = test::row_of_tens({0, 3}, 40.0);
  scenario.computers.push_back({.name = "server"});
  scenario.faults = std::move(faults);
  return scenario;
}

struct Told {
  std::vector<std::string> events;  // "2: known-cut 7 for 3 s at 10 s"
  Outcome outcome;
};

Told told(const Scenario& scenario, const fp_agent_type& type = test::handler_agent()) {
  Told told;
  const auto laws = make_default_laws(scenario, {});
  const test::Handler handler = [&](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event& e) {
    EXPECT_EQ(e.fault_word != nullptr, e.kind == FP_EVENT_FAULT);
    if (e.kind != FP_EVENT_FAULT) return;
    const auto seconds_of = [](std::int64_t ns) { return std::to_string(ns / 1'000'000'000) + " s"; };
    told.events.push_back(std::to_string(b.self) + ": " + e.fault_word + " " + std::to_string(e.fault_number) +
                          " for " + seconds_of(e.fault_length_ns) + " at " + seconds_of(e.now_ns));
  };
  test::current_handler = &handler;
  told.outcome = simulate(scenario, {{&type}, {{&type}}}, laws);
  test::current_handler = nullptr;
  return told;
}

std::vector<std::string> incidents(const Outcome& outcome) {
  std::vector<std::string> found;
  for (const Incident& incident : outcome.incidents) {
    if (incident.kind == IncidentKind::FaultInjected || incident.kind == IncidentKind::FaultWithoutEffect)
      found.push_back(std::string(info_of(incident.kind).name) + " " + std::to_string(incident.a.value));
  }
  return found;
}

TEST(NamedFaults, AreToldToAProgramThatKnowsTheWord) {
  const Told seen = told(with({named(0, "known-scrape", 0, 5.0, 0.0), named(2, "known-cut", 7, 10.0, 3.0)}));
  EXPECT_THAT(seen.events, testing::ElementsAre("0: known-scrape 0 for 0 s at 5 s", "2: known-cut 7 for 3 s at 10 s"));
  EXPECT_THAT(incidents(seen.outcome), testing::ElementsAre("fault-injected 0", "fault-injected 2"));
  EXPECT_EQ(seen.outcome.counters.faults, 2U);
  ASSERT_EQ(seen.outcome.incidents.size(), 2U);
  EXPECT_EQ(seen.outcome.incidents[1].last - seen.outcome.incidents[1].first, seconds(3.0));
}

TEST(NamedFaults, DoNotStrikeAProgramThatDoesNotKnowTheWord) {
  const Scenario scenario = with({named(0, "unheard-of", 0, 5.0, 1.0), named(2, "unheard-of", 7, 10.0, 3.0)});
  const Told seen = told(scenario);
  EXPECT_TRUE(seen.events.empty());
  EXPECT_THAT(incidents(seen.outcome), testing::ElementsAre("fault-without-effect 0", "fault-without-effect 2"));
  EXPECT_EQ(seen.outcome.counters.faults, 0U);
  EXPECT_EQ(seen.outcome.digest, told(with({})).outcome.digest) << "nothing happens";
}

TEST(NamedFaults, AreUnknownToOlderPrograms) {
  const Scenario scenario = with({named(0, "known-scrape", 0, 5.0, 0.0)});
  fp_agent_type older = test::handler_agent();
  older.abi_minor = 4;
  Scenario alone = scenario;
  alone.computers.clear();
  const test::Handler handler = [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event& e) {
    EXPECT_NE(e.kind, static_cast<std::uint32_t>(FP_EVENT_FAULT));
  };
  const auto asked = [&](const fp_agent_type& type) {
    const auto laws = make_default_laws(alone, {});
    test::current_handler = &handler;
    const Outcome outcome = simulate(alone, type, laws);
    test::current_handler = nullptr;
    return incidents(outcome);
  };
  EXPECT_THAT(asked(older), testing::ElementsAre("fault-without-effect 0"));
  fp_agent_type shorter = test::handler_agent();  // built by hand, without the last member
  shorter.struct_size = offsetof(fp_agent_type, knows_fault);
  EXPECT_THAT(asked(shorter), testing::ElementsAre("fault-without-effect 0"));
  fp_agent_type without = test::handler_agent();
  without.knows_fault = nullptr;
  EXPECT_THAT(asked(without), testing::ElementsAre("fault-without-effect 0"));
}

TEST(NamedFaults, DoNotReachAnAgentThatIsAway) {
  Fault restart = test::fault(Fault::Kind::Restart, 4.0, 5.0), freeze = test::fault(Fault::Kind::Freeze, 10.0, 5.0);
  const Told seen =
      told(with({restart, named(0, "known-scrape", 1, 5.0, 0.0), freeze, named(0, "known-scrape", 2, 12.0, 1.0)}));
  EXPECT_THAT(seen.events, testing::ElementsAre("0: known-scrape 2 for 1 s at 15 s")) << "it was frozen until then";
  EXPECT_THAT(incidents(seen.outcome), testing::Contains("fault-without-effect 0").Times(1));
}

TEST(NamedFaults, AProgramThatFailsAtTheQuestionHasCrashed) {
  fp_agent_type thrower = test::handler_agent();
  thrower.knows_fault = [](const char*) -> std::uint32_t { throw std::runtime_error("what is that?"); };
  const Scenario scenario = with({named(0, "known-scrape", 0, 5.0, 0.0)});
  const Told seen = told(scenario, thrower);
  EXPECT_TRUE(seen.outcome.crash);
  EXPECT_THAT(seen.outcome.message, testing::HasSubstr("what is that?"));
  EXPECT_THAT(incidents(seen.outcome), testing::Contains("fault-without-effect 0"));
}

TEST(NamedFaults, ARecordedRunPlaysTheSameWithoutTheProgram) {
  Scenario scenario = with(
      {named(0, "known-scrape", 0, 5.0, 0.0), named(1, "unheard-of", 0, 6.0, 0.0), named(1, "known-cut", 3, 7.0, 4.0)});
  scenario.computers.clear();
  const test::Handler handler = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_FAULT) host.log(c, e.fault_word);
  };
  fp_agent_type thrower = test::handler_agent();
  thrower.knows_fault = [](const char* word) -> std::uint32_t {
    if (std::string_view(word) == "unheard-of") throw std::runtime_error("what is that?");
    return 1;
  };
  for (const fp_agent_type& type : {test::handler_agent(), thrower}) {
    const auto laws = make_default_laws(scenario, {});
    test::current_handler = &handler;
    const test::ToldRun recorded = test::recorded(scenario, type, laws);
    test::current_handler = nullptr;
    EXPECT_EQ(recorded.outcome.crash, type.knows_fault == thrower.knows_fault);
    test::expect_same(test::played(scenario, recorded.tape, make_default_laws(scenario, {})), recorded);
  }
}

}  // namespace
}  // namespace fleetproof::named_faults_test
