#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <optional>

#include "campaign/explain/sentences.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/shrink.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::explain_test {
namespace {

struct Explained {
  explicit Explained(const std::string& agent, std::uint64_t seed) : host({agent, ""}, programs, 2) {
    WorldSpec spec;
    spec.horizon = std::chrono::seconds(60);
    spec.demand.transports_per_agv_hour = 60.0;
    for (;; ++seed) {
      RejectionCounts ignored;
      Scenario scenario = generate_world(spec, seed, ignored);
      scenario.radio.loss = 0.3;
      scenario.radio.delay_s = 1.0;
      const auto failure = failure_of(host(scenario));
      if (!failure) continue;
      original = {scenario, *failure};
      break;
    }
    pattern = pattern_of(host, original);
    TrialCache cache;
    const ShrinkResult result =
        shrink(host, cache, original, pattern, {10000}, [](const FailingCase&, std::string_view) {});
    small = result.best;
    is = explain(host, original, result, pattern);
  }

  AgentPrograms programs;
  CaseHost host;
  FailingCase original, small;
  FailurePattern pattern;
  Explanation is;
};

// Every run that a sentence names is simulated again, and does what the sentence says.
TEST(Explain, NoClaimIsFalse) {
  for (const std::uint64_t seed : {1U, 11U}) {
    Explained explained("timeout-grant", seed);
    const Explanation& is = explained.is;
    ASSERT_FALSE(is.messages.empty());
    for (const Claim* claim : claims_of(is)) {
      const auto failure = failure_of(explained.host(claim->run));
      EXPECT_EQ(claim->outcome.failure, failure ? text_of(failure->kind) : "none") << claim->sentence;
    }
    for (const MessageNeed& need : is.messages) {
      const auto fails = [&](const Claim& claim) { return !explained.host(claim.run).outcome.violations.empty(); };
      ASSERT_FALSE(need.claims.empty());
      EXPECT_EQ(fails(need.claims[0]), !need.is_needed);
      if (!need.latest) continue;
      ASSERT_EQ(need.claims.size(), 3U);
      EXPECT_FALSE(fails(need.claims[1]));
      EXPECT_TRUE(fails(need.claims[2]));
    }
    for (const LastStop& stop : is.stops) {
      if (!stop.at) continue;
      EXPECT_TRUE(explained.host(stop.claims[0].run).outcome.violations.empty());
      if (stop.claims.size() == 2) {
        EXPECT_FALSE(explained.host(stop.claims[1].run).outcome.violations.empty());
      }
    }
  }
}

// What is said to hold a drive back does so, and what is not needed is not.
TEST(Explain, WhatLetItSetOffIsSimulated) {
  std::size_t keys = 0, not_needed = 0, questions = 0;
  for (const std::uint64_t seed : {1U, 11U}) {
    Explained explained("timeout-grant", seed);
    ASSERT_FALSE(explained.is.set_offs.empty());
    for (const SetOff& set_off : explained.is.set_offs) {
      const auto sets_off = [&](const Claim& claim) {
        return sets_off_then(explained.host(claim.run, Deliveries::Kept), set_off.drive);
      };
      EXPECT_TRUE(sets_off_then(explained.host(explained.is.small.scenario, Deliveries::Kept), set_off.drive));
      for (const Leave& leave : set_off.leaves) {
        ASSERT_EQ(leave.kinds.size(), leave.claims.size());
        for (const Claim& claim : leave.claims) EXPECT_FALSE(sets_off(claim)) << claim.sentence;
        if (leave.without_others) {
          ++not_needed;
          EXPECT_TRUE(sets_off(*leave.without_others)) << leave.without_others->sentence;
        }
        for (const GoAhead& key : leave.keys) {
          ++keys;
          EXPECT_FALSE(sets_off(key.claim)) << key.claim.sentence;
          EXPECT_EQ(key.message.delivery.receiver, set_off.agv);
          EXPECT_LE(kStart + key.message.delivery.sent, set_off.drive.at);
          for (const Question& asked : key.asked) {
            ++questions;
            EXPECT_LE(asked.message.arrives(), kStart + key.message.delivery.sent);
            EXPECT_GT(asked.message.arrives(), kStart + asked.message.delivery.sent) << "the air takes a millisecond";
          }
        }
      }
    }
  }
  EXPECT_GT(keys, 0U);
  EXPECT_GT(questions, 0U);
  EXPECT_GT(not_needed, 0U);
}

TEST(Explain, TheSentencesTellWhatLetItSetOff) {
  Explained explained("timeout-grant", 1);
  Explanation is;
  is.small = explained.small;
  const EntityId agv = is.small.failure.a, other = is.small.failure.b;
  const auto name = [&](EntityId body) { return name_of_body(is.small.scenario, body); };
  is.small.scenario.faults = {
      {.kind = Fault::Kind::Restart, .agv = agv, .at = seconds(1.5), .transport = {}, .lasts = seconds(0.5)}};
  Departure drive;
  drive.agv = agv;
  drive.at = kStart + std::chrono::seconds(4);
  drive.from = StationId{0U};
  drive.to = StationId{1U};
  MessageDelivery grant, asked;
  grant.kind = "GRANT";
  grant.number = 7;
  grant.delivery = {.sender = other, .receiver = agv, .sent = seconds(2.0), .delay = seconds(1.5), .copied = true};
  asked.kind = "REQUEST";
  asked.number = 5;
  asked.delivery = {.sender = agv, .receiver = other, .sent = seconds(1.0)};
  const Claim held{"", {}, {"none", 0}, true, {}};
  grant.content = "answers 7";
  MessageDelivery last = asked;
  last.number = 6;
  last.content = "asks with 8";
  last.delivery.sent = seconds(3.0);
  const Question question{asked, 2, last};
  is.set_offs = {{agv, drive, {{other, {"GRANT"}, {held}, held, {{grant, held, {question}, drive, true}}}}}};
  is.notes.declared = {{other, "gave-way", kStart + std::chrono::seconds(2)}};
  const auto sentences = sentences_of(is);
  const auto says = [&](const std::string& words) {
    return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says(name(agv) + " set off from "));
  EXPECT_TRUE(says("Without any GRANT message of " + name(other) +
                   " in the 10 s before, it does not set off then, and nothing fails [1]."));
  EXPECT_TRUE(says("It needed nothing else of " + name(other)));
  EXPECT_TRUE(says("all the same [2]."));
  EXPECT_TRUE(says("alone, it does not either, and nothing fails [3]."));
  EXPECT_TRUE(says("That message was 1.50 s late."));
  EXPECT_TRUE(says("That message arrived twice."));
  EXPECT_TRUE(says("At that instant, " + name(other) + " said \"gave-way\"."));
  EXPECT_TRUE(says("Without message 7 (GRANT: answers 7, "));
  EXPECT_TRUE(says("the last REQUEST to reach it of " + name(agv) + " was message 5 (REQUEST, 1.000 s); " + name(agv) +
                   " sent 2 more of that kind before that drive or turn, at last message 6 (REQUEST: asks with 8, " +
                   "3.000 s)."));
  EXPECT_TRUE(says("The restart of " + name(agv) + " at 1.500 s was after it had sent that."));
  EXPECT_EQ(claims_of(is).size(), 3U);
  // If its agent says what it answers, nothing is supposed.
  last.asks = "8";
  is.set_offs.front().leaves.front().keys.front().answered = Answered{"7", asked, last};
  EXPECT_THAT(sentences_of(is),
              testing::IsSupersetOf({"It answers message 5 (REQUEST, 1.000 s) of " + name(agv) + ".",
                                     "Before that drive or turn, " + name(agv) +
                                         " had asked something else: message 6 (REQUEST: asks with 8, "
                                         "3.000 s). It is no answer to that."}));
  EXPECT_THAT(sentences_of(is), testing::Not(testing::Contains(testing::HasSubstr("to reach it of"))));
  is.set_offs.front().leaves.front().keys.front().answered = Answered{"7", {}, {}};
  EXPECT_THAT(sentences_of(is), testing::Contains("It answers a request (\"7\") of " + name(agv) +
                                                  " that had not reached " + name(other) + " by then."));
  is.set_offs.front().drive.to = drive.from;
  EXPECT_THAT(sentences_of(is), testing::Contains(testing::HasSubstr(" began to turn at ")));
  EXPECT_THAT(sentences_of(is), testing::Contains(testing::HasSubstr(", it does not turn then")));
}

// The agents say which request an answer is for. What the AGV had asked anew until it set off, it had not answered.
TEST(Explain, AnAnswerBelongsToTheRequestThatItNames) {
  std::size_t answers = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Explained explained("timeout-grant", seed);
    const auto all = explained.host(explained.is.small.scenario, Deliveries::Kept).deliveries;
    for (const SetOff& drive : explained.is.set_offs) {
      for (const Leave& leave : drive.leaves) {
        for (const GoAhead& key : leave.keys) {
          if (!key.answered) continue;
          ++answers;
          const std::string& list = key.message.answers;
          EXPECT_TRUE(has_answer(list, key.answered->request));
          EXPECT_TRUE(!key.answered->asked || has_answer(list, key.answered->asked->asks));
          bool has_asked = false;
          const MessageDelivery* other = nullptr;
          for (const MessageDelivery& m : all) {
            if (m.delivery.sender != drive.agv || kStart + m.delivery.sent > drive.drive.at || m.asks.empty()) continue;
            has_asked = has_asked || has_answer(list, m.asks);
            if (has_asked && !has_answer(list, m.asks) && other == nullptr) other = &m;
          }
          ASSERT_EQ(key.answered->asked_new.has_value(), other != nullptr);
          EXPECT_TRUE(other == nullptr || key.answered->asked_new->number == other->number);
        }
      }
    }
  }
  EXPECT_GT(answers, 0U) << "hull-lock says what it answers";
}

