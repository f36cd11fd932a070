// Programs as straight-line code: what they wait for, how they end, and what they leave behind. Digests beside those of
// callbacks: ../contract/agents/straight_line_test.cpp.
#include "core/sdk/fleetproof/blocking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <cstddef>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/engine/simulation.hpp"
#include "tests/core/row_of_tens.hpp"

#ifdef FP_SANITIZES_ADDRESSES
#include <sanitizer/lsan_interface.h>
#endif

namespace fleetproof::blocking_test {
namespace {

using namespace std::chrono_literals;
using blocking::Controller;
using testing::ElementsAre;
using testing::HasSubstr;

using Program = std::function<void(Controller&)>;
const Program* current_program = nullptr;

void run_current_program(Controller& agv) { (*current_program)(agv); }

Outcome run(const Scenario& scenario, const Program& program) {
  static const fp_agent_type kType = blocking::agent_type<run_current_program>("current", "runs a test's program");
  current_program = &program;
  const Outcome outcome = simulate(scenario, kType, {});
  current_program = nullptr;
  return outcome;
}

double seconds_of(blocking::Duration instant) { return std::chrono::duration<double>(instant).count(); }

Scenario one_agv() { return test::row_of_tens({0}); }

// AGV 0 does what the test says; all others say "x" once a second.
Scenario with_chatter() {
  Scenario scenario = test::row_of_tens({0, 3});
  scenario.radio.delay_s = 0.25;
  return scenario;
}
void chatter(Controller& agv) {
  while (true) {
    agv.sleep(1s);
    agv.broadcast('x');
  }
}

TEST(Blocking, AMoveReturnsWhenItHasEnded) {
  std::vector<double> at_s;
  run(one_agv(), [&](Controller& agv) {
    EXPECT_EQ(agv.move(0), FP_OK);
    at_s.push_back(seconds_of(agv.now()));
    EXPECT_EQ(agv.move(7), FP_INVALID) << "no such segment: returns at once";
    agv.sleep(2s);
    EXPECT_EQ(agv.move(1), FP_OK);
    at_s.push_back(seconds_of(agv.now()));
  });
  EXPECT_THAT(at_s, ElementsAre(testing::DoubleNear(8.0, 1e-6), testing::DoubleNear(18.0, 1e-6)));
}

TEST(Blocking, AWaitForAMessageEndsWithItOrWithItsTime) {
  std::vector<double> at_s;
  run(with_chatter(), [&](Controller& agv) {
    if (agv.briefing().self != 0) return chatter(agv);
    EXPECT_FALSE(agv.wait_message(500ms));
    at_s.push_back(seconds_of(agv.now()));
    const auto message = agv.wait_message(2s);
    at_s.push_back(seconds_of(agv.now()));
    ASSERT_TRUE(message);
    EXPECT_EQ(message->sender, 1U);
    EXPECT_EQ(message->as<char>(), 'x');
    EXPECT_FALSE(message->as<int>()) << "has another size";
    EXPECT_FALSE(agv.get_message());
    EXPECT_FALSE(agv.wait_message(900ms)) << "the timer of the wait before has gone off meanwhile";
    at_s.push_back(seconds_of(agv.now()));
    agv.sleep(5s);
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(agv.wait_message(0s)) << "was kept meanwhile";
    EXPECT_FALSE(agv.wait_message(0s));
    at_s.push_back(seconds_of(agv.now()));
  });
  ASSERT_EQ(at_s.size(), 4U);
  EXPECT_EQ(at_s[0], 0.5);
  EXPECT_NEAR(at_s[1], 1.251, 0.01);
  EXPECT_EQ(at_s[2], at_s[1] + 0.9);
  EXPECT_EQ(at_s[3], at_s[2] + 5.0);
}

TEST(Blocking, ATimerThatWentOffWhileTheProgramThoughtEndsNoLaterWait) {
  std::vector<double> at_s;
  run(with_chatter(), [&](Controller& agv) {
    if (agv.briefing().self != 0) return chatter(agv);
    EXPECT_TRUE(agv.wait_message(1500ms));
    agv.call(&fp_host::declare_cost_ns, std::int64_t{500'000'000});
    EXPECT_EQ(agv.wait(blocking::kOrder, 3s).kind, blocking::kTimeIsUp);
    at_s.push_back(seconds_of(agv.now()));
  });
  EXPECT_THAT(at_s, ElementsAre(testing::DoubleNear(4.251, 0.01)));
}

// Orders that come during a drive are kept, in their order.
TEST(Blocking, WhatNobodyWaitsForIsKept) {
  Scenario scenario = one_agv();
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)},
                                 {StationId{1U}, StationId{2U}, seconds(3.0)},
                                 {StationId{2U}, StationId{3U}, seconds(20.0)}};
  std::vector<std::uint32_t> from;
  run(scenario, [&](Controller& agv) {
    EXPECT_EQ(agv.move(0), FP_OK);
    EXPECT_FALSE(agv.wait_message(1s)) << "orders are no messages";
    from.push_back(agv.wait_order().from);
    from.push_back(agv.wait_order(1s).value().from);
    EXPECT_FALSE(agv.wait_order(1s));
    const blocking::Event event = agv.wait(blocking::kAnything);
    EXPECT_EQ(event.kind, blocking::kOrder);
    EXPECT_EQ(agv.now(), 20s);
    from.push_back(event.order().from);
  });
  EXPECT_THAT(from, ElementsAre(0U, 1U, 2U));
}

