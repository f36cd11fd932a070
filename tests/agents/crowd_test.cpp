#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "core/agents/lock_protocol.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::crowd_test {
namespace {

constexpr std::uint32_t kAgvs = 14;

struct Star {
  Star() {
    drawn.station(0, 0);
    for (std::uint32_t arm = 1; arm <= kAgvs; ++arm) {
      const double angle = 2.0 * M_PI * arm / kAgvs;
      drawn.station(10.0 * std::cos(angle), 10.0 * std::sin(angle));
      drawn.segment(0, arm);
    }
  }
  testing::DrawnMap drawn;
};

// AGVs on the arms of a star that all want the station in the middle, and a radio without loss and delay.
class Crowd : public ::testing::Test {
 protected:
  struct Member {
    Crowd* test = nullptr;
    std::uint32_t id = 0;
    std::unique_ptr<Neighbours> neighbours;
    std::unique_ptr<Controller> controller;
    std::unique_ptr<LockProtocol> protocol;
  };
  struct Sent {
    std::uint32_t from = 0, to = 0;
    std::vector<std::byte> bytes;
  };

  Crowd() {
    host.now_ns = [](fp_controller* c) { return member(c).test->now_ns; };
    host.get_position = [](fp_controller*, fp_pose*) -> std::int32_t { return FP_REFUSED; };
    host.random = [](fp_controller*, std::uint32_t, std::uint64_t) -> std::uint64_t { return std::uint64_t{1} << 63; };
    host.waiting_for = [](fp_controller*, std::uint32_t) -> std::int32_t { return FP_OK; };
    host.sometimes = [](fp_controller*, const char*) -> std::int32_t { return FP_OK; };
    host.send_unicast = [](fp_controller* c, const void* bytes, std::uint32_t size, std::uint32_t to) -> std::int32_t {
      const auto* first = static_cast<const std::byte*>(bytes);
      member(c).test->air.push_back({member(c).id, to, {first, first + size}});
      return FP_OK;
    };
    host.send_broadcast = [](fp_controller* c, const void* bytes, std::uint32_t size) -> std::int32_t {
      for (std::uint32_t to = 0; to < kAgvs; ++to) {
        if (to != member(c).id) member(c).test->host.send_unicast(c, bytes, size, to);
      }
      return FP_OK;
    };
    members.resize(kAgvs);
    for (std::uint32_t id = 0; id < kAgvs; ++id) join(id);
  }

  void join(std::uint32_t id) {
    Member& m = members[id];
    m.test = this;
    m.id = id;
    m.neighbours = std::make_unique<Neighbours>(map, geometry, fleet.briefing(id, id + 1));
    m.controller = std::make_unique<Controller>(host, reinterpret_cast<fp_controller*>(&m));
    m.protocol = std::make_unique<LockProtocol>(map, geometry, *m.neighbours, *m.controller, LockOptions{});
    Path standing;
    standing.station = id + 1;
    m.protocol->stand(standing);
    m.protocol->describe(true, false, false);
  }

  static Member& member(fp_controller* c) { return *reinterpret_cast<Member*>(c); }

  // Everything that happens at this instant; the number of messages.
  std::size_t settle_all(std::size_t at_most) {
    std::size_t delivered = 0;
    for (Member& m : members) m.protocol->settle();
    for (; !air.empty() && delivered < at_most; ++delivered) {
      const Sent sent = std::move(air.front());
      air.pop_front();
      members[sent.to].protocol->receive(sent.from, sent.bytes);
      members[sent.to].protocol->settle();
    }
    return delivered;
  }

  Star star;
  testing::TestFleet fleet{star.drawn.map(), kAgvs};
  MapView map{fleet.map};
  HullGeometry geometry{map, fleet.briefing(0, 1)};
  fp_host host{};
  std::int64_t now_ns = 0;
  std::vector<Member> members;
  std::deque<Sent> air;
};

// An AGV that lets an older demand pass steps back and asks again, and with that makes all younger demands step back.
TEST_F(Crowd, SteppingBackDoesNotMultiply) {
  for (std::uint32_t id = kAgvs; id-- > 0;) {  // the youngest demand asks first
    Path to_the_middle = members[id].protocol->held();
    to_the_middle.append(star.drawn.lane_between(id + 1, 0));
    members[id].protocol->request(to_the_middle, id);
    EXPECT_LT(settle_all(10'000), 20 * kAgvs) << "AGV " << id;
  }
  std::size_t locked = 0;
  for (const Member& m : members) locked += m.protocol->held().count;
  EXPECT_LE(locked, 1U);
}

}  // namespace
}  // namespace fleetproof::agents::crowd_test
