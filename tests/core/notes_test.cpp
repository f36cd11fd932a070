// What agents note for people who look at a trace: describe, declare_state, believe.
#include "core/engine/notes.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/engine/call_limits.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"
#include "tests/support/reference_agent.hpp"

namespace fleetproof::notes_test {
namespace {

using test::Handler;
using test::row_of_tens;
using test::simulate_with;
using test::ToldRun;

// Keeps the words beside the records.
class Notebook final : public TraceSink {
 public:
  struct Line {
    TraceRecord record;
    std::string text;
  };
  void record(const TraceRecord& record, std::string_view text) override {
    lines.push_back({record, std::string(text)});
  }
  std::vector<Line> of(TraceKind kind) const {
    std::vector<Line> found;
    for (const Line& line : lines) {
      if (line.record.kind == kind) found.push_back(line);
    }
    return found;
  }
  std::vector<std::string> words_of(TraceKind kind) const {
    std::vector<std::string> words;
    for (const Line& line : of(kind)) words.push_back(line.text);
    return words;
  }
  std::vector<Line> lines;
};

// An agent that drives, sends and looks around; with notes or without.
Handler busy_agent(bool notes) {
  return [=](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (notes) host.declare_state(c, e.kind == FP_EVENT_START ? "starting" : "sending");
    if (e.kind == FP_EVENT_START && b.self == 0) host.move(c, 0);
    if (e.kind == FP_EVENT_START || e.kind == FP_EVENT_TIMER) host.set_timer(c, 0, e.now_ns + 1'000'000'000);
    const fp_pose where{-1.25, 2e3, 0.6, -0.8};
    if (notes) host.believe(c, 1 - b.self, &where, e.now_ns - 5);
    const fp_message_fields fields{sizeof fields, "HELLO", "", nullptr, nullptr, nullptr};
    if (notes && b.self == 0) host.describe_message(c, &fields);
    if (notes && b.self != 0) host.describe(c, "HELLO");
    if (e.kind == FP_EVENT_TIMER) host.send_broadcast(c, &e.now_ns, sizeof e.now_ns);
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK) continue;
  };
}

Scenario two_agvs(double call_cost_s = 0.0) {
  Scenario scenario = row_of_tens({0, 3}, 20.0);
  scenario.faults = {test::fault(Fault::Kind::Restart, 9.5, 2.0)};
  scenario.agent_clock.call_cost_s = call_cost_s;
  return scenario;
}

TEST(Notes, ChangeNothingWhetherSomebodyLooksOrNot) {
  for (const double call_cost_s : {0.0, 0.01}) {
    const Outcome without = simulate_with(two_agvs(call_cost_s), busy_agent(false));
    Notebook notebook;
    EXPECT_EQ(simulate_with(two_agvs(call_cost_s), busy_agent(true)), without);
    EXPECT_EQ(simulate_with(two_agvs(call_cost_s), busy_agent(true), &notebook), without);
    EXPECT_GT(notebook.of(TraceKind::Described).size(), 20U);
  }
}

TEST(Notes, SayWhatAMessageIs) {
  Notebook notebook;
  simulate_with(two_agvs(0.01), busy_agent(true), &notebook);
  std::vector<std::uint64_t> described;
  std::size_t sent = 0, received = 0;
  for (const auto& [record, text] : notebook.lines) {
    if (record.kind == TraceKind::Described) {
      EXPECT_EQ(text, "HELLO");
      described.push_back(read<traced::Described>(record).message_hash);
    }
    if (record.kind == TraceKind::Sent) {
      ++sent;
      EXPECT_THAT(described, testing::Contains(read<traced::Sent>(record).message_hash));
    }
    if (record.kind == TraceKind::Received) {
      ++received;
      EXPECT_THAT(described, testing::Contains(read<traced::Reception>(record).message_hash));
    }
  }
  EXPECT_LE(described.size(), sent + 1) << "a description without a message leaves no record; a restart withdraws one";
  EXPECT_GT(received, 20U);
}

TEST(Notes, TellStatesWhenTheyChange) {
  Notebook notebook;
  simulate_with(two_agvs(), busy_agent(true), &notebook);
  std::vector<std::string> of_first;
  for (const auto& [record, text] : notebook.of(TraceKind::AgentState)) {
    if (record.entity == AgvId{0U}) of_first.push_back(text);
  }
  EXPECT_THAT(of_first, testing::ElementsAre("starting", "sending", "", "starting", "sending")) << "it restarts once";
}

TEST(Notes, TellWhereAnAgentBelievesAnother) {
  Notebook notebook;
  simulate_with(two_agvs(), busy_agent(true), &notebook);
  const auto beliefs = notebook.of(TraceKind::Belief);
  ASSERT_FALSE(beliefs.empty());
  const auto belief = read<traced::Belief>(beliefs.front().record);
  EXPECT_EQ(beliefs.front().record.entity, AgvId{0U});
  EXPECT_EQ(belief.about, AgvId{1U});
  EXPECT_EQ(belief.as_of_ns, -5);
  EXPECT_EQ(belief.where.x_mm, -1250);
  EXPECT_EQ(belief.where.y_mm, 2'000'000);
  EXPECT_NEAR(belief.where.heading_x / NotedPose::kHeadingUnits, 0.6, 1e-4);
  EXPECT_NEAR(belief.where.heading_y / NotedPose::kHeadingUnits, -0.8, 1e-4);
}

// ---- what is not kept

// The notes of one activation at the start of a run.
Notebook notes_of(const std::function<void(const fp_host&, fp_controller*)>& activation) {
  Notebook notebook;
  simulate_with(
      row_of_tens({0, 3}, 1.0),
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self == 0 && e.kind == FP_EVENT_START) activation(host, c);
      },
      &notebook);
  return notebook;
}

