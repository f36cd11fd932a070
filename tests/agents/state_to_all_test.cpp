// How often an AGV of a fleet that is divided into zones tells all others its state.
#include <gtest/gtest.h>

#include "core/agents/lock_protocol.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::state_to_all_test {
namespace {

// The only AGV of its fleet that says anything.
struct Teller {
  static constexpr std::int64_t kPause_ns = kSecond_ns / 2;

  explicit Teller(std::uint32_t fleet_count) : fleet(drawn.map(), fleet_count) {
    host.now_ns = [](fp_controller* c) { return of(c).now_ns; };
    host.get_position = [](fp_controller*, fp_pose*) -> std::int32_t { return FP_REFUSED; };
    host.sometimes = [](fp_controller*, const char*) -> std::int32_t { return FP_OK; };
    host.send_unicast = [](fp_controller*, const void*, std::uint32_t, std::uint32_t) -> std::int32_t { return FP_OK; };
    host.send_broadcast = [](fp_controller* c, const void*, std::uint32_t) -> std::int32_t {
      ++of(c).told_all;
      return FP_OK;
    };
    protocol.stand({});
  }
  static Teller& of(fp_controller* c) { return *reinterpret_cast<Teller*>(c); }

  std::uint32_t told_all_in(double duration_s) {
    told_all = 0;
    for (const std::int64_t end_ns = now_ns + static_cast<std::int64_t>(duration_s * 1e9); now_ns < end_ns;) {
      now_ns += kPause_ns;
      protocol.repeat();
    }
    return told_all;
  }

  testing::DrawnMap drawn = [] {
    testing::DrawnMap d;
    d.segment(d.station(0, 0), d.station(6, 0));
    return d;
  }();
  testing::TestFleet fleet;
  fp_host host{};
  std::int64_t now_ns = 0;
  std::uint32_t told_all = 0;
  fp_briefing briefing = fleet.briefing(0, 0);
  Facts facts{briefing};
  MapView map{facts.shared()};
  HullGeometry geometry{map, briefing};
  Neighbours neighbours{map, geometry, briefing, {.zones_from = 2}};
  Controller controller{host, reinterpret_cast<fp_controller*>(this)};
  LockProtocol protocol{map, geometry, neighbours, controller, {}};
};

TEST(StateToAll, GoesOutEveryThreeSecondsAndSeldomerInLargerFleets) {
  EXPECT_EQ(Teller(4).told_all_in(60.0), 20U);
  EXPECT_EQ(Teller(15).told_all_in(60.0), 20U);
  EXPECT_EQ(Teller(40).told_all_in(64.0), 8U) << "a fifth of a second for each AGV";
}

TEST(StateToAll, DoesNotGoOutIfItHasNoRoomForWhatAllHaveSaid) {
  EXPECT_GT(Teller(HeardFrom::kMax).told_all_in(60.0), 0U);
  EXPECT_EQ(Teller(HeardFrom::kMax + 1).told_all_in(60.0), 0U);
}

}  // namespace
}  // namespace fleetproof::agents::state_to_all_test
