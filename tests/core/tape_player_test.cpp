#include "core/engine/tape_player.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/reference_agent.hpp"

namespace fleetproof::tape_player_test {
namespace {

using test::expect_same;
using test::fault;
using test::played;
using test::recorded;
using test::ToldRun;

// ---- agents that fail

// What the functions of an agent do besides logging that they were called. Any may throw.
struct Mood {
  std::function<bool(std::uint32_t boot)> creates = [](std::uint32_t) { return true; };  // false: create() returns null
  std::function<void(const fp_event&)> hears = [](const fp_event&) {};
  std::function<void()> leaves = [] {};
};

thread_local const Mood* current_mood = nullptr;

struct MoodyAgent {
  const fp_host* host;
  fp_controller* controller;
};

// Of one run. An agent is not destroyed if that is known to end the process.
thread_local std::deque<MoodyAgent> moody_agents;

const fp_agent_type kMoody = {
    sizeof(fp_agent_type),
    FP_ABI_MAJOR,
    FP_ABI_MINOR,
    FP_DETERMINISTIC,
    "moody",
    "fails where the test says",
    [](const fp_host* host, fp_controller* c, const fp_briefing* briefing) -> void* {
      host->log(c, "create");
      host->set_timer(c, 1, 1'000'000'000);
      return current_mood->creates(briefing->boot) ? &moody_agents.emplace_back(MoodyAgent{host, c}) : nullptr;
    },
    [](void* agent, const fp_event* event) {
      const auto& self = *static_cast<MoodyAgent*>(agent);
      self.host->log(self.controller, "event");
      current_mood->hears(*event);
      if (event->kind == FP_EVENT_START) self.host->move(self.controller, 0);
    },
    [](void* agent) {
      const auto& self = *static_cast<MoodyAgent*>(agent);
      self.host->log(self.controller, "destroy");
      current_mood->leaves();
    },
    nullptr,
    nullptr};

// AGV 0 drives, and its computer restarts twice.
Scenario restarts() {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.faults = {fault(Fault::Kind::Restart, 10.0, 5.0), fault(Fault::Kind::Restart, 30.0, 5.0)};
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)}};
  scenario.agent_clock.call_cost_s = 0.001;
  return scenario;
}

ToldRun recorded_mood(const Mood& mood, std::span<const KnownEnd> known_ends = {}) {
  current_mood = &mood;
  ToldRun run = recorded(restarts(), kMoody, {}, known_ends);
  current_mood = nullptr;
  moody_agents.clear();
  return run;
}

[[noreturn]] void throw_planted() { throw std::runtime_error("planted"); }

TEST(TapePlayer, PlaysAgentsThatFailAnywhere) {
  Mood silent;
  const ToldRun sound = recorded_mood(silent);
  EXPECT_FALSE(sound.outcome.crash);
  expect_same(sound, played(restarts(), sound.tape));

  std::vector<Mood> moods(7);
  moods[0].creates = [](std::uint32_t) -> bool { throw_planted(); };
  moods[1].creates = [](std::uint32_t) { return false; };
  moods[2].creates = [](std::uint32_t boot) { return boot < 2; };
  moods[3].hears = [](const fp_event& e) {
    if (e.kind == FP_EVENT_START) throw_planted();
  };
  moods[4].hears = [](const fp_event& e) {
    if (e.kind == FP_EVENT_ORDER) throw_planted();
  };
  moods[5].hears = [](const fp_event& e) {
    if (e.kind == FP_EVENT_TIMER) throw 7;  // not a std::exception
  };
  moods[6].leaves = throw_planted;
  for (std::size_t i = 0; i < moods.size(); ++i) {
    SCOPED_TRACE("mood " + std::to_string(i));
    const ToldRun run = recorded_mood(moods[i]);
    EXPECT_TRUE(run.outcome.crash);
    EXPECT_NE(run.tape, sound.tape);
    expect_same(run, played(restarts(), run.tape));
  }
}

// ---- why an agent cannot start

ToldRun recorded_reasons(const std::vector<const char*>& reasons) {
  static const std::vector<const char*>* said;
  said = &reasons;
  fp_agent_type type = test::untouchable_agent();
  type.create = [](const fp_host* host, fp_controller* controller, const fp_briefing*) -> void* {
    for (const char* reason : *said)
      EXPECT_EQ(host->cannot_start(controller, reason), reason == nullptr ? FP_INVALID : FP_OK);
    return nullptr;
  };
  return recorded(restarts(), type);
}

