#include <gmock/gmock.h>

#include <string>
#include <utility>

#include "campaign/explain/sentences.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::explain_sentences_test {
namespace {

// The first AGV has arrived when the second one runs into it.
Scenario line() {
  return parse_scenario(R"({"version": 1, "horizon_s": 60, "vehicle_types": [{"name": "pallet-agv"}],
      "agvs": [{"name": "first", "start": "a", "script": [{"at_s": 1, "action": "move", "segment": "there"}]},
               {"name": "second", "start": "c", "script": [{"at_s": 30, "action": "move", "segment": "back"}]}],
      "layout": {"name": "line", "floor_low_m": [-3, -3], "floor_high_m": [23, 13],
        "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [10, 0]},
                     {"name": "c", "position_m": [20, 0]}],
        "segments": [{"name": "there", "from": "a", "to": "b"}, {"name": "back", "from": "c", "to": "b"}]}})",
                        "line.json");
}

// A case whose losses are not written down: had one of these messages arrived, it would not fail.
TEST(Explain, MessagesThatTheRadioDrewAreAskedForToo) {
  AgentPrograms programs;
  CaseHost host({"timeout-grant", ""}, programs, 2);
  std::size_t needed = 0, failures = 0;
  for (std::uint64_t seed = 1; failures < 3; ++seed) {
    const Scenario scenario = test::bad_radio(seed);
    const auto failure = failure_of(host(scenario));
    if (!failure) continue;
    ++failures;
    const FailingCase failing{scenario, *failure};
    std::vector<MessageNeed> needs;
    add_message_needs(host, failing, pattern_of(host, failing), needs);
    needed += needs.size();
    EXPECT_LE(needs.size(), 4U);
    for (const MessageNeed& need : needs) {
      EXPECT_TRUE(need.is_needed);
      EXPECT_TRUE(need.message.is_adverse());
      EXPECT_LT(kStart + need.message.delivery.sent, failure->at);
      EXPECT_TRUE(host(need.claims[0].run).outcome.violations.empty()) << need.claims[0].sentence;
    }
  }
  EXPECT_GT(needed, 0U);
}

TEST(Explain, TheLastDriveOfAnAgvThatStandsIsKept) {
  const Scenario scenario = line();
  AgentPrograms programs;
  CaseHost host({"scripted", ""}, programs, 1);
  const auto failure = failure_of(host(scenario));
  ASSERT_TRUE(failure);
  const FailingCase failing{scenario, *failure};
  ShrinkResult small;
  small.best = failing;
  const Explanation is = explain(host, failing, small, pattern_of(host, failing));
  ASSERT_EQ(is.set_offs.size(), 1U);
  EXPECT_EQ(is.set_offs[0].agv, EntityId{1U});
  ASSERT_EQ(is.past_drives.size(), 1U);
  EXPECT_EQ(is.past_drives[0].agv, EntityId{0U});
  EXPECT_THAT(sentences_of(is), testing::Contains("first had last set off from a for b, at 1.000 s."));
}

// Two AGVs of a case, and what is made up about them.
struct MadeUp {
  MadeUp() {
    is.small.scenario = test::bad_radio(1);
    is.small.failure.at = kStart + std::chrono::seconds(9);
    is.small.failure.a = a;
    is.small.failure.b = b;
  }
  std::string name(EntityId body) const { return name_of_body(is.small.scenario, body); }

  EntityId a{0U}, b{1U};
  Explanation is;
};

// An AGV that a restart has stopped on its way, and what was heard of it.
TEST(Explain, TheSentencesTellWhereWhoStandsHadDriven) {
  MadeUp made;
  made.is.small.scenario.faults = {
      {.kind = Fault::Kind::Restart, .agv = made.a, .at = seconds(4.5), .transport = {}, .lasts = seconds(0.5)}};
  Departure drive;
  drive.agv = made.a;
  drive.at = kStart + std::chrono::seconds(4);
  drive.from = StationId{0U};
  drive.to = StationId{1U};
  made.is.past_drives = {drive};
  const SimTime then = kStart + std::chrono::seconds(8);
  made.is.notes.heard = {{made.b, made.a, 7, "STATE", "holds R1", then, then}};
  const auto& map = *made.is.small.scenario.map;
  EXPECT_THAT(
      sentences_of(made.is),
      testing::IsSupersetOf({made.name(made.a) + " had last set off from " + map.station(drive.from).name + " for " +
                                 map.station(drive.to).name + ", at 4.000 s.",
                             "The restart of " + made.name(made.a) + " at 4.500 s was after that.",
                             "The last that " + made.name(made.b) + " had heard of " + made.name(made.a) +
                                 " was message 7 (STATE: holds R1), sent at 8.000 s: 1.00 s old at the failure."}));
}

// How old what the server knew of each of them was.
TEST(Explain, TheSentencesTellWhatAServerHadHeard) {
  MadeUp made;
  made.is.small.scenario.computers.emplace_back().name = "server";
  const EntityId server{made.is.small.scenario.agvs.size()};
  const SimTime then = made.is.small.failure.at - std::chrono::seconds(3);
  made.is.notes.heard = {{server, made.a, 7, "STATE", "", then, then}};
  const auto sentences = sentences_of(made.is);
  EXPECT_THAT(sentences,
              testing::Contains(testing::StartsWith("The last that server had heard of " + made.name(made.a) +
                                                    " was message 7 (STATE), sent at ")));
  EXPECT_THAT(sentences, testing::Contains(testing::EndsWith(": 3.00 s old at the failure.")));
  EXPECT_THAT(sentences, testing::Contains("server had never heard " + made.name(made.b) + "."));
  EXPECT_THAT(sentences,
              testing::Not(testing::Contains(made.name(made.a) + " had never heard " + made.name(made.b) + ".")))
      << "AGVs of a central fleet need not speak with each other";
}

