#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <queue>
#include <random>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "core/sdk/fleetproof/agent.h"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/fake_agv.hpp"
#include "tests/agents/rectangles.hpp"

namespace fleetproof::agents::testing {

// The part of a warehouse that agents need: AGVs that turn and drive at the right times, transfers, timers, and a bad
// radio.
class FakeWarehouse {
 public:
  FakeWarehouse(const DrawnMap& drawn, const TestFleet& fleet, std::vector<std::uint32_t> starts,
                const fp_agent_type& type, FakeRadio radio, std::uint64_t seed)
      : drawn_(drawn), fleet_(fleet), type_(type), radio_(radio), draws_(seed), seed_(seed), host_(make_host()) {
    for (std::uint32_t id = 0; id < starts.size(); ++id) {
      auto agv = std::make_unique<FakeAgv>();
      agv->handle = {this, id};
      agv->station = starts[id];
      const fp_station& s = fleet.map.stations[starts[id]];
      agv->pose = {s.x_m, s.y_m, 1.0, 0.0};
      agv->briefing = fleet.briefing(id, starts[id]);
      agvs_.push_back(std::move(agv));
    }
  }
  ~FakeWarehouse() {
    for (auto& agv : agvs_) type_.destroy(agv->agent);
  }
  FakeWarehouse(const FakeWarehouse&) = delete;
  FakeWarehouse& operator=(const FakeWarehouse&) = delete;

  void heading(std::uint32_t agv, double x, double y) {
    agvs_[agv]->pose.heading_x = x, agvs_[agv]->pose.heading_y = y;
  }
  void late_heading(std::uint32_t id, LateHeading late) { agvs_[id]->late = late; }
  void script(std::uint32_t agv, std::span<const fp_scripted_call> calls) {
    agvs_[agv]->briefing.script = calls.data();
    agvs_[agv]->briefing.script_count = static_cast<std::uint32_t>(calls.size());
  }
  void order(std::uint32_t agv, double at_s, std::uint32_t from, std::uint32_t to) {
    at(seconds(at_s), [this, agv, from, to] {
      agvs_[agv]->orders.push_back({orders_++, from, to});
      tell_order(agv, agvs_[agv]->orders.back());
    });
  }
  // The agent's computer goes down, and comes up again without memory; the AGV finishes what it is doing.
  void restart(std::uint32_t id, double at_s, double away_s) {
    at(seconds(at_s), [this, id] {
      FakeAgv& agv = *agvs_[id];
      type_.destroy(agv.agent);
      agv.agent = nullptr;
      agv.timers.clear();
      agv.inbox.clear();
    });
    at(seconds(at_s + away_s), [this, id] {
      FakeAgv& agv = *agvs_[id];
      ++agv.briefing.boot;
      agv.briefing.start_station = agv.station;
      agv.briefing.start_segment = agv.lane != nullptr ? agv.lane->segment : FP_NONE;
      agv.briefing.next_segment = agv.next != nullptr ? agv.next->segment : FP_NONE;
      agv.agent = type_.create(&host_, reinterpret_cast<fp_controller*>(&agv.handle), &agv.briefing);
      tell(id, fp_event{});
      std::deque<FakeOrder> orders = agv.orders;
      std::stable_partition(orders.begin(), orders.end(),
                            [&](const FakeOrder& o) { return agv.loaded && o.id == agv.carried; });
      for (const FakeOrder& order : orders) tell_order(id, order);
    });
  }

  // To that instant, or until a little after this number of loads has been dropped.
  void run(double until_s, std::uint32_t enough_drops = ~0U) {
    for (std::uint32_t id = 0; id < agvs_.size(); ++id) {
      at(0, [this, id] {
        agvs_[id]->agent =
            type_.create(&host_, reinterpret_cast<fp_controller*>(&agvs_[id]->handle), &agvs_[id]->briefing);
        tell(id, fp_event{});
      });
    }
    at(0, [this] { look(); });
    while (!queue_.empty() &&
           queue_.top().at_ns <= seconds(std::min(until_s, drops_ < enough_drops ? until_s : last_drop_s_ + 5.0))) {
      const Event event = queue_.top();
      queue_.pop();
      now_ns_ = event.at_ns;
      event.what();
    }
  }