TEST(Blocking, AnActionIsBegunWhileAnotherIsUnderWay) {
  run(one_agv(), [&](Controller& agv) {
    EXPECT_EQ(agv.begin(FP_CALL_MOVE, 0), FP_OK);
    agv.sleep(1s);
    EXPECT_EQ(agv.action(), FP_DRIVING);
    EXPECT_EQ(agv.move(1), FP_OK) << "waits for both";
    EXPECT_NEAR(seconds_of(agv.now()), 13.0, 0.1);
    EXPECT_EQ(agv.wait(blocking::kDone, 1s).kind, blocking::kTimeIsUp);
    EXPECT_EQ(agv.begin(FP_CALL_MOVE, 2), FP_OK);
    EXPECT_EQ(agv.wait(blocking::kDone).told.result, FP_OK);
    EXPECT_EQ(agv.position().value().x_m, 30.0);
  });
}

TEST(Blocking, AProgramBeginsAgainAfterARestartAndWaitsForWhatIsUnderWay) {
  Scenario scenario = one_agv();
  scenario.faults = {test::fault(Fault::Kind::Restart, 3.0, 2.0), test::fault(Fault::Kind::Restart, 20.0, 2.0)};
  std::vector<double> at_s;
  int freed = 0;
  const Outcome outcome = run(scenario, [&](Controller& agv) {
    const std::shared_ptr<void> object(nullptr, [&](void*) { ++freed; });
    if (agv.briefing().boot == 0) {
      agv.move(0);
      ADD_FAILURE() << "the run of this boot has ended";
    }
    if (agv.briefing().boot == 2) agv.sleep(15s);
    agv.wait_until_rest();
    at_s.push_back(seconds_of(agv.now()));
    EXPECT_EQ(agv.wait(blocking::kDone, 0s).kind, blocking::kTimeIsUp) << "it was an action of the former boot";
    if (agv.briefing().boot == 2) return;
    EXPECT_EQ(agv.move(1), FP_OK);
    at_s.push_back(seconds_of(agv.now()));
    agv.move(2);
  });
  EXPECT_THAT(at_s, ElementsAre(testing::DoubleNear(8.0, 1e-6), testing::DoubleNear(16.0, 1e-6), 37.0));
  EXPECT_EQ(freed, 3);
  EXPECT_FALSE(outcome.crash) << outcome.message;
}

// ---- exceptions

TEST(Blocking, WhatAProgramThrowsIsFiled) {
  const Outcome outcome = run(one_agv(), [](Controller& agv) {
    agv.sleep(1s);
    throw std::runtime_error("no map of this floor");
  });
  EXPECT_TRUE(outcome.crash);
  EXPECT_THAT(outcome.message, HasSubstr("no map of this floor"));
}

