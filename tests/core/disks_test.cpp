#include "core/engine/disks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/sdk/fleetproof/agent.h"
#include "tests/core/small_world.hpp"
#include "tests/core/told_run.hpp"

namespace fleetproof::disks_test {
namespace {

using test::fault;
using test::kFirst;
using test::kSecond;

constexpr std::size_t kRoom = FP_DISK_BYTES - FP_RECORD_OVERHEAD;  // of a disk with one record

// ---- the part

class DisksPart : public testing::Test {
 protected:
  bool keeps(AgvId agv, std::uint32_t number, const std::string& bytes) {
    if (!disks.accept(agv, number, disk_record(bytes))) return false;
    disks.write(agv);
    return true;
  }
  std::string found(AgvId agv, std::uint32_t number) const {
    const DiskRecord* record = disks.find(agv, number);
    return record == nullptr ? "none" : record->bytes;
  }
  test::SmallWorld world{test::row_of_tens({0, 2})};
  Disks& disks = world.parts.disks;
};

TEST_F(DisksPart, KeepsNumberedRecordsOfEachParticipant) {
  EXPECT_TRUE(keeps(kFirst, 7, "one") && keeps(kFirst, FP_NONE, "other") && keeps(kSecond, 7, "of another"));
  EXPECT_TRUE(keeps(kFirst, 7, "newer"));
  EXPECT_EQ(found(kFirst, 7), "newer");
  EXPECT_EQ(found(kFirst, FP_NONE), "other");
  EXPECT_EQ(found(kSecond, 7), "of another");
  EXPECT_EQ(found(kSecond, 8), "none");
  EXPECT_TRUE(keeps(kFirst, 7, ""));
  EXPECT_EQ(found(kFirst, 7), "none") << "an empty record deletes";
}

TEST_F(DisksPart, HoldsNoMoreThanOneMegabyteWithItsOverhead) {
  EXPECT_FALSE(keeps(kFirst, 1, std::string(kRoom + 1, 'x')));
  EXPECT_EQ(found(kFirst, 1), "none");
  EXPECT_TRUE(keeps(kFirst, 1, std::string(kRoom, 'x')));
  EXPECT_FALSE(keeps(kFirst, 2, "y")) << "it is full";
  EXPECT_FALSE(keeps(kFirst, 1, std::string(kRoom + 1, 'z')));
  EXPECT_EQ(found(kFirst, 1), std::string(kRoom, 'x')) << "what is refused changes nothing";
  EXPECT_TRUE(keeps(kSecond, 1, "y")) << "another disk";
  EXPECT_TRUE(keeps(kFirst, 1, std::string(kRoom - FP_RECORD_OVERHEAD - 1, 'x')) && keeps(kFirst, 2, "y"));
  EXPECT_TRUE(keeps(kFirst, 2, "") && keeps(kFirst, 1, std::string(kRoom, 'x'))) << "what is deleted takes no room";
}

TEST_F(DisksPart, FindsWhatIsAcceptedAndForgetsItWithTheComputer) {
  ASSERT_TRUE(keeps(kFirst, 1, "old"));
  EXPECT_TRUE(disks.accept(kFirst, 1, disk_record("new")) && disks.accept(kFirst, 2, disk_record("second")));
  EXPECT_EQ(found(kFirst, 1), "new");
  disks.write(kFirst);
  EXPECT_TRUE(disks.accept(kFirst, 1, disk_record("")));
  EXPECT_EQ(found(kFirst, 1), "none");
  disks.forget(kFirst);
  EXPECT_EQ(found(kFirst, 1), "new") << "it was written, and then not yet deleted";
  EXPECT_EQ(found(kFirst, 2), "none");
  EXPECT_TRUE(keeps(kFirst, 2, std::string(kRoom - FP_RECORD_OVERHEAD - 3, 'x'))) << "the room is there again";
  disks.lose(kFirst);
  EXPECT_EQ(found(kFirst, 1), "none");
  EXPECT_TRUE(keeps(kFirst, 1, std::string(kRoom, 'x')));
}

// With costs, an agent may replace a record often before the first of them is written.
TEST_F(DisksPart, TakesFourTimesItsSizeInHand) {
  const std::string full(kRoom, 'x');
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(disks.accept(kFirst, 1, disk_record(full)));
  EXPECT_FALSE(disks.accept(kFirst, 1, disk_record(full)));
  disks.write(kFirst);
  EXPECT_TRUE(disks.accept(kFirst, 1, disk_record(full)));
  disks.forget(kFirst);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(disks.accept(kFirst, 1, disk_record(full)));
}

TEST_F(DisksPart, RefusesToMakeARecordThatFitsOnNoDisk) {
  EXPECT_THROW(disk_record(std::string(FP_DISK_BYTES + 1, 'x')), InvariantViolation);
}

// ---- whole runs

// What an agent finds under number 1 at each of its starts.
std::string recalled(const fp_host& host, fp_controller* c, std::uint32_t number = 1) {
  fp_record record{};
  record.struct_size = sizeof record;
  const std::int32_t result = host.recall(c, number, &record);
  return result == FP_OK ? std::string(static_cast<const char*>(record.bytes), record.size) : std::to_string(result);
}
std::int32_t keep(const fp_host& host, fp_controller* c, const std::string& bytes, std::uint32_t number = 1) {
  return host.keep(c, number, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
}

using Found = std::map<std::uint32_t, std::vector<std::string>>;  // by participant

Found found_at_starts(const Scenario& scenario, test::Recorder* trace = nullptr) {
  Found found;
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START) return;
    found[b.self].push_back(recalled(host, c));
    EXPECT_EQ(keep(host, c, "of boot " + std::to_string(b.boot)), FP_OK);
  };
  const Outcome outcome = test::simulate_with(scenario, handler, trace);
  EXPECT_FALSE(outcome.crash || outcome.engine_error) << outcome.message;
  return found;
}

Fault of(std::uint32_t participant, Fault::Kind kind, double at_s) {
  Fault one = fault(kind, at_s, 2.0);
  one.agv = EntityId{participant};
  return one;
}

TEST(Disks, OutliveRestartsAndPowerFailuresAndNothingOutlivesTheirLoss) {
  Scenario scenario = test::row_of_tens({0, 3}, 60.0);
  scenario.computers.push_back({.name = "server"});
  for (const std::uint32_t participant : {0U, 2U}) {
    scenario.faults.push_back(of(participant, Fault::Kind::Restart, 5.0));
    scenario.faults.push_back(of(participant, Fault::Kind::PowerFailure, 15.0));
    scenario.faults.push_back(of(participant, Fault::Kind::DiskLoss, 25.0));
    scenario.faults.push_back(of(participant, Fault::Kind::Restart, 35.0));
  }
  const std::vector<std::string> all{"1", "of boot 0", "of boot 1", "1", "of boot 3"};
  test::Recorder trace;
  EXPECT_EQ(found_at_starts(scenario, &trace), (Found{{0, all}, {1, {"1"}}, {2, all}}));
  ASSERT_EQ(trace.of(TraceKind::Kept).size(), 11U);
  const auto kept = read<traced::Kept>(trace.of(TraceKind::Kept)[0]);
  EXPECT_EQ(kept.number, 1U);
  EXPECT_EQ(kept.size, 9U);
  EXPECT_EQ(kept.hash, disk_hash("of boot 0"));
}

// The agent keeps a record with its first call; the second call is `declare_cost_ns`, and the third keeps another one.
TEST(Disks, ARecordIsThereAfterTheCostsSoFarAndNotIfTheComputerGoesDownBefore) {
  for (const double restart_s : {1.5, 3.5}) {
    Scenario scenario = test::row_of_tens({0}, 20.0);
    scenario.faults = {of(0, Fault::Kind::PowerFailure, restart_s)};
    std::vector<std::string> found;
    const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
      if (e.kind != FP_EVENT_START) return;
      if (b.boot == 0) {
        EXPECT_EQ(keep(host, c, "early"), FP_OK);
        EXPECT_EQ(host.declare_cost_ns(c, 3'000'000'000), FP_OK);
        EXPECT_EQ(keep(host, c, "late"), FP_OK);
      }
      found.push_back(recalled(host, c));
    };
    test::simulate_with(scenario, handler);
    EXPECT_EQ(found, (std::vector<std::string>{"late", restart_s < 3.0 ? "early" : "late"}));
  }
}

TEST(Disks, AnswerWrongArgumentsWithoutLookingAtThem) {
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind != FP_EVENT_START) return;
    fp_record record{};
    EXPECT_EQ(host.keep(c, 1, nullptr, 1), FP_INVALID);
    EXPECT_EQ(host.keep(c, 1, nullptr, 0), FP_OK);
    EXPECT_EQ(host.keep(c, 1, "x", 0xffffffffU), FP_REFUSED);
    EXPECT_EQ(host.recall(c, 1, nullptr), FP_INVALID);
    EXPECT_EQ(host.recall(c, 1, &record), FP_INVALID) << "it says no size";
    record.struct_size = sizeof record;
    EXPECT_EQ(host.recall(c, 1, &record), FP_EMPTY);
  };
  const Outcome outcome = test::simulate_with(test::row_of_tens({0}, 5.0), handler);
  EXPECT_EQ(outcome.counters.agent_calls, 6U) << "each counts as a call";
}