// At lower speeds, the run is over before they meet; the smaller case is not.
TEST(Explain, WhatTheSmallestCaseDoesWithoutIsNoNeedOfTheFailure) {
  AgentPrograms programs;
  CaseHost host({"scripted", ""}, programs, 2);
  FailingCase small{line(), {}}, original = small;
  small.failure = *failure_of(host(small.scenario));
  original.scenario.horizon = small.failure.at - kStart + std::chrono::milliseconds(200);
  original.failure = *failure_of(host(original.scenario));
  Explanation is;
  is.original = original;
  is.small = small;
  add_shares(host, original, small, pattern_of(host, original), is.shares);
  EXPECT_THAT(sentences_of(is), testing::Contains("Other draws change nothing: this run always fails so [share 1]."));
  EXPECT_THAT(sentences_of(is), testing::Contains(testing::StartsWith(
                                    "If speeds are a tenth lower, it does not fail so: the run needs this "
                                    "to be otherwise, the smallest case does not; other draws change "
                                    "nothing then [share ")));
  is.shares.clear();
  add_shares(host, original, original, pattern_of(host, original), is.shares);
  EXPECT_THAT(sentences_of(is),
              testing::Contains(testing::StartsWith("If speeds are a tenth lower, it does not fail so; "
                                                    "other draws change nothing then [share ")));
  // Where the radio draws, a share is one of many runs.
  for (Share& share : is.shares) share.of = kRunsPerShare;
  is.shares.front().failing_draws.resize(kRunsPerShare);
  EXPECT_THAT(sentences_of(is), testing::Contains(testing::HasSubstr("tenth lower: 0 of 59 (below 5 %, 95 % sure): the "
                                                                     "failure needs this to be otherwise")));
}

// Draws that change nothing make one run of all. It may be another one than the run that failed.
TEST(Explain, WhereAllDrawsAreAlikeAndPassItIsNotSaidToFail) {
  AgentPrograms programs;
  CaseHost host({"scripted", ""}, programs, 2);
  Explanation is;
  is.original = is.small = {line(), *failure_of(host(line()))};
  is.shares = {{.what = "as it is", .run = line(), .failing_draws = {}, .of = 1}};
  EXPECT_THAT(sentences_of(is),
              testing::Contains("With other draws, 59 runs are all alike, and none fails so [share 1]."));
}

TEST(Explain, TheSentencesTellWhichAgentCrashed) {
  MadeUp made;
  made.is.ended = "agent of " + made.name(made.a) + ": aborted (SIGABRT) in event message at 7.5 s";
  EXPECT_THAT(sentences_of(made.is), testing::Contains("The " + made.is.ended + "."));
}

// Counting messages instead of senders: two GRANTs of one AGV.
TEST(Explain, TheSentencesTellThatTwoMessagesSayTheSame) {
  MadeUp made;
  MessageDelivery second;
  second.kind = "GRANT";
  second.content = "answers 7";
  second.number = 9;
  second.delivery = {.sender = made.b, .receiver = made.a, .sent = seconds(2.0)};
  MessageDelivery first = second;
  first.number = 8;
  const Claim held{"", {}, {"none", 0}, true, {}};
  const auto is_told = [&] {
    const Leave leave{made.b, {}, {}, {}, {{second, held, {}, {}, false}, {first, held, {}, {}, false}}};
    made.is.set_offs = {{made.a, {made.a, kStart, kStart, StationId{0U}, StationId{1U}}, {leave}}};
    return std::ranges::count(sentences_of(made.is), "Messages 8 and 9 say the same (GRANT: answers 7), and " +
                                                         made.name(made.a) + " needed both.");
  };
  EXPECT_EQ(is_told(), 1);
  first.content = "answers 6";
  EXPECT_EQ(is_told(), 0);
}

// The first line of a page: what decided it, as directly as a run shows it.
TEST(Explain, TheLeadingSentenceIsTheOneThatNamesWhatDecidedIt) {
  const auto leads = [](std::vector<int> decides) -> std::ptrdiff_t {
    std::vector<Sentence> sentences;
    for (const int weight : decides) sentences.push_back({"It is so.", {}, false, {}, 0, weight, {}});
    const Sentence* found = leading(sentences);
    return found == nullptr ? -1 : found - sentences.data();
  };
  EXPECT_EQ(leads({}), -1);
  EXPECT_EQ(leads({0, 0}), -1) << "nothing that was tried avoids it";
  EXPECT_EQ(leads({0, 1, 4, 4, 2}), 2) << "the first of those that say most";
}

// As text, a sentence ends with the numbers of what shows it.
TEST(Explain, SentencesKnowTheirInstantsAndTheirRuns) {
  MadeUp made;
  const std::vector<Sentence> sentences = told(made.is);
  ASSERT_FALSE(sentences.empty());
  EXPECT_EQ(sentences.front().at, made.is.small.failure.at);
  EXPECT_FALSE(sentences.front().is_of_run);
  EXPECT_EQ(text_of({"It is so.", {}, false, {3, 4}, 0, 0, {}}), "It is so [3, 4].");
  EXPECT_EQ(text_of({"It is so.", {}, false, {}, 2, 0, {}}), "It is so [share 2].");
  EXPECT_EQ(text_of({"It is so.", {}, false, {}, 0, 0, {}}), "It is so.");
}

}  // namespace
}  // namespace fleetproof::explain_sentences_test