  // Called after every activation.
  std::function<void(std::uint32_t agv)> after_activation;
  void* agent(std::uint32_t id) { return agvs_[id]->agent; }
  std::size_t fleet_size() const { return agvs_.size(); }
  std::uint32_t drops() const { return drops_; }
  double last_drop_s() const { return last_drop_s_; }
  std::uint32_t misplaced() const { return misplaced_; }  // drops elsewhere than ordered
  std::uint32_t boot_of(std::uint32_t id) const { return agvs_[id]->briefing.boot; }
  std::uint32_t station_of(std::uint32_t id) const { return agvs_[id]->station; }
  const fp_lane* lane_of(std::uint32_t id) const { return agvs_[id]->lane; }  // under way; null: the AGV stands
  const fp_lane* next_of(std::uint32_t id) const { return agvs_[id]->next; }  // given to follow it; null: none
  // A battery that keeps its level, and gains 2 % per second at a charger.
  void battery(std::uint32_t id, double level) { agvs_[id]->battery = level; }
  double battery_of(std::uint32_t id) const {
    const FakeAgv& agv = *agvs_[id];
    const double charged_s =
        agv.doing == FP_CHARGING_NOW && !agv.busy ? static_cast<double>(now_ns_ - agv.charging_since_ns) * 1e-9 : 0.0;
    return std::min(1.0, agv.battery + 0.02 * charged_s);
  }
  double least_clearance_m() const { return least_clearance_m_; }
  const std::multiset<std::string>& probes() const { return probes_; }
  const std::vector<std::pair<double, std::uint32_t>>& calls() const { return calls_; }  // instant and fp_call
  void stop_motion_of(std::uint32_t id) { agvs_[id]->stopped = true; }

 private:
  struct Event {
    std::int64_t at_ns;
    std::uint64_t order;
    std::function<void()> what;
    friend bool operator<(const Event& a, const Event& b) {
      return std::tie(a.at_ns, a.order) > std::tie(b.at_ns, b.order);
    }
  };

  static std::int64_t seconds(double s) { return static_cast<std::int64_t>(s * 1e9); }
  static FakeHandle& handle(fp_controller* controller) { return *reinterpret_cast<FakeHandle*>(controller); }
  void at(std::int64_t at_ns, std::function<void()> what) { queue_.push({at_ns, ++events_, std::move(what)}); }
  double draw() { return std::uniform_real_distribution<double>()(draws_); }

  void tell_order(std::uint32_t agv, const FakeOrder& order) {
    fp_event event{};
    event.kind = FP_EVENT_ORDER;
    event.order_id = order.id;
    event.from = order.from;
    event.to = order.to;
    tell(agv, event);
  }

  void tell(std::uint32_t id, fp_event event) {
    if (agvs_[id]->agent == nullptr) return;  // away
    event.struct_size = sizeof(fp_event);
    event.now_ns = now_ns_;
    type_.on_event(agvs_[id]->agent, &event);
    if (after_activation) after_activation(id);
  }

  fp_pose pose_of(const FakeAgv& agv) const {
    if (agv.lane == nullptr) return agv.pose;
    if (now_ns_ < agv.drive_begins_ns) {  // turning: headings in between, the shorter way
      const double share = static_cast<double>(now_ns_ - agv.turn_begins_ns) /
                           static_cast<double>(agv.drive_begins_ns - agv.turn_begins_ns);
      const fp_pose target = on_lane(*agv.lane, 0.0);
      const double from = std::atan2(agv.pose.heading_y, agv.pose.heading_x);
      const double by = std::remainder(std::atan2(target.heading_y, target.heading_x) - from, 2 * M_PI);
      return {agv.pose.x_m, agv.pose.y_m, std::cos(from + share * by), std::sin(from + share * by)};
    }
    const double share = static_cast<double>(now_ns_ - agv.drive_begins_ns) /
                         static_cast<double>(agv.drive_ends_ns - agv.drive_begins_ns);
    return on_lane(*agv.lane, share * agv.lane->length_m);
  }