TEST(TapePlayer, PlaysWhyAnAgentCannotStart) {
  const std::string before = "agent of " + restarts().agvs[0].name + ": create() returned null", wide(5000, 'x');
  for (const auto& [reasons, told] : {std::pair<std::vector<const char*>, std::string>{{}, ""},
                                      {{""}, ""},
                                      {{"no licence for 12 AGVs"}, ": no licence for 12 AGVs"},
                                      {{"first", "second", nullptr}, ": second"},
                                      {{"two\nlines"}, ": two\\nlines"},
                                      {{"\xff\x01"}, ": \\xff\\x01"}}) {
    const ToldRun run = recorded_reasons(reasons);
    EXPECT_TRUE(run.outcome.crash);
    EXPECT_EQ(run.outcome.message, before + told);
    expect_same(run, played(restarts(), run.tape));
  }
  const std::string longest = recorded_reasons({wide.c_str()}).outcome.message;
  EXPECT_GE(std::ranges::count(longest, 'x'), 150);
  EXPECT_LT(longest.size(), 300U);
}

TEST(TapePlayer, PlaysThatAnAgentHasStartedAllTheSame) {
  std::int32_t after = FP_OK;
  fp_agent_type type = test::handler_agent();
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event&) {
    after = host.cannot_start(c, "too late");
  };
  test::current_handler = &handler;
  const ToldRun run = recorded(restarts(), type);
  test::current_handler = nullptr;
  EXPECT_EQ(after, FP_REFUSED);
  EXPECT_FALSE(run.outcome.crash);
  expect_same(run, played(restarts(), run.tape));
}

// An agent that fails after create() is destroyed later, and its failure to leave is filed then.
TEST(TapePlayer, KnowsWhetherAnAgentExistsThatFailedToStart) {
  for (const bool exists : {true, false}) {
    int destroyed = 0;
    Mood mood;
    if (!exists) mood.creates = [](std::uint32_t) -> bool { throw_planted(); };
    mood.hears = [](const fp_event&) { throw_planted(); };
    mood.leaves = [&] { ++destroyed; };
    const ToldRun run = recorded_mood(mood);
    EXPECT_EQ(destroyed, exists ? 2 : 0);
    expect_same(run, played(restarts(), run.tape));
  }
}

TEST(TapePlayer, CutsAMessageLikeTheEngine) {
  for (const std::string& text :
       {std::string(5000, 'x'), std::string(5000, '\1'), std::string(), std::string("a\nb")}) {
    Mood mood;
    mood.hears = [&](const fp_event&) { throw std::runtime_error(text); };
    const ToldRun run = recorded_mood(mood);
    EXPECT_LT(run.tape.size(), 3000U);
    expect_same(run, played(restarts(), run.tape));
  }
  // Characters of four bytes, of which the engine shows 200.
  std::string wide;
  for (int i = 0; i < 1000; ++i) wide += "\xf0\x9f\x9a\x9a";
  Mood mood;
  mood.hears = [&](const fp_event&) { throw std::runtime_error(wide); };
  const ToldRun run = recorded_mood(mood);
  EXPECT_EQ(run.outcome.message, "agent of agv-1: " + wide.substr(0, 800) + "...");
  expect_same(run, played(restarts(), run.tape));
}

// A call that is known to end the process is on the tape: a played run needs no list of them.
TEST(TapePlayer, PlaysKnownEnds) {
  const Mood mood;
  for (const bool hang : {false, true}) {
    for (std::uint64_t call = 1; call < 12; ++call) {
      const std::vector<KnownEnd> ends = {{call, hang, "segmentation fault"}};
      const ToldRun run = recorded_mood(mood, ends);
      EXPECT_TRUE(hang ? run.outcome.hang : run.outcome.crash) << "call " << call;
      expect_same(run, played(restarts(), run.tape));
    }
  }
}

// ---- recordings of other runs, and damaged ones

// The error, or nothing if there is an outcome.
std::optional<std::string> error_of(const Scenario& scenario, std::string_view tape) {
  try {
    (void)played(scenario, tape);
    return std::nullopt;
  } catch (const EngineError& error) {
    return error.what();
  }
}

Scenario lossy(std::uint64_t seed) {
  Scenario scenario = test::row_of_tens({0, 3}, 20.0);
  scenario.seed = seed;
  scenario.radio.loss = 0.4;
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, seconds(1.0)}};
  scenario.agvs[1].transports = {{StationId{3U}, StationId{1U}, seconds(1.0)}};
  return scenario;
}