TEST(Notes, AreBoundedInNumber) {
  for (const std::uint32_t count : {kNotesMax, kNotesMax + 1, 3 * kNotesMax}) {
    const Notebook notebook = notes_of([&](const fp_host& host, fp_controller* c) {
      for (std::uint32_t i = 0; i < count; ++i) host.declare_state(c, i % 2 == 0 ? "even" : "odd");
    });
    EXPECT_EQ(notebook.of(TraceKind::AgentState).size(), kNotesMax);
    const auto left_out = notebook.of(TraceKind::NotesLeftOut);
    ASSERT_EQ(left_out.size(), count > kNotesMax ? 1U : 0U);
    if (!left_out.empty()) {
      EXPECT_EQ(read<traced::NotesLeftOut>(left_out[0].record).count, count - kNotesMax);
    }
  }
}

TEST(Notes, AreBoundedInLength) {
  const Notebook notebook = notes_of([](const fp_host& host, fp_controller* c) {
    host.declare_state(c, std::string(1000, 'x').c_str());
    host.describe(c, std::string(1000, 'y').c_str());
    host.send_broadcast(c, "m", 1);
  });
  EXPECT_THAT(notebook.words_of(TraceKind::AgentState), testing::ElementsAre(std::string(64, 'x')));
  EXPECT_THAT(notebook.words_of(TraceKind::Described), testing::ElementsAre(std::string(64, 'y')));
}

TEST(Notes, WithWrongArgumentsAreNotKept) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Notebook notebook = notes_of([](const fp_host& host, fp_controller* c) {
    host.declare_state(c, nullptr);
    host.describe(c, nullptr);
    host.send_broadcast(c, "m", 1);
    host.believe(c, 1, nullptr, 0);
    for (const fp_pose& pose : {fp_pose{kNan, 0, 1, 0}, fp_pose{0, INFINITY, 1, 0}, fp_pose{3e6, 0, 1, 0},
                                fp_pose{0, 0, kNan, 0}, fp_pose{0, 0, 0, -1e9}})
      host.believe(c, 1, &pose, 0);
    const fp_pose fine{};
    host.believe(c, 2, &fine, 0);
    host.believe(c, FP_NONE, &fine, 0);
  });
  for (const auto kind : {TraceKind::AgentState, TraceKind::Described, TraceKind::Belief})
    EXPECT_TRUE(notebook.of(kind).empty()) << name_of(kind);
}