// Each program waits inside a catch block while the others catch theirs.
TEST(Blocking, ProgramsRethrowWhatTheyHaveCaughtThemselves) {
  std::vector<std::string> rethrown(3);
  run(test::row_of_tens({0, 1, 2}), [&](Controller& agv) {
    const std::uint32_t self = agv.briefing().self;
    try {
      try {
        throw std::runtime_error(std::to_string(self));
      } catch (const std::runtime_error&) {
        agv.sleep(std::chrono::seconds(3 - self));
        throw;
      }
    } catch (const std::runtime_error& error) {
      rethrown[self] = error.what();
    }
    EXPECT_EQ(std::uncaught_exceptions(), 0);
    EXPECT_EQ(std::current_exception(), nullptr);
  });
  EXPECT_THAT(rethrown, ElementsAre("0", "1", "2"));
}

// ---- the end of a run

class Counted {
 public:
  explicit Counted(int& alive) : alive_(alive) { ++alive_; }
  ~Counted() { --alive_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  int& alive_;
};

TEST(Blocking, TheEndOfARunFreesWhatAProgramHolds) {
  int alive = 0;
  const std::uint64_t before = blocking::abandoned_programs();
  run(test::row_of_tens({0, 1, 2, 3}), [&](Controller& agv) {
    const Counted outer(alive);
    const auto wait_deep_inside = [&] {
      const std::vector<std::unique_ptr<Counted>> many = [&] {
        std::vector<std::unique_ptr<Counted>> made;
        for (int i = 0; i < 10; ++i) made.push_back(std::make_unique<Counted>(alive));
        return made;
      }();
      agv.wait_order();
    };
    const std::uint32_t self = agv.briefing().self;
    if (self == 0) return;
    try {
      if (self == 1) throw std::runtime_error("waits inside a catch block");
      wait_deep_inside();
    } catch (const std::exception&) {
      EXPECT_EQ(self, 1U) << "the end is no std::exception";
      wait_deep_inside();
    }
    ADD_FAILURE() << "nothing may be carried out after the end";
  });
  EXPECT_EQ(alive, 0);
  EXPECT_EQ(blocking::abandoned_programs(), before);
}

// What an abandoned program holds is a leak on purpose.
class LeaksOnPurpose {
 public:
#ifdef FP_SANITIZES_ADDRESSES
  LeaksOnPurpose() { __lsan_disable(); }
  ~LeaksOnPurpose() { __lsan_enable(); }
#else
  LeaksOnPurpose() {}
#endif
};

TEST(Blocking, AProgramThatCatchesTheEndIsAbandonedAndCounted) {
  const LeaksOnPurpose on_purpose;
  int alive = 0, waits = 0;
  const std::uint64_t before = blocking::abandoned_programs();
  Scenario scenario = one_agv();
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)}};
  const Outcome outcome = run(scenario, [&](Controller& agv) {
    Counted object(alive);
    while (true) {
      try {
        agv.wait(++waits == 1 ? blocking::kMessage : blocking::kOrder);
      } catch (...) {
      }
    }
  });
  EXPECT_EQ(waits, 2) << "the second wait has left for good, although an order was kept";
  EXPECT_EQ(alive, 1);
  EXPECT_EQ(blocking::abandoned_programs(), before + 1);
  EXPECT_FALSE(outcome.crash) << outcome.message;
}

// The end, thrown there, would end the process.
TEST(Blocking, AProgramThatWaitsWhileAnExceptionPassesIsAbandoned) {
  struct SaysGoodbye {
    Controller& agv;
    ~SaysGoodbye() { agv.sleep(1000s); }
  };
  const LeaksOnPurpose on_purpose;
  const std::uint64_t before = blocking::abandoned_programs();
  const Outcome outcome = run(one_agv(), [&](Controller& agv) {
    const SaysGoodbye goodbye{agv};
    throw std::runtime_error("nothing to do");
  });
  EXPECT_FALSE(outcome.crash) << "the exception has not arrived";
  EXPECT_EQ(blocking::abandoned_programs(), before + 1);
}

TEST(Blocking, ACallInADestructorAfterTheEndDoesNothing) {
  struct Brakes {
    Controller& agv;
    std::int32_t& result;
    ~Brakes() { result = agv.call(&fp_host::stop); }
  };
  std::int32_t result = FP_OK;
  const Outcome outcome = run(one_agv(), [&](Controller& agv) {
    const Brakes brakes{agv, result};
    agv.wait_order();
  });
  EXPECT_EQ(result, FP_SUSPENDED);
  EXPECT_FALSE(outcome.crash) << outcome.message;
}