TEST(TapePlayer, RefusesTheRecordingOfAnotherRun) {
  const std::string tape = recorded(lossy(1), test::reference_agent("hull-lock")).tape;
  EXPECT_EQ(error_of(lossy(1), tape), std::nullopt);
  EXPECT_EQ(error_of(lossy(2), tape), "the recording does not fit this run: it holds another call than the run makes");
  Scenario longer = lossy(1), shorter = lossy(1), smaller = lossy(1);
  longer.horizon = seconds(25.0);
  shorter.horizon = seconds(15.0);
  smaller.agvs.pop_back();
  EXPECT_TRUE(error_of(longer, tape));
  EXPECT_TRUE(error_of(shorter, tape));
  EXPECT_TRUE(error_of(smaller, tape));
  EXPECT_EQ(error_of(lossy(1), tape + "x"),
            "the recording does not fit this run: it holds calls that the run does not make");
  EXPECT_EQ(error_of(lossy(1), "\x02" + tape.substr(1)),
            "the recording does not fit this run: another version of the program has written it");
}

TEST(TapePlayer, RefusesARecordingThatIsCutAnywhere) {
  const Mood mood;
  const std::string short_tape = recorded_mood(mood).tape;
  for (std::size_t size = 1; size < short_tape.size(); ++size)
    EXPECT_TRUE(error_of(restarts(), std::string_view(short_tape).substr(0, size))) << size;
  const std::string long_tape = recorded(lossy(1), test::reference_agent("hull-lock")).tape;
  for (std::size_t size = 1; size < long_tape.size(); size += 1 + long_tape.size() / 300)
    EXPECT_TRUE(error_of(lossy(1), std::string_view(long_tape).substr(0, size))) << size;
}

// Copies without room behind them, so that the address sanitizer sees a read beyond the end.
std::optional<std::string> error_of_copy(const Scenario& scenario, const std::string& tape) {
  const std::vector<char> copy(tape.begin(), tape.end());
  return error_of(scenario, {copy.data(), copy.size()});
}

TEST(TapePlayer, SurvivesAnyDamage) {
  std::size_t refused = 0, tried = 0;
  const auto damaged = [&](const Scenario& scenario, std::string tape, std::size_t at, char flip) {
    tape[at] = static_cast<char>(tape[at] ^ flip);
    ++tried;
    refused += error_of_copy(scenario, tape).has_value();
  };
  const std::string short_tape = recorded_mood(Mood()).tape;
  for (std::size_t at = 0; at < short_tape.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) damaged(restarts(), short_tape, at, static_cast<char>(1U << bit));
    damaged(restarts(), short_tape, at, static_cast<char>(0xff));
  }
  const std::string long_tape = recorded(lossy(1), test::reference_agent("hull-lock")).tape;
  Draws draws(99);
  for (int i = 0; i < 400; ++i) {
    damaged(lossy(1), long_tape, draws.below(static_cast<std::uint32_t>(long_tape.size())),
            static_cast<char>(1 + draws.below(255)));
  }
  EXPECT_GT(refused, tried / 4);
  EXPECT_LT(refused, tried) << "damage in a message or in the text of a log entry is not noticed";
}

// Counts so large that their sum exceeds 64 bits. They would reopen the limits of calls and costs.
TEST(TapePlayer, SurvivesCountsBeyondAllLimits) {
  const std::string largest = std::string(9, '\xff') + "\x01";
  const std::string services = "\x04" + largest, over_limit = "\x06" + largest;
  std::string tape = "\x01\x01\x01\x03";
  for (int i = 0; i < 100; ++i) tape += services + over_limit + "\x0e";
  Scenario scenario = restarts();
  scenario.agent_clock.call_cost_s = 60.0;
  EXPECT_EQ(error_of(scenario, tape + std::string(1, '\0')),
            "the recording does not fit this run: the run goes on after its end");
}

TEST(TapePlayer, SurvivesNoise) {
  Draws draws(7);
  for (int i = 0; i < 2000; ++i) {
    std::string noise = "\x01";
    // The start of AGV 0, and then anything. Small numbers are items.
    if (i % 2 == 0) noise += std::string("\x01\x01\x03", 3);
    for (std::uint32_t n = draws.below(200); n > 0; --n)
      noise += static_cast<char>(draws.below(4) == 0 ? draws.below(256) : draws.below(34));
    EXPECT_TRUE(error_of_copy(restarts(), noise));
  }
}

}  // namespace
}  // namespace fleetproof::tape_player_test