TEST(Explain, TheSentencesNameTheFault) {
  Explained explained("timeout-grant", 1);
  const auto sentences = sentences_of(explained.is);
  const auto says = [&](std::string_view words) {
    return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(says("said \"silence-taken-for-consent\" at "));
  EXPECT_TRUE(says("If the radio is perfect: 0 of 59"));
  EXPECT_TRUE(says("It needs the "));
  EXPECT_TRUE(says(" [1, "));
}

TEST(Explain, TheSentencesTellWhatTheBodiesDid) {
  Explained explained("timeout-grant", 1);
  const CaseRun run = explained.host(explained.is.small.scenario);
  const std::map<std::string, std::string> past = {{kDriving, "drove"}, {kTurning, "turned"}, {kStanding, "stood"}};
  ASSERT_EQ(run.doing.size(), 2U);
  const Failure& failure = explained.is.small.failure;
  const auto did = [&](EntityId body, const std::string& doing) {
    return name_of_body(explained.small.scenario, body) + " " + past.at(doing);
  };
  EXPECT_EQ(sentences_of(explained.is)[1],
            "Then " + did(failure.a, run.doing[0]) + ", and " + did(failure.b, run.doing[1]) + ".");
}

// Where a perfect radio does not help, the runs that avoid the failure are what a word is compared with.
TEST(Explain, AWordIsComparedWithRunsThatAvoidTheFailure) {
  Explained explained("timeout-grant", 1);
  Explanation is;
  is.small = explained.small;
  const EntityId agv = is.small.failure.a;
  is.doing = {kTurning, kStanding};
  is.notes.declared = {{agv, "driving", kStart}, {agv, "granted-by-count", kStart + std::chrono::seconds(2)}};
  is.things = {{"fails in the same way without A", {}, {}, false, {"driving", "granted-by-count"}},
               {"does not fail so without the fault", {}, {"none", 0}, true, {"driving"}, true},
               {"does not fail so without the bend", {}, {"none", 0}, true, {"driving", "idle"}, true},
               {"does not fail so without B", {}, {"none", 0}, true, {}}};
  const auto sentences = sentences_of(is);
  const auto count = [&](std::string_view words) {
    return std::ranges::count_if(sentences, [&](const std::string& s) { return s.find(words) != std::string::npos; });
  };
  EXPECT_EQ(count(" turned, and AGV "), 1);
  EXPECT_EQ(count(" said \"granted-by-count\" at 2.000 s; nobody says it in the runs that avoid it [2, 3]."), 1);
  EXPECT_EQ(count("said \"driving\""), 0);
}

// The last numbers in brackets are those of the last claims: no claim is told twice or left out.
TEST(Explain, TheSentencesNumberTheirRuns) {
  Explained explained("timeout-grant", 1);
  std::size_t highest = 0;
  for (const std::string& sentence : sentences_of(explained.is)) {
    const auto open = sentence.find(" [");
    const bool refers_back = sentence.find("nobody says it in the runs") != std::string::npos;
    if (open == std::string::npos || refers_back || sentence.substr(open).starts_with(" [share")) continue;
    std::size_t number = 0;
    for (const char c : sentence.substr(open + 2)) {
      if (c >= '0' && c <= '9') {
        number = 10 * number + static_cast<std::size_t>(c - '0');
      } else {
        if (number > 0) {
          EXPECT_EQ(number, ++highest) << sentence;
        }
        number = 0;
      }
    }
  }
  EXPECT_EQ(highest, claims_of(explained.is).size());
}

// One AGV drives a bow around which it would miss the other if the lane were straight.
TEST(Explain, ABendThatItNeedsIsNamed) {
  const auto parked_at = [](const std::string& place_m) {
    return parse_scenario(R"({"version": 1, "horizon_s": 30, "vehicle_types": [{"name": "pallet-agv"}],
      "agvs": [{"name": "driver", "start": "a", "script": [{"at_s": 1, "action": "move", "segment": "bow"}]},
               {"name": "parked", "start": "c"}],
      "layout": {"name": "bow", "floor_low_m": [-3, -3], "floor_high_m": [23, 13],
        "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [10, 0]},
                     {"name": "c", "position_m": )" +
                              place_m + R"(}, {"name": "d", "position_m": [20, 10]}],
        "segments": [{"name": "bow", "from": "a", "to": "b", "control_points_m": [[2, 4], [8, 4]]},
                     {"name": "away", "from": "c", "to": "d"}]}})",
                          "bow.json");
  };
  AgentPrograms programs;
  CaseHost host({"scripted", ""}, programs, 1);
  for (const bool needs_it : {true, false}) {
    const Scenario scenario = needs_it ? parked_at("[5, 3]") : parked_at("[2, 0.8]");
    const auto failure = failure_of(host(scenario));
    ASSERT_TRUE(failure) << needs_it;
    const FailingCase failing{scenario, *failure};
    const auto claims = without_each_thing(host, failing, pattern_of(host, failing));
    const auto of_bend = std::ranges::find_if(claims, [](const Claim& claim) {
      return claim.sentence.ends_with("without the bend of the lane between a and b");
    });
    ASSERT_NE(of_bend, claims.end());
    EXPECT_THAT(of_bend->sentence, testing::StartsWith(needs_it ? "does not fail so" : "fails"));
    EXPECT_EQ(of_bend->avoids, needs_it);
    EXPECT_EQ(failure_of(host(of_bend->run)) == std::nullopt, needs_it);
  }
}