TEST(Blocking, AProgramMayReturn) {
  Scenario scenario = with_chatter();
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)}};
  const Outcome outcome = run(scenario, [](Controller& agv) {
    if (agv.briefing().self != 0) chatter(agv);
  });
  EXPECT_FALSE(outcome.crash) << outcome.message;
  EXPECT_EQ(outcome.counters.received, 59U);
}

// ---- loops that do not end are hangs, and end the run

TEST(Blocking, ALoopOfCallsIsAHang) {
  int alive = 0;
  const Outcome outcome = run(one_agv(), [&](Controller& agv) {
    const Counted object(alive);
    while (agv.move(7) != FP_OK) continue;
  });
  EXPECT_TRUE(outcome.hang);
  EXPECT_FALSE(outcome.crash);
  EXPECT_EQ(alive, 0);
}

TEST(Blocking, ALoopOfWaitsWithoutTimeIsAHang) {
  const Outcome outcome = run(one_agv(), [](Controller& agv) {
    while (true) agv.wait_message(-1s);
  });
  EXPECT_TRUE(outcome.hang);
  EXPECT_THAT(outcome.message, HasSubstr("10 000 activations without time advancing"));
}

// ---- calls

TEST(Blocking, AFunctionThatTheProgramDoesNotKnowIsInvalid) {
  run(one_agv(), [](Controller& agv) {
    fp_host older{};
    older.struct_size = offsetof(fp_host, keep);
    Controller with_older(older, nullptr, agv.briefing());
    EXPECT_EQ(with_older.call(&fp_host::keep, 1u, nullptr, 0u), FP_INVALID);
    EXPECT_EQ(agv.call(&fp_host::keep, 1u, "two", 3u), FP_OK);
    agv.call(&fp_host::describe, "GRANT");
    EXPECT_EQ(agv.call(&fp_host::random, 0u, std::uint64_t{1}), agv.call(&fp_host::random, 0u, std::uint64_t{1}));
  });
}

// ---- memory

std::size_t mapping_count() {
  std::ifstream maps("/proc/self/maps");
  return static_cast<std::size_t>(std::count(std::istreambuf_iterator<char>(maps), {}, '\n'));
}

TEST(Blocking, RunsLeaveNothingBehind) {
  const Scenario scenario = test::row_of_tens({0, 1, 2, 3}, 2.0);
  int alive = 0;
  const auto run_many = [&](int runs) {
    for (int i = 0; i < runs; ++i) {
      run(scenario, [&](Controller& agv) {
        const Counted object(alive);
        const std::vector<char> bytes(5000);
        agv.wait_message(agv.briefing().self % 2 == 0 ? 1s : 10s);
      });
    }
  };
  run_many(3);
  const std::size_t mappings = mapping_count(), heap = mallinfo2().uordblks;
  run_many(500);
  EXPECT_LE(mapping_count(), mappings + 2) << "stacks are used again";
#ifndef FP_SANITIZES_ADDRESSES
  EXPECT_LT(mallinfo2().uordblks, heap + 100'000);
#endif
  EXPECT_EQ(alive, 0);
}

#if !defined(FP_SANITIZES_ADDRESSES) && !defined(FP_SANITIZES_THREADS)
[[gnu::noinline]] std::size_t sum_of_depths(std::size_t depth) {
  volatile char room[1000] = {};
  return depth == 0 ? room[0] : depth + sum_of_depths(depth - 1) + static_cast<std::size_t>(room[999]);
}

TEST(BlockingDeathTest, AStackThatOverflowsEndsTheProcess) {
  const auto to_depth = [](std::size_t depth) {  // below the stack of AGV 0 lie those of the others
    std::size_t sum = 0;
    run(test::row_of_tens({0, 1, 2, 3}), [&](Controller& agv) {
      agv.sleep(1s);
      if (agv.briefing().self == 0) sum = sum_of_depths(depth);
    });
    return sum;
  };
  EXPECT_EXIT(to_depth(400), testing::KilledBySignal(SIGSEGV), "");
  EXPECT_EQ(to_depth(200), 20'100U);
}
#endif

}  // namespace
}  // namespace fleetproof::blocking_test