TEST(Notes, DescribeTheNextMessageOfTheirActivationOnly) {
  Notebook notebook;
  simulate_with(
      row_of_tens({0, 3}, 3.5),
      [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self != 0) return;
        if (e.kind == FP_EVENT_START) host.describe(c, "forgotten");
        if (e.kind == FP_EVENT_START) host.set_timer(c, 0, 1'000'000'000);
        if (e.kind != FP_EVENT_TIMER) return;
        host.send_broadcast(c, "a", 1);
        host.describe(c, "replaced");
        host.describe(c, "B");
        EXPECT_EQ(host.send_unicast(c, "b", 1, 77), FP_INVALID);
        EXPECT_EQ(host.send_unicast(c, "b", 1, FP_NONE), FP_INVALID) << "no AGV is not all AGVs";
        host.send_broadcast(c, "b", 1);
        host.send_broadcast(c, "c", 1);
      },
      &notebook);
  EXPECT_THAT(notebook.words_of(TraceKind::Described), testing::ElementsAre("B"));
}

TEST(Notes, OfAMessageAreItsKindAndItsContent) {
  for (const auto& [described, kind, content] :
       std::vector<std::array<std::string_view, 3>>{{"GRANT", "GRANT", ""},
                                                    {"GRANT: answers 7", "GRANT", "answers 7"},
                                                    {"a: b: c", "a", "b: c"},
                                                    {"10:30", "10:30", ""},
                                                    {"GRANT:", "GRANT:", ""},
                                                    {": 7", ": 7", ""},
                                                    {"", "", ""}}) {
    EXPECT_EQ(message_words(described).kind, kind) << described;
    EXPECT_EQ(message_words(described).content, content) << described;
  }
}

// What a message asks and answers, in fields. Both forms give one kind.
TEST(Notes, OfAMessageMayHaveFields) {
  const auto described = [](const fp_message_fields& fields) {
    const auto words = notes_of([&](const fp_host& host, fp_controller* c) {
                         host.describe_message(c, &fields);
                         host.send_broadcast(c, "m", 1);
                       }).words_of(TraceKind::Described);
    return words.empty() ? std::string("none") : words.front();
  };
  const auto size = static_cast<std::uint32_t>(sizeof(fp_message_fields));
  const std::string all = described({size, "GRANT: 7", "holds C2", "4.0", "3.0, 3.1", "C2 to C4"});
  const MessageWords words = message_words(all);
  EXPECT_EQ(words.kind, "GRANT");
  EXPECT_EQ(words.content, "holds C2");
  EXPECT_EQ(words.asks, "4.0");
  EXPECT_EQ(words.answers, "3.0, 3.1");
  EXPECT_EQ(words.about, "C2 to C4");
  EXPECT_EQ(described({size, "GRANT", "holds C2", nullptr, nullptr, nullptr}), "GRANT: holds C2") << "as of `describe`";
  EXPECT_EQ(described({size, "GRANT", "", nullptr, nullptr, nullptr}), "GRANT");
  EXPECT_EQ(message_words(described({size, "GRANT", nullptr, "4.0", "3.0", "C2"})).content,
            "answers 3.0, asks 4.0, C2");
  EXPECT_EQ(message_words(described({size, "A\x1f", "b\x1f", "c\x1f", "d\x1f", nullptr})).answers, "d ");
  EXPECT_EQ(described({size, nullptr, "holds C2", nullptr, nullptr, nullptr}), "none");
  EXPECT_EQ(described({size - 1, "GRANT", nullptr, nullptr, nullptr, nullptr}), "none");
  const std::string text(1000, 'x');
  const std::string longest = described({size, text.c_str(), text.c_str(), text.c_str(), text.c_str(), text.c_str()});
  EXPECT_EQ(std::ranges::count(longest, 'x'), 200) << "the content has no room";
  EXPECT_EQ(message_words(longest).answers.size(), 64U);
  EXPECT_EQ(message_words(longest).content, "");
  const std::string made_up = described({size, "A", nullptr, text.c_str(), text.c_str(), nullptr});
  EXPECT_EQ(message_words(made_up).content.size(), 200U - 1U - 2 * 64U) << "what fields make up has no more room";
  EXPECT_EQ(message_words(made_up).answers.size(), 64U);
}