TEST(NoReturn, WhatDecidedItLiesBeforeItWasCertain) {
  const auto judged_counts = [](const std::vector<std::uint32_t>& counts) {
    std::vector<Branching> curve;
    for (const std::uint32_t count : counts) {
      Branching& branching = curve.emplace_back();
      branching.at = kStart + std::chrono::seconds(curve.size());
      for (std::uint32_t draw = 1; draw <= count; ++draw) branching.failing_draws.push_back(draw);
    }
    const NoReturn found = judged(std::move(curve));
    const auto second = [](SimTime at) { return (at - kStart) / std::chrono::seconds(1); };
    return std::tuple(second(found.open_until), found.likely_from ? second(*found.likely_from) : -1,
                      found.certain_from ? second(*found.certain_from) : -1);
  };
  EXPECT_EQ(judged_counts({5, 6, 20, 40, 59, 59}), std::tuple(2, 4, 5));
  EXPECT_EQ(judged_counts({56, 57, 59, 53, 58, 59, 59}), std::tuple(5, 1, 6)) << "nearly certain from the beginning";
  EXPECT_EQ(judged_counts({0, 0, 59, 10, 59}), std::tuple(2, 5, 5));
  EXPECT_EQ(judged_counts({3, 4, 20}), std::tuple(2, -1, -1));
  EXPECT_EQ(judged_counts({59, 59}), std::tuple(1, 1, 1));
}