  void look() {
    std::vector<std::array<Point, 4>> bodies;
    for (const auto& agv : agvs_) bodies.push_back(corners(pose_of(*agv), kTestAgv.length_m, kTestAgv.width_m));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t k = i + 1; k < bodies.size(); ++k)
        least_clearance_m_ = std::min(least_clearance_m_, clearance_m(bodies[i], bodies[k]));
    }
    at(now_ns_ + seconds(0.1), [this] { look(); });
  }

  const fp_lane* lane_from(std::uint32_t station, std::uint32_t segment) const {
    for (std::uint32_t i = 0; i < fleet_.map.lane_count; ++i) {
      const fp_lane& l = drawn_.lane_at(i);
      if (l.segment == segment && l.from == station) return &l;
    }
    return nullptr;
  }

  // `named`: the order whose load a pick takes; FP_NONE: the oldest order.
  std::int32_t act(std::uint32_t id, fp_call call, std::uint32_t segment, std::uint32_t named = FP_NONE) {
    calls_.emplace_back(static_cast<double>(now_ns_) * 1e-9, call);
    FakeAgv& agv = *agvs_[id];
    if (call == FP_CALL_MOVE && agv.lane != nullptr && agv.next == nullptr && !agv.stopped)
      return (agv.next = lane_from(agv.lane->to, segment)) != nullptr ? FP_OK : FP_REFUSED;
    if (agv.busy || agv.stopped) return FP_REFUSED;
    const fp_lane* lane = lane_from(agv.station, segment);
    if (lane == nullptr && (segment != FP_HERE || call == FP_CALL_MOVE)) return FP_REFUSED;
    const std::uint32_t ends_at = lane != nullptr ? lane->to : agv.station;
    if (named != FP_NONE && (agv.loaded || std::ranges::none_of(agv.orders, [&](const FakeOrder& order) {
                               return order.id == named && order.from == ends_at;
                             })))
      return FP_REFUSED;
    agv.battery = battery_of(id);
    agv.busy = true;
    agv.doing = call == FP_CALL_PICK     ? FP_PICKING
                : call == FP_CALL_DROP   ? FP_DROPPING
                : call == FP_CALL_CHARGE ? FP_CHARGING_NOW
                                         : FP_DRIVING;
    std::int64_t ends_ns = now_ns_;
    if (lane != nullptr) {
      const fp_pose start = on_lane(*lane, 0.0);
      const double turn =
          std::acos(std::clamp(start.heading_x * agv.pose.heading_x + start.heading_y * agv.pose.heading_y, -1.0, 1.0));
      agv.turn_begins_ns = now_ns_;
      agv.drive_begins_ns = now_ns_ + seconds(turn < 1e-6 ? 0.0 : turn + 1.0);
      agv.drive_ends_ns = agv.drive_begins_ns +
                          seconds(lane->length_m < 6.0 ? std::sqrt(6.0 * lane->length_m) : 3.0 + lane->length_m / 2.0);
      agv.lane = lane;
      ends_ns = agv.drive_ends_ns;
    }
    if (call == FP_CALL_PICK || call == FP_CALL_DROP) ends_ns += seconds(5.0);
    at(ends_ns, [this, id, call, named] { done(id, call, named); });
    return FP_OK;
  }

  void done(std::uint32_t id, fp_call call, std::uint32_t named) {
    FakeAgv& agv = *agvs_[id];
    fp_event event{};
    event.kind = FP_EVENT_ACTION_DONE;
    if (agv.stopped) {
      event.result = FP_REFUSED;
    } else if (agv.lane != nullptr) {
      agv.pose = on_lane(*agv.lane, agv.lane->length_m);
      agv.station = agv.lane->to;
      agv.lane = nullptr;
    }
    agv.busy = false;
    if (call != FP_CALL_CHARGE) agv.doing = FP_IDLE;
    if (call == FP_CALL_DROP && agv.loaded) {
      ++drops_, last_drop_s_ = static_cast<double>(now_ns_) * 1e-9;
      const auto order = std::ranges::find(agv.orders, agv.carried, &FakeOrder::id);
      misplaced_ += order == agv.orders.end() || order->to != agv.station;
      if (order != agv.orders.end()) agv.orders.erase(order);
    }
    // An AGV that picks at a place without a load of its own has no load afterwards, unless it had one before.
    if (call == FP_CALL_PICK && !agv.loaded && !agv.orders.empty()) {
      const auto order = named == FP_NONE ? agv.orders.begin() : std::ranges::find(agv.orders, named, &FakeOrder::id);
      agv.loaded = order != agv.orders.end() && order->from == agv.station;
      if (agv.loaded) agv.carried = order->id;
    }
    if (call == FP_CALL_DROP) agv.loaded = false;
    if (call == FP_CALL_CHARGE) agv.charging_since_ns = now_ns_;
    const fp_lane* next = agv.next;
    agv.next = nullptr;
    if (next != nullptr && !agv.stopped) act(id, FP_CALL_MOVE, next->segment);
    tell(id, event);
  }

  void send(std::uint32_t sender, std::uint32_t receiver, const std::string& bytes) {
    for (int copy = 0; copy < 2; ++copy) {
      const double delay_s = radio_.uniform ? draw() * radio_.delay_s : radio_.delay_s;
      const bool lost = draw() < radio_.loss || (copy == 1 && draw() >= radio_.duplicates);
      if (lost) continue;
      at(now_ns_ + seconds(std::max(delay_s, 0.001)), [this, sender, receiver, bytes] {
        if (agvs_[receiver]->agent == nullptr) return;
        agvs_[receiver]->inbox.push_back({sender, bytes});
        fp_event event{};
        event.kind = FP_EVENT_MESSAGE;
        tell(receiver, event);
      });
    }
  }

  void set_timer(std::uint32_t id, std::uint32_t number, std::int64_t at_ns) {
    FakeAgv& agv = *agvs_[id];
    auto timer = std::find_if(agv.timers.begin(), agv.timers.end(), [&](const auto& t) { return t.first == number; });
    if (timer == agv.timers.end()) timer = agv.timers.insert(timer, {number, 0});
    const std::uint64_t stamp = timer->second = ++stamps_;
    if (at_ns < 0) return;
    at(std::max(at_ns, now_ns_), [this, id, number, stamp] {
      for (const auto& [n, s] : agvs_[id]->timers) {
        if (n != number || s != stamp) continue;
        fp_event event{};
        event.kind = FP_EVENT_TIMER;
        event.timer = number;
        return tell(id, event);
      }
    });
  }

  static fp_host make_host();
  static void add_later_calls(fp_host& host);

  const DrawnMap& drawn_;
  const TestFleet& fleet_;
  const fp_agent_type& type_;
  FakeRadio radio_;
  std::mt19937_64 draws_;
  std::uint64_t seed_;
  fp_host host_;
  std::vector<std::unique_ptr<FakeAgv>> agvs_;
  std::priority_queue<Event> queue_;
  std::int64_t now_ns_ = 0;
  std::uint64_t events_ = 0, stamps_ = 0;
  std::uint32_t drops_ = 0, misplaced_ = 0, orders_ = 0;
  double last_drop_s_ = 0.0, least_clearance_m_ = 1e9;
  std::multiset<std::string> probes_;
  std::vector<std::pair<double, std::uint32_t>> calls_;
};

