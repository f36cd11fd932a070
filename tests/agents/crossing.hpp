#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "core/agents/lock_protocol.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::testing {

// Two or three AGVs around one crossing, and a radio that delivers what the test says when the test says so.
class Crossing : public ::testing::Test {
 protected:
  struct Sent {
    std::uint32_t from, to;
    Message message;
    std::vector<std::byte> bytes;
  };
  struct Member {
    Crossing* test;
    std::uint32_t id;
    std::unique_ptr<Neighbours> neighbours;
    std::unique_ptr<Controller> controller;
    std::unique_ptr<LockProtocol> protocol;
  };

  Crossing() {
    for (const auto& [x, y] : {std::pair(0, 0), {6, 0}, {-6, 0}, {0, 6}, {0, -6}}) drawn.station(x, y);
    for (std::uint32_t arm = 1; arm < 5; ++arm) drawn.segment(0, arm);
    drawn.map();
    host.now_ns = [](fp_controller* c) { return member(c).test->now_ns; };
    host.get_position = [](fp_controller*, fp_pose*) -> std::int32_t { return FP_REFUSED; };
    host.random = [](fp_controller*, std::uint32_t, std::uint64_t) -> std::uint64_t { return std::uint64_t{1} << 63; };
    host.waiting_for = [](fp_controller*, std::uint32_t) -> std::int32_t { return FP_OK; };
    host.sometimes = [](fp_controller*, const char*) -> std::int32_t { return FP_OK; };
    host.send_unicast = [](fp_controller* c, const void* bytes, std::uint32_t size, std::uint32_t to) -> std::int32_t {
      const std::span span(static_cast<const std::byte*>(bytes), size);
      member(c).test->sent.push_back({member(c).id, to, *decode(span), {span.begin(), span.end()}});
      return FP_OK;
    };
    host.send_broadcast = [](fp_controller* c, const void* bytes, std::uint32_t size) -> std::int32_t {
      const Member& self = member(c);
      for (std::uint32_t to = 0; to < self.test->members.size(); ++to) {
        if (to != self.id) self.test->host.send_unicast(c, bytes, size, to);
      }
      return FP_OK;
    };
  }

  static Member& member(fp_controller* c) { return *reinterpret_cast<Member*>(c); }

  // A new self where the former one stands, holding what the AGV still covers.
  void restart(std::uint32_t id, std::uint32_t boot) {
    Member& m = *members[id];
    Path standing = m.protocol->held();
    if (standing.count > 1) standing.count = 1;
    m.neighbours = std::make_unique<Neighbours>(*map, *geometry, fleet->briefing(id, id + 1));
    m.protocol = std::make_unique<LockProtocol>(*map, *geometry, *m.neighbours, *m.controller, LockOptions{}, boot);
    m.protocol->stand(standing);
    m.protocol->describe(true, false, false);
  }

  void fleet_of(std::uint32_t count, LockOptions options = {}) {
    fleet = std::make_unique<TestFleet>(drawn.map(), count);
    map = std::make_unique<MapView>(drawn.map());
    geometry = std::make_unique<HullGeometry>(*map, fleet->briefing(0, 1));
    for (std::uint32_t id = 0; id < count; ++id) {
      auto m = std::make_unique<Member>();
      m->test = this;
      m->id = id;
      m->neighbours = std::make_unique<Neighbours>(*map, *geometry, fleet->briefing(id, id + 1));
      m->controller = std::make_unique<Controller>(host, reinterpret_cast<fp_controller*>(m.get()));
      m->protocol = std::make_unique<LockProtocol>(*map, *geometry, *m->neighbours, *m->controller, options);
      Path standing;
      standing.station = id + 1;
      m->protocol->stand(standing);
      m->protocol->describe(true, false, false);
      members.push_back(std::move(m));
    }
  }

  // From its own arm across the crossing to the other.
  void want(std::uint32_t id, std::uint32_t to, std::int64_t demand_ns) {
    Path p = members[id]->protocol->held();
    p.append(drawn.lane_between(p.station, 0));
    p.append(drawn.lane_between(0, to));
    members[id]->protocol->request(p, demand_ns);
  }
  // Whether a message is under way that asks this AGV.
  bool is_asked(std::uint32_t id) const {
    return std::ranges::any_of(sent, [&](const Sent& s) {
      return s.to == id && s.message.has_request() && s.message.asked.of(id) != nullptr;
    });
  }
  bool settle(std::uint32_t id) { return members[id]->protocol->settle(); }
  // The oldest undelivered message of this kind from one to the other; it stays in the air if `keep`.
  bool deliver(MessageKind kind, std::uint32_t from, std::uint32_t to, bool keep = false) {
    for (auto s = sent.begin(); s != sent.end(); ++s) {
      if (s->from != from || s->to != to || s->message.kind != kind) continue;
      const std::vector<std::byte> bytes = s->bytes;
      if (!keep) sent.erase(s);
      members[to]->protocol->receive(from, bytes);
      return true;
    }
    return false;
  }

  DrawnMap drawn;
  fp_host host{};
  std::int64_t now_ns = 0;
  std::unique_ptr<TestFleet> fleet;
  std::unique_ptr<MapView> map;
  std::unique_ptr<HullGeometry> geometry;
  std::vector<std::unique_ptr<Member>> members;
  std::deque<Sent> sent;
};

}  // namespace fleetproof::agents::testing
