// Faults around a program: what each one disturbs, and that nothing else is.
#include "core/bridges/wrapped/wrapped_program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/engine/simulation.hpp"
#include "tests/core/row_of_tens.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::wrapped_program_test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using wrapped::parse_fault;
using wrapped::WrappedProgram;

std::string refusal(std::string_view words) {
  try {
    return "none: " + text_of(parse_fault(words));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
}

TEST(FaultWords, AreReadAndWrittenInOneWay) {
  for (const auto& [given, written] :
       std::vector<std::pair<const char*, const char*>>{{"drop every 5th message", "drop every 5th message"},
                                                        {" drop  every 22th message ", "drop every 22nd message"},
                                                        {"repeat every 111st message", "repeat every 111th message"},
                                                        {"stall 3.50 s every 200 s", "stall 3.5 s every 200 s"},
                                                        {"forget memory every 60 s", "forget memory every 60 s"},
                                                        {"position 0.25 s old", "position 0.25 s old"},
                                                        {"clock 5.0 s off", "clock 5 s off"}}) {
    EXPECT_EQ(text_of(parse_fault(given)), written);
    EXPECT_EQ(parse_fault(written), parse_fault(given));
  }
  EXPECT_EQ(wrapped::with_text("clock 1 s off with drop every 3th message"),
            " with clock 1 s off with drop every 3rd message");
}

TEST(FaultWords, SaysWhatIsWrongAndHowToWriteIt) {
  EXPECT_THAT(refusal("stal 3 s every 200 s"), HasSubstr("\"stal 3 s every 200 s\" is no fault around a program; these "
                                                         "are: \"drop every 5th message\", \"repeat"));
  EXPECT_THAT(refusal(""), HasSubstr("is no fault around a program"));
  EXPECT_THAT(refusal("stall 3s every 200 s"), HasSubstr("is written as in \"stall 3 s every 60 s\""));
  EXPECT_THAT(refusal("drop every 5 messages"), HasSubstr("\"5\" says which message in \"drop every 5th message\""));
  EXPECT_THAT(refusal("drop each 5th message"), HasSubstr("is written as in"));
  EXPECT_THAT(refusal("drop every 0th message"), HasSubstr("it goes from 1st to 1000000th"));
  EXPECT_THAT(refusal("clock -1 s off"),
              HasSubstr("\"-1\" is a number of seconds in \"clock 5 s off\"; it goes from 0"));
  EXPECT_THAT(refusal("position 90000 s old"), HasSubstr("it goes from 0.1 to 86400"));
  EXPECT_THAT(refusal("position nan s old"), HasSubstr("it goes from 0.1 to 86400"));
  EXPECT_THAT(refusal("stall 60 s every 60 s"), HasSubstr("never ends; let it be shorter"));
}

TEST(FaultWords, StandBehindTheNameOfAProgram) {
  const auto split = wrapped::split_word("my.so with clock 1 s off with drop every 3th message");
  EXPECT_EQ(split.bare, "my.so");
  EXPECT_EQ(split.with, " with clock 1 s off with drop every 3rd message");
  EXPECT_EQ(wrapped::split_word("carrier with arms").bare, "carrier with arms");
  EXPECT_EQ(wrapped::split_checked("lockstep:python3 m.py with arms").with, "");
  EXPECT_THROW(wrapped::split_checked("./my.so with clock 1 h off"), std::invalid_argument);
}

// The run of a fleet whose agents do what the handler says, with a fault around each.
Outcome run_with(const char* fault, const Scenario& scenario, const test::Handler& handler) {
  const WrappedProgram program(test::handler_agent(), parse_fault(fault));
  test::current_handler = &handler;
  const test::ToldRun run = test::recorded(scenario, program.type());
  EXPECT_EQ(run.outcome, test::watched(scenario, program.type(), {}).outcome) << "from run to run";
  test::current_handler = nullptr;
  test::expect_same(test::played(scenario, run.tape), run);
  EXPECT_FALSE(run.outcome.crash || run.outcome.hang) << run.outcome.message;
  return run.outcome;
}

// AGV 1 counts aloud once a second; what AGV 0 hears in the last run. It reads what it perceives, and nothing is said
// to it of messages that are not there. `most_read`: at each event.
std::vector<int> heard_with(const char* fault, std::size_t most_read = 100) {
  std::vector<int> heard;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 1) {
      const auto number = static_cast<std::uint8_t>(e.now_ns / 1'000'000'000);
      if (number > 0) host.send_broadcast(c, &number, 1);
      host.set_timer(c, 0, e.now_ns + 1'000'000'000);
      return;
    }
    if (e.kind == FP_EVENT_START) heard.clear();
    fp_perceived seen{};
    seen.struct_size = sizeof seen;
    EXPECT_EQ(host.perceive(c, &seen), FP_OK);
    EXPECT_EQ(seen.message_count > 0, e.kind == FP_EVENT_MESSAGE);
    std::vector<int> perceived, read;
    for (std::uint32_t i = 0; i < seen.message_count; ++i)
      perceived.push_back(*static_cast<const std::uint8_t*>(seen.messages[i].bytes));
    fp_message message{};
    message.struct_size = sizeof message;
    while (read.size() < most_read && host.get_message(c, &message) == FP_OK) {
      EXPECT_EQ(message.sender, 1U);
      read.push_back(*static_cast<const std::uint8_t*>(message.bytes));
    }
    perceived.resize(std::min(perceived.size(), most_read));
    EXPECT_EQ(read, perceived);
    heard.insert(heard.end(), read.begin(), read.end());
  };
  run_with(fault, test::row_of_tens({0, 3}, 8.5), handler);
  return heard;
}

TEST(WrappedProgram, HearsSomeMessagesNotAtAllOrTwice) {
  EXPECT_THAT(heard_with("drop every 100th message"), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(heard_with("drop every 3rd message"), ElementsAre(1, 2, 4, 5, 7, 8));
  EXPECT_THAT(heard_with("drop every 1st message"), IsEmpty());
  EXPECT_THAT(heard_with("repeat every 3rd message"), ElementsAre(1, 2, 3, 3, 4, 5, 6, 6, 7, 8));
  EXPECT_THAT(heard_with("repeat every 3rd message", 1), ElementsAre(1, 2, 3, 3, 4, 5, 6, 6));
  EXPECT_THAT(heard_with("stall 2.5 s every 5 s"), testing::Not(IsEmpty()));
}

// Two timers each second. In a stall each is heard once, at its end and in order.
TEST(WrappedProgram, HearsNothingInAStallAndThenAllThatCame) {
  std::vector<std::pair<std::int64_t, std::uint32_t>> rings;
  run_with("stall 3.5 s every 8 s", test::row_of_tens({0}, 40.0),
           [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
             if (e.kind == FP_EVENT_START) rings.clear();
             if (e.kind == FP_EVENT_START) host.set_timer(c, 7, 1'000'000'000);
             if (e.kind != FP_EVENT_TIMER) return;
             EXPECT_EQ(host.now_ns(c), e.now_ns);
             rings.emplace_back(e.now_ns, e.timer);
             if (e.timer == 7) host.set_timer(c, 3, e.now_ns + 100'000'000);
             if (e.timer == 7) host.set_timer(c, 7, e.now_ns + 1'000'000'000);
           });
  int late = 0;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    const std::int64_t gap_ns = rings[i].first - rings[i - 1].first;
    late += gap_ns > 1'000'000'000 ? 1 : 0;
    EXPECT_LE(gap_ns, 4'500'000'000);
  }
  EXPECT_GE(late, 4) << "once in eight seconds";
  EXPECT_LE(late, 5);
}

struct Beginning {
  std::int64_t at_ns;
  std::uint32_t boot, station, segment, orders = 0;
};

// It drives to and fro between stations 0 and 1, and has an order that it never carries out.
TEST(WrappedProgram, ForgetsAllButItsDiskAndIsToldWhereItIs) {
  Scenario scenario = test::row_of_tens({0}, 60.0);
  scenario.agvs[0].transports = {{StationId{2U}, StationId{3U}, seconds(1.0)}};
  std::vector<Beginning> beginnings;
  int stray_timers = 0, kept = 0;
  run_with("forget memory every 11 s", scenario,
           [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
             if (e.kind == FP_EVENT_ORDER) ++beginnings.back().orders;
             if (e.kind == FP_EVENT_TIMER) ++stray_timers;
             if (e.kind == FP_EVENT_ACTION_DONE) host.move(c, 0);
             if (e.kind != FP_EVENT_START) return;
             fp_record record{};
             record.struct_size = sizeof record;
             const bool is_first = host.recall(c, 1, &record) == FP_EMPTY;
             if (is_first) beginnings.clear();
             kept += is_first ? 0 : 1;
             host.keep(c, 1, "x", 1);
             if (is_first) host.move(c, 0);
             beginnings.push_back({e.now_ns, b.boot, b.start_station, b.start_segment});
             host.set_timer(c, static_cast<std::uint32_t>(beginnings.size()), e.now_ns + 11'500'000'000);
           });
  ASSERT_GE(beginnings.size(), 5U);
  EXPECT_EQ(stray_timers, 0) << "a program that has gone has no timers";
  EXPECT_GE(kept, 4);
  bool was_at_other_end = false;
  for (std::size_t i = 1; i < beginnings.size(); ++i) {
    EXPECT_EQ(beginnings[i].boot, 0U) << "nobody is told";
    EXPECT_EQ(beginnings[i].segment, 0U) << "the drive under way";
    EXPECT_EQ(beginnings[i].orders, beginnings[i].at_ns > 1'000'000'000 ? 1U : 0U);
    if (i > 1) {
      EXPECT_EQ(beginnings[i].at_ns - beginnings[i - 1].at_ns, 11'000'000'000);
    }
    was_at_other_end = was_at_other_end || beginnings[i].station == 1;
  }
  EXPECT_TRUE(was_at_other_end);
}

TEST(WrappedProgram, PerceivesWhereItWas) {
  std::vector<double> seen_m;
  const auto look = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_START) {
      seen_m.clear();
      host.move(c, 0);
      host.set_timer(c, 1, 6'000'000'000);
      host.set_timer(c, 2, 9'500'000'000);
    }
    if (e.kind != FP_EVENT_TIMER) return;
    fp_pose pose{};
    fp_perceived seen{};
    seen.struct_size = sizeof seen;
    EXPECT_EQ(host.get_position(c, &pose), FP_OK);
    EXPECT_EQ(host.perceive(c, &seen), FP_OK);
    EXPECT_EQ(seen.pose.x_m, pose.x_m);
    seen_m.push_back(pose.x_m);
  };
  const Scenario scenario = test::row_of_tens({0}, 20.0);
  const auto truth = test::drive_and_look(scenario, {2.0, 5.5, 6.0});
  run_with("position 4 s old", scenario, look);
  ASSERT_EQ(seen_m.size(), 2U);
  EXPECT_EQ(seen_m[0], truth.x_m[0]) << "of second 2";
  EXPECT_EQ(seen_m[1], truth.x_m[1]) << "of second 5.5";
}

TEST(WrappedProgram, HasAClockOfItsOwn) {
  std::map<std::uint32_t, std::int64_t> start_ns;
  run_with("clock 5 s off", test::row_of_tens({0, 2, 3}, 20.0),
           [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
             EXPECT_EQ(host.now_ns(c), e.now_ns);
             if (e.kind == FP_EVENT_START) {
               start_ns[b.self] = e.now_ns;
               host.set_timer(c, 1, e.now_ns + 2'000'000'000);
             }
             if (e.kind == FP_EVENT_TIMER) {
               EXPECT_EQ(e.now_ns, start_ns[b.self] + 2'000'000'000);
             }
           });
  ASSERT_EQ(start_ns.size(), 3U);
  EXPECT_THAT(start_ns, Each(testing::Pair(testing::_, testing::AllOf(Gt(0), testing::Le(5'000'000'000)))));
  EXPECT_NE(start_ns[0], start_ns[1]);
  EXPECT_NE(start_ns[1], start_ns[2]);
}

// Each fault has a timer of its own; that of a fault is not the program's.
TEST(WrappedProgram, MayItselfBeWrapped) {
  const WrappedProgram inside(test::handler_agent(), parse_fault("stall 1 s every 4 s"));
  const WrappedProgram outside(inside.type(), parse_fault("stall 2 s every 7 s"));
  EXPECT_STREQ(outside.type().name, "handler with stall 1 s every 4 s with stall 2 s every 7 s");
  EXPECT_EQ(outside.type().flags, test::handler_agent().flags);
  int rings = 0;
  const test::Handler ring = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    rings += e.kind == FP_EVENT_TIMER ? 1 : 0;
    host.set_timer(c, 1, e.now_ns + 500'000'000);
  };
  test::current_handler = &ring;
  EXPECT_FALSE(test::watched(test::row_of_tens({0}, 30.0), outside.type(), {}).outcome.crash);
  EXPECT_GT(rings, 20);
  EXPECT_LT(rings, 45) << "of 60";
  const test::Handler thief = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event&) {
    host.set_timer(c, 0xffff'fff0U, 1);
  };
  test::current_handler = &thief;
  EXPECT_THAT(test::watched(test::row_of_tens({0}, 5.0), outside.type(), {}).outcome.message,
              HasSubstr("sets timer 4294967280, which a fault around the program uses"));
  test::current_handler = nullptr;
}

}  // namespace
}  // namespace fleetproof::wrapped_program_test
