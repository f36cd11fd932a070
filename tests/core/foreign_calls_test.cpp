// The seam to code that is not part of the program, without such code.
#include "core/engine/foreign_calls.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <limits>
#include <set>
#include <string>
#include <thread>

#include "core/engine/agv_controller.hpp"
#include "core/engine/foreign_table.hpp"

namespace fleetproof::foreign_calls_test {
namespace {

ForeignHandle& handle_of(fp_controller* given) { return *reinterpret_cast<ForeignHandle*>(given); }

TEST(ForeignHandle, AdmitsTheThreadThatCallsTheAgentWhileItDoes) {
  ForeignHandles handles;
  ForeignCalls calls(handles);
  fp_controller controller;
  ForeignHandle& handle = handle_of(calls.lend(AgvId{2U}, &controller));
  EXPECT_FALSE(handle.admits()) << "before its call";
  {
    const ForeignCalls::UnderWay call(calls, AgvId{2U});
    EXPECT_TRUE(handle.admits());
  }
  EXPECT_FALSE(handle.admits()) << "after its call";
  EXPECT_EQ(calls.take_back(AgvId{2U}), "") << "from its own thread that is no fault";
}

TEST(ForeignHandle, RefusesAnotherThreadAndNotesIt) {
  ForeignHandles handles;
  ForeignCalls calls(handles);
  fp_controller controller;
  fp_controller* given = calls.lend(AgvId{0U}, &controller);
  const ForeignCalls::UnderWay call(calls, AgvId{0U});
  std::thread other([&] {
    EXPECT_EQ(kForeignHost.move(given, 0), FP_SUSPENDED);
    EXPECT_EQ(kForeignHost.now_ns(given), 0);
    EXPECT_EQ(kForeignHost.random(given, 1, 2), 0U);
    kForeignHost.describe(given, "GRANT");
  });
  other.join();
  EXPECT_NE(calls.take_back(AgvId{0U}).find("from another thread"), std::string::npos);
}

TEST(ForeignHandle, OfAnAgentThatIsGoneIsRefusedInLaterRunsToo) {
  ForeignHandles handles;
  fp_controller controller;
  fp_controller* late = nullptr;
  {
    ForeignCalls run(handles);
    late = run.lend(AgvId{3U}, &controller);
    EXPECT_EQ(run.take_back(AgvId{3U}), "");
  }
  ForeignCalls run(handles);
  EXPECT_NE(run.lend(AgvId{3U}, &controller), late) << "a handle rests before another agent gets it";
  const ForeignCalls::UnderWay call(run, AgvId{3U});
  EXPECT_EQ(kForeignHost.move(late, 0), FP_SUSPENDED);
  EXPECT_NE(run.take_back(AgvId{3U}).find("that of AGV 3, called its controller after destroy()"), std::string::npos);
  EXPECT_FALSE(handles.take_late_caller().valid()) << "it is told once";
}

TEST(ForeignHandle, IsUsedAgainWhenManyOthersHaveRested) {
  ForeignHandles handles;
  fp_controller controller;
  std::set<fp_controller*> seen;
  for (int i = 0; i < 100'000; ++i) {
    ForeignCalls run(handles);
    seen.insert(run.lend(AgvId{0U}, &controller));
  }
  EXPECT_GT(seen.size(), 10'000U);
  EXPECT_LT(seen.size(), 20'000U) << "memory stays bounded";
}

// As 1 + 1e-20 comes out: upward it is more than 1.
bool rounds_upward() {
  const volatile double one = 1.0, little = 1e-20;
  return one + little > 1.0;
}

TEST(ProcessorState, IsSetBackAfterACallAndCounted) {
  ForeignHandles handles;
  ForeignCalls calls(handles);
  fp_controller controller;
  calls.lend(AgvId{0U}, &controller);
  for (const bool changes : {true, false, true}) {
    const ForeignCalls::UnderWay call(calls, AgvId{0U});
    if (changes) std::fesetround(FE_UPWARD);
    EXPECT_EQ(rounds_upward(), changes);
  }
  EXPECT_FALSE(rounds_upward());
  EXPECT_EQ(calls.processor_changes(), 2U);
  {
    const ForeignCalls::UnderWay call(calls, AgvId{0U});
    std::feraiseexcept(FE_ALL_EXCEPT);
  }
  EXPECT_EQ(calls.processor_changes(), 2U) << "flags are no state";
}

TEST(ProcessorState, OfTheEngineGivesTheOtherOneBack) {
  std::fesetround(FE_UPWARD);
  {
    const EngineProcessorState ours;
    EXPECT_FALSE(rounds_upward());
  }
  EXPECT_TRUE(rounds_upward());
  set_engine_processor_state();
  EXPECT_FALSE(rounds_upward());
}

// An exception that is pending must not end the program when the agent's state comes back.
TEST(ProcessorState, WithTrapsSurvivesWhatTheEngineComputes) {
  feenableexcept(FE_INEXACT);
  {
    const EngineProcessorState ours;
    const volatile double three = 3.0;
    EXPECT_NEAR(1.0 / three, 0.333, 0.001);
    const volatile long double third = 1.0L / static_cast<long double>(three);
    EXPECT_GT(third, 0.0L);
  }
  set_engine_processor_state();
  EXPECT_TRUE(has_engine_processor_state());
}

}  // namespace
}  // namespace fleetproof::foreign_calls_test