// What parts fields is in no text of a user.
TEST(Notes, OfAMessageHaveNoFieldsThatNobodyGave) {
  const auto trace = notes_of([](const fp_host& host, fp_controller* c) {
    host.describe(c,
                  "GRANT: a\x1f"
                  "4.0\x1f"
                  "3.0");
    host.send_broadcast(c, "m", 1);
  });
  EXPECT_THAT(trace.words_of(TraceKind::Described), testing::ElementsAre("GRANT: a"));
}

TEST(Notes, AListOfAnswersHasWholeRequests) {
  EXPECT_TRUE(has_answer("3.0, 13.0", "13.0"));
  EXPECT_TRUE(has_answer("3.0,13.0", "3.0"));
  EXPECT_FALSE(has_answer("13.0", "3.0"));
  EXPECT_FALSE(has_answer("", ""));
  EXPECT_FALSE(has_answer("3.0", ""));
}

// ---- tapes

TEST(Notes, AreOnTheTapeEvenIfNobodyLookedWhenItWasRecorded) {
  const Handler talkative = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    busy_agent(true)(host, c, b, e);
    host.believe(c, b.self, nullptr, 0);
    host.declare_state(c, nullptr);
    for (std::uint32_t i = 0; e.kind == FP_EVENT_ACTION_DONE && i < 2 * kNotesMax; ++i) {
      const fp_pose where{0.0004 * i, -1234.5678 - i, std::cos(i), std::sin(i)};
      host.believe(c, i % 3, &where, i);
    }
  };
  test::current_handler = &talkative;
  const ToldRun looked = test::recorded(two_agvs(0.01), test::handler_agent());
  CallTape tape;
  RunWatch watch;
  watch.record = &tape;
  simulate(two_agvs(0.01), test::handler_agent(), {}, nullptr, "", watch);
  test::current_handler = nullptr;
  const ToldRun played = test::played(two_agvs(0.01), looked.tape);
  test::expect_same(looked, played);
  EXPECT_EQ(tape.take(), looked.tape);
  const auto is_left_out = [](const ToldRun::Line& line) { return std::get<2>(line) == TraceKind::NotesLeftOut; };
  EXPECT_EQ(std::ranges::count_if(played.trace, is_left_out), 1);
}

// ---- hull-lock

TEST(Notes, OfHullLock) {
  Scenario scenario = row_of_tens({0, 2}, 120.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(20.0)}};
  Notebook notebook;
  simulate(scenario, test::reference_agent("hull-lock"), {}, &notebook);
  EXPECT_EQ(notebook.of(TraceKind::Described).size(), notebook.of(TraceKind::Sent).size());
  const std::vector<std::string> described = notebook.words_of(TraceKind::Described);
  EXPECT_THAT(described, testing::Contains(testing::StartsWith("STATE: holds ")));
  EXPECT_THAT(described, testing::Contains(testing::StartsWith("REQUEST: asks with 1.0 for ")));
  EXPECT_THAT(described, testing::Contains(testing::StartsWith("GRANT: answers 1.0, holds ")));
  for (const char* state : {"idle", "picking", "requesting", "driving"})
    EXPECT_THAT(notebook.words_of(TraceKind::AgentState), testing::Contains(state));
  const auto beliefs = notebook.of(TraceKind::Belief);
  ASSERT_FALSE(beliefs.empty());
  const auto first = read<traced::Belief>(beliefs.front().record);
  EXPECT_EQ(first.where.x_mm, first.about == AgvId{0U} ? 0 : 20'000) << "where it stands at the start";
}

}  // namespace
}  // namespace fleetproof::notes_test