// Both disks fill up; records are replaced, deleted and refused.
void fill(const fp_host& host, fp_controller* c, const fp_event& e) {
  if (e.kind != FP_EVENT_START && e.kind != FP_EVENT_TIMER) return;
  const auto step = static_cast<std::uint32_t>(e.now_ns / 1'000'000'000);
  const std::int32_t result = keep(host, c, std::string(200'000 + 1000 * step, 'x'), step % 7);
  if (result == FP_REFUSED) {
    host.keep(c, (step + 3) % 7, nullptr, 0);
    host.log(c, "full");
  }
  host.keep(c, 3, "x", 0xffffffffU);
  host.log(c, recalled(host, c, 2).substr(0, 3).c_str());
  host.set_timer(c, 1, e.now_ns + 1'000'000'000);
}

TEST(Disks, ARecordedRunPlaysTheSameWithoutTheBytes) {
  Scenario scenario = test::row_of_tens({0, 3}, 40.0);
  scenario.agent_clock.call_cost_s = 0.1;
  scenario.faults = {of(0, Fault::Kind::Restart, 10.05), of(1, Fault::Kind::DiskLoss, 20.0)};
  const test::Handler handler = [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    fill(host, c, e);
  };
  test::current_handler = &handler;
  const test::ToldRun recorded = test::recorded(scenario, test::handler_agent());
  test::expect_same(test::watched(scenario, test::handler_agent(), {}), recorded);
  test::current_handler = nullptr;
  EXPECT_FALSE(recorded.outcome.crash) << recorded.outcome.message;
  EXPECT_GT(std::ranges::count(recorded.trace, TraceKind::Kept,
                               [](const test::ToldRun::Line& line) { return std::get<TraceKind>(line); }),
            20);
  EXPECT_LT(recorded.tape.size(), 10'000U) << "nobody reads what was kept when a tape is played";
  test::expect_same(test::played(scenario, recorded.tape), recorded);
}

}  // namespace
}  // namespace fleetproof::disks_test
