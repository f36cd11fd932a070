// A vehicle that carries its own orders, written as straight-line code. It asks all others before it drives to a
// station, and answers "no" for its own station and for the one to which it drives.
// FAULT: it takes two seconds of silence for consent. A lost or late "no" is silence, too.
#include <vector>

#include "fleetproof/blocking.hpp"

using namespace std::chrono_literals;
using namespace fleetproof::blocking;

struct Said {
  uint32_t is_no, station;  // "may I drive there?", or "no"
};

class Carrier {
 public:
  explicit Carrier(Controller& agv) : agv_(agv), map_(*agv.briefing().map), here_(agv.briefing().start_station) {}

  void run() {
    if (agv_.briefing().boot > 0) find_out_where();
    while (true) {
      const Event event = agv_.wait(kOrder | kMessage);
      if (event.kind == kMessage) hear(event.message);
      if (event.kind == kOrder) carry(event.order());
    }
  }

 private:
  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(&map_, number); }

  // The former boot may have driven on from the start station.
  void find_out_where() {
    const uint32_t segment = agv_.briefing().start_segment & ~FP_BACKWARD;
    for (uint32_t i = 0; i < map_.lane_count && agv_.briefing().start_segment != FP_NONE; ++i) {
      if (lane(i).segment == segment && lane(i).from == agv_.briefing().start_station) here_ = lane(i).to;
    }
    agv_.wait_until_rest();
  }

  void carry(const Order& order) {
    const bool is_on_board = agv_.order_on_board() == order.id;
    if (!is_on_board && (!drive_to(order.from) || agv_.pick_load(FP_HERE, order.id) != FP_OK)) return;
    if (drive_to(order.to)) agv_.drop(FP_HERE);
  }

  // By the fewest lanes, searched from the end.
  bool drive_to(uint32_t goal) {
    std::vector<uint32_t> next(map_.station_count, FP_NONE), reached{goal};
    for (size_t k = 0; k < reached.size(); ++k) {
      for (uint32_t i = 0; i < map_.lane_count; ++i) {
        const uint32_t from = lane(i).from;
        if (lane(i).to != reached[k] || from == goal || next[from] != FP_NONE) continue;
        next[from] = i;
        reached.push_back(from);
      }
    }
    while (here_ != goal) {
      if (next[here_] == FP_NONE || !drive(lane(next[here_]))) return false;
    }
    return true;
  }

  bool drive(const fp_lane& next) {
    goal_ = next.to;
    while (!everybody_is_silent()) listen(1s + Duration(random() % 1'000'000'000));
    if (agv_.begin(FP_CALL_MOVE, next.segment | (next.backward != 0 ? FP_BACKWARD : 0)) != FP_OK) return false;
    Event event = agv_.wait(kMessage | kDone);
    for (; event.kind == kMessage; event = agv_.wait(kMessage | kDone)) hear(event.message);
    if (event.told.result == FP_OK) here_ = goal_;
    return event.told.result == FP_OK;
  }
  bool everybody_is_silent() {
    heard_no_ = false;
    agv_.broadcast(Said{0, goal_});
    listen(2s);
    return !heard_no_;
  }
  void listen(Duration duration) {
    const Duration until = agv_.now() + duration;
    while (const auto message = agv_.wait_message(until - agv_.now())) hear(*message);
  }
  void hear(const Message& message) {
    const auto said = message.as<Said>();
    if (!said) return;
    if (said->is_no == 1 && said->station == goal_) heard_no_ = true;
    if (said->is_no == 0 && (said->station == here_ || said->station == goal_))
      agv_.send(Said{1, said->station}, message.sender);
  }
  uint64_t random() { return agv_.call(&fp_host::random, 0u, uint64_t(agv_.now().count())); }
  Controller& agv_;
  const fp_map& map_;
  uint32_t here_, goal_ = FP_NONE;  // where it stands, and to where it drives
  bool heard_no_ = false;
};

static void run_carrier(Controller& agv) { Carrier(agv).run(); }
extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type kCarrier = agent_type<run_carrier>("carrier", "takes silence for consent");
  return &kCarrier;
}
