// The zone-server by itself: what it grants is on its disk before, and a new self goes on with that.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/stub_host.hpp"

namespace fleetproof::agents::central::zone_server_test {
namespace {

using testing::DrawnMap;
using testing::StubHost;
using testing::TestFleet;

// Three stations in a row, and two AGVs; AGV 0 stands at the first one, AGV 1 at the last one.
class ServerOfTwoAgvs : public ::testing::Test {
 protected:
  static DrawnMap row() {
    DrawnMap drawn;
    for (int i = 0; i < 3; ++i) drawn.station(8.0 * i, 0, FP_STORAGE);
    for (std::uint32_t i = 0; i < 2; ++i) drawn.segment(i, i + 1);
    return drawn;
  }
  ServerOfTwoAgvs() {
    briefing.role = FP_COMPUTER;
    briefing.computer_count = 1;
    start();
  }

  void tell(std::uint32_t kind, std::uint32_t order = FP_NONE) {
    fp_event event{};
    event.struct_size = sizeof event;
    event.kind = kind;
    event.now_ns = now_ns += 3 * kSecond_ns;  // an AGV that waits is looked at again
    event.order_id = order, event.from = 1, event.to = 0;
    server->on_event(event);
  }
  void start() {
    host.sent.clear();
    server.reset(create(host.table, host.handle(), briefing, ServerOptions{}));
    tell(FP_EVENT_START);
  }
  void start_again() {
    ++briefing.boot;
    start();
  }
  void says(std::uint32_t agv, std::uint32_t station, WayNumber way = {}) {
    State state;
    state.way = way;
    state.stands = true;
    state.station = station;
    state.number = ++messages;
    host.inbox.emplace_back(agv, encode(state));
    tell(FP_EVENT_MESSAGE);
  }
  void join_with_work() {
    says(0, 0);
    says(1, 2);
    tell(FP_EVENT_ORDER, 7);
    tell(FP_EVENT_TIMER);
  }
  // The newest steps that were sent to the AGV with the work.
  std::vector<Step> granted() const {
    std::vector<Step> steps;
    for (const StubHost::Bytes& bytes : host.sent) {
      const std::optional<Grant> grant = decode_as<Grant>(bytes);
      if (grant && !grant->steps.empty()) steps = grant->steps;
    }
    return steps;
  }

  DrawnMap drawn = row();
  TestFleet fleet{drawn.map(), 2};
  fp_briefing briefing = fleet.briefing(2, 0);
  StubHost host;
  std::unique_ptr<Program> server;
  std::uint32_t messages = 0;
  std::int64_t now_ns = 0;
};

TEST_F(ServerOfTwoAgvs, GoesOnWithWhatItHadGranted) {
  join_with_work();
  const std::vector<Step> steps = granted();
  ASSERT_FALSE(steps.empty());
  start_again();
  EXPECT_EQ(granted(), steps) << "sent again, and no AGV has said anything";
  EXPECT_EQ(host.probes.count("recalled"), 1U);
}

TEST_F(ServerOfTwoAgvs, WithoutItsDiskItWaitsForAll) {
  join_with_work();
  host.disk.clear();
  start_again();
  tell(FP_EVENT_ORDER, 7);
  says(0, 0, {1, 0});
  tell(FP_EVENT_TIMER);
  EXPECT_TRUE(granted().empty());
  says(1, 2, {1, 0});
  tell(FP_EVENT_TIMER);
  EXPECT_FALSE(granted().empty());
  EXPECT_EQ(host.probes.count("recalled"), 0U);
}

TEST_F(ServerOfTwoAgvs, SendsNothingThatItsDiskDoesNotTake) {
  host.disk_is_full = true;
  join_with_work();
  EXPECT_TRUE(granted().empty());
  host.disk_is_full = false;
  tell(FP_EVENT_TIMER);
  EXPECT_FALSE(granted().empty());
}

TEST_F(ServerOfTwoAgvs, SaysThatAnAgvWasSetDownWhereAnotherOneMayDrive) {
  join_with_work();
  says(0, 0, {0, 1});
  says(1, 2, {0, 1});
  EXPECT_EQ(host.probes.count("set-down-in-the-way"), 0U) << "they stand where they stood";
  tell(FP_EVENT_TIMER);
  ASSERT_FALSE(granted().empty());
  says(0, 1, {0, 2});
  says(1, 1, {0, 2});
  EXPECT_EQ(host.probes.count("set-down-in-the-way"), 1U);
}

}  // namespace
}  // namespace fleetproof::agents::central::zone_server_test