inline void FakeWarehouse::add_later_calls(fp_host& host) {
  host.pick_load = [](fp_controller* c, std::uint32_t s, std::uint32_t order) {
    return handle(c).warehouse->act(handle(c).id, FP_CALL_PICK, s, order);
  };
  host.get_load = [](fp_controller* c, std::uint32_t* order) -> std::int32_t {
    const FakeAgv& agv = *handle(c).warehouse->agvs_[handle(c).id];
    *order = agv.loaded ? agv.carried : FP_NONE;
    return FP_OK;
  };
  host.describe = [](fp_controller*, const char*) {};
  host.describe_message = [](fp_controller*, const fp_message_fields*) {};
  host.declare_state = [](fp_controller*, const char*) {};
  host.believe = [](fp_controller*, std::uint32_t, const fp_pose*, std::int64_t) {};
  host.cannot_start = [](fp_controller*, const char*) -> std::int32_t { return FP_OK; };
}

inline fp_host FakeWarehouse::make_host() {
  fp_host host{};
  host.struct_size = sizeof(fp_host);
  host.abi_major = FP_ABI_MAJOR;
  host.abi_minor = FP_ABI_MINOR;
  host.move = [](fp_controller* c, std::uint32_t s) { return handle(c).warehouse->act(handle(c).id, FP_CALL_MOVE, s); };
  host.pick = [](fp_controller* c, std::uint32_t s) { return handle(c).warehouse->act(handle(c).id, FP_CALL_PICK, s); };
  host.drop = [](fp_controller* c, std::uint32_t s) { return handle(c).warehouse->act(handle(c).id, FP_CALL_DROP, s); };
  host.park = [](fp_controller* c, std::uint32_t s) { return handle(c).warehouse->act(handle(c).id, FP_CALL_PARK, s); };
  host.charge = [](fp_controller* c, std::uint32_t s) {
    return handle(c).warehouse->act(handle(c).id, FP_CALL_CHARGE, s);
  };
  host.send_broadcast = [](fp_controller* c, const void* bytes, std::uint32_t size) -> std::int32_t {
    FakeWarehouse& w = *handle(c).warehouse;
    for (std::uint32_t i = 0; i < w.agvs_.size(); ++i) {
      if (i != handle(c).id) w.send(handle(c).id, i, {static_cast<const char*>(bytes), size});
    }
    return FP_OK;
  };
  host.send_unicast = [](fp_controller* c, const void* bytes, std::uint32_t size,
                         std::uint32_t receiver) -> std::int32_t {
    handle(c).warehouse->send(handle(c).id, receiver, {static_cast<const char*>(bytes), size});
    return FP_OK;
  };
  host.get_position = [](fp_controller* c, fp_pose* out) -> std::int32_t {
    const FakeAgv& agv = *handle(c).warehouse->agvs_[handle(c).id];
    *out = agv.perceived(handle(c).warehouse->pose_of(agv), handle(c).warehouse->now_ns_);
    return FP_OK;
  };
  host.get_message = [](fp_controller* c, fp_message* out) -> std::int32_t {
    FakeAgv& agv = *handle(c).warehouse->agvs_[handle(c).id];
    if (agv.inbox.empty()) return FP_EMPTY;
    agv.in_hand = std::move(agv.inbox.front());
    agv.inbox.pop_front();
    out->sender = agv.in_hand.sender;
    out->size = static_cast<std::uint32_t>(agv.in_hand.bytes.size());
    out->bytes = agv.in_hand.bytes.data();
    return FP_OK;
  };
  host.get_action = [](fp_controller* c, std::uint32_t* out) -> std::int32_t {
    const FakeAgv& agv = *handle(c).warehouse->agvs_[handle(c).id];
    *out = agv.stopped ? static_cast<std::uint32_t>(FP_OUT_OF_ORDER) : agv.doing;
    return FP_OK;
  };
  host.is_loaded = [](fp_controller* c, std::uint32_t* out) -> std::int32_t {
    *out = handle(c).warehouse->agvs_[handle(c).id]->loaded ? 1 : 0;
    return FP_OK;
  };
  host.get_battery_level = [](fp_controller* c, double* out) -> std::int32_t {
    *out = handle(c).warehouse->battery_of(handle(c).id);
    return FP_OK;
  };
  host.now_ns = [](fp_controller* c) { return handle(c).warehouse->now_ns_; };
  host.set_timer = [](fp_controller* c, std::uint32_t timer, std::int64_t at_ns) -> std::int32_t {
    handle(c).warehouse->set_timer(handle(c).id, timer, at_ns);
    return FP_OK;
  };
  host.random = [](fp_controller* c, std::uint32_t purpose, std::uint64_t index) -> std::uint64_t {
    return std::mt19937_64(handle(c).warehouse->seed_ * 1'000'003 + handle(c).id * 1009 + purpose * 101 + index)();
  };
  host.waiting_for = [](fp_controller*, std::uint32_t) -> std::int32_t { return FP_OK; };
  host.sometimes = [](fp_controller* c, const char* probe) -> std::int32_t {
    handle(c).warehouse->probes_.insert(probe);
    return FP_OK;
  };
  add_later_calls(host);
  return host;
}

}  // namespace fleetproof::agents::testing