// Where many fail, another failure of the run says nothing about this one.
void expect_the_same_bodies(CaseHost& host, const Branching& branching, const Failure& failure) {
  for (const std::uint32_t draw : branching.failing_draws) {
    const auto found = failure_of(host(with_other_radio(branching.run, draw)));
    ASSERT_TRUE(found);
    EXPECT_EQ(std::minmax(found->a.value, found->b.value), std::minmax(failure.a.value, failure.b.value));
  }
}

// Before the message that decides it is sent, nothing is decided; from then on, it is.
TEST(NoReturn, IsAtTheMessageThatDecidesIt) {
  AgentPrograms programs;
  CaseHost host({"timeout-grant", ""}, programs, 2);
  std::size_t with_end = 0, in_window = 0, before_certain = 0, acted_by = 0;
  for (std::uint64_t seed = 1; with_end < 10 && seed < 400; ++seed) {
    WorldSpec spec;
    spec.horizon = std::chrono::seconds(60);
    spec.fleet_size = 3;
    RejectionCounts ignored;
    Scenario scenario = generate_world(spec, seed, ignored);
    scenario.radio.loss = 0.2;
    const auto failure = failure_of(host(scenario));
    if (!failure) continue;
    const FailingCase failing{scenario, *failure};
    const FailurePattern pattern = pattern_of(host, failing);
    const NoReturn curve = curve_of_no_return(host, failing, pattern);
    ASSERT_EQ(curve.curve.size(), kInstants);
    EXPECT_TRUE(std::ranges::is_sorted(curve.curve, {}, &Branching::at));
    EXPECT_LE(curve.curve.back().at, failure->at);
    expect_the_same_bodies(host, curve.curve.front(), *failure);
    if (!curve.certain_from || 3 * curve.curve.front().failing() > kBranches) continue;
    ++with_end;
    // The silence that it takes for consent overlaps the window that the curve marks.
    const CaseNotes notes = host(scenario, Deliveries::Kept).notes;
    std::optional<SimTime> first_said, said;  // both may say it, and again
    for (const Declared& declared : notes.declared) {
      const bool involved = declared.agv == failure->a || declared.agv == failure->b;
      if (!involved || declared.word != "silence-taken-for-consent") continue;
      if (!said || declared.at - *said > std::chrono::seconds(10)) first_said = declared.at;
      said = declared.at;
    }
    ASSERT_TRUE(said);
    EXPECT_LE(curve.open_until, *curve.certain_from);
    const SimTime silent_from = *first_said - std::chrono::seconds(4);
    before_certain += silent_from <= *curve.certain_from ? 1 : 0;
    in_window += *said >= curve.open_until ? 1 : 0;
    acted_by += *first_said <= curve.acted_by.value_or(*curve.certain_from) ? 1 : 0;
    EXPECT_GE(curve.acted_by.value_or(failure->at), *curve.certain_from);
    EXPECT_LE(curve.acted_by.value_or(failure->at), failure->at);
  }
  EXPECT_EQ(with_end, 10U);
  EXPECT_GE(before_certain, 9U);  // in another one, each draw has a silence of its own
  EXPECT_GE(in_window, 7U);       // in others, what came after the silence could still have helped
  EXPECT_EQ(acted_by, 10U) << "it sets off when it has taken silence for consent";
}

}  // namespace
}  // namespace fleetproof::explain_test
