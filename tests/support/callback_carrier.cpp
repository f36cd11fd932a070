// What tests/examples/carrier.cpp does, written with callbacks: for tests that compare both, and their costs.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000, kNoTime = -1;

struct Said {
  enum What : std::uint32_t { kMayI, kNo } what;
  std::uint32_t station;
};

class CallbackCarrier {
 public:
  CallbackCarrier(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : host_(host), handle_(handle), briefing_(briefing), map_(*briefing.map), here_(briefing.start_station) {}

  void on_event(const fp_event& event) {
    now_ns_ = event.now_ns;
    bool is_time_up = false;
    if (event.kind == FP_EVENT_TIMER) {
      timer_ns_ = kNoTime;
      is_time_up = deadline_ns_ != kNoTime && now_ns_ >= deadline_ns_;
    } else if (event.kind == FP_EVENT_START) {
      start();
    } else if (event.kind != FP_EVENT_MESSAGE || !has_kept(FP_EVENT_MESSAGE)) {
      kept_.push_back(event);
    }
    while (react(std::exchange(is_time_up, false))) {
    }
  }

 private:
  enum class Phase { kRests, kIsIdle, kAsks, kBacksOff, kDrives, kPicks, kDrops };

  const fp_lane& lane(std::uint32_t number) const { return *fp_lane_at(&map_, number); }

  void start() {
    if (briefing_.boot == 0) return;
    const std::uint32_t segment = briefing_.start_segment & ~FP_BACKWARD;
    for (std::uint32_t i = 0; i < map_.lane_count && briefing_.start_segment != FP_NONE; ++i) {
      if (lane(i).segment == segment && lane(i).from == briefing_.start_station) here_ = lane(i).to;
    }
    phase_ = Phase::kRests;
    look_whether_it_rests();
  }

  // One reaction to what is kept or to the timer. False: nothing is left to do in this activation.
  bool react(bool is_time_up) {
    switch (phase_) {
      case Phase::kRests:
        if (!take(FP_EVENT_ACTION_DONE) && !is_time_up) return false;
        look_whether_it_rests();
        return true;
      case Phase::kIsIdle:
        if (kept_first(FP_EVENT_ORDER, FP_EVENT_MESSAGE) == FP_EVENT_MESSAGE) return read_or_forget();
        if (const auto order = take(FP_EVENT_ORDER)) {
          begin_to_carry(*order);
          return true;
        }
        return false;
      case Phase::kAsks:
      case Phase::kBacksOff:
        if (has_kept(FP_EVENT_MESSAGE) && read()) {
          go_on_listening();
          return true;
        }
        if (!is_time_up) return false;
        phase_ == Phase::kBacksOff ? ask() : heard_no_ ? back_off() : drive();
        return true;
      case Phase::kDrives:
        if (kept_first(FP_EVENT_MESSAGE, FP_EVENT_ACTION_DONE) == FP_EVENT_MESSAGE) return read_or_forget();
        if (const auto done = take(FP_EVENT_ACTION_DONE)) {
          if (done->result == FP_OK) here_ = goal_;
          done->result == FP_OK ? go_on() : become_idle();
          return true;
        }
        return false;
      case Phase::kPicks:
      case Phase::kDrops:
        if (const auto done = take(FP_EVENT_ACTION_DONE)) {
          if (phase_ == Phase::kDrops || done->result != FP_OK) {
            become_idle();
          } else {
            head_for(order_.to);
          }
          return true;
        }
        return false;
    }
    return false;
  }

  void look_whether_it_rests() {
    std::uint32_t action = FP_STOPPED;
    host_.get_action(handle_, &action);
    if (action == FP_IDLE || action == FP_PARKED || action == FP_CHARGING_NOW) {
      forget_done();
      become_idle();
    } else {
      set_timer(now_ns_ + kSecond_ns);
    }
  }
  void become_idle() {
    phase_ = Phase::kIsIdle;
    deadline_ns_ = kNoTime;
  }

  void begin_to_carry(const fp_event& order) {
    order_ = order;
    std::uint32_t on_board = FP_NONE;
    host_.get_load(handle_, &on_board);
    is_fetching_ = on_board != order.order_id;
    head_for(is_fetching_ ? order.from : order.to);
  }
  void head_for(std::uint32_t goal) {
    is_fetching_ = is_fetching_ && goal == order_.from;
    destination_ = goal;
    next_.assign(map_.station_count, FP_NONE);
    std::vector<std::uint32_t> reached{goal};
    for (std::size_t k = 0; k < reached.size(); ++k) {
      for (std::uint32_t i = 0; i < map_.lane_count; ++i) {
        const std::uint32_t from = lane(i).from;
        if (lane(i).to != reached[k] || from == goal || next_[from] != FP_NONE) continue;
        next_[from] = i;
        reached.push_back(from);
      }
    }
    go_on();
  }
  void go_on() {
    if (here_ == destination_) return transfer();
    if (next_[here_] == FP_NONE) return become_idle();
    goal_ = lane(next_[here_]).to;
    ask();
  }
  void transfer() {
    const std::int32_t result =
        is_fetching_ ? host_.pick_load(handle_, FP_HERE, order_.order_id) : host_.drop(handle_, FP_HERE);
    if (result != FP_OK) return become_idle();
    forget_done();
    phase_ = is_fetching_ ? Phase::kPicks : Phase::kDrops;
    is_fetching_ = false;
    deadline_ns_ = kNoTime;
  }

  void ask() {
    heard_no_ = false;
    const Said question{Said::kMayI, goal_};
    host_.send_broadcast(handle_, &question, sizeof question);
    listen(Phase::kAsks, 2 * kSecond_ns);
  }
  void back_off() {
    const std::uint64_t draw = host_.random(handle_, 0, static_cast<std::uint64_t>(now_ns_));
    listen(Phase::kBacksOff, kSecond_ns + static_cast<std::int64_t>(draw % 1'000'000'000));
  }
  void listen(Phase phase, std::int64_t duration_ns) {
    phase_ = phase;
    until_ns_ = now_ns_ + duration_ns;
    go_on_listening();
  }
  void go_on_listening() {
    while (has_kept(FP_EVENT_MESSAGE) && read()) {
    }
    set_timer(std::max(until_ns_, now_ns_));
  }
  void drive() {
    const fp_lane& next = lane(next_[here_]);
    deadline_ns_ = kNoTime;
    phase_ = Phase::kDrives;
    if (host_.move(handle_, next.segment | (next.backward != 0 ? FP_BACKWARD : 0)) != FP_OK) become_idle();
  }

  void set_timer(std::int64_t at_ns) {
    deadline_ns_ = at_ns;
    if (std::exchange(timer_ns_, at_ns) != at_ns) host_.set_timer(handle_, 0, at_ns);
  }

  bool has_kept(std::uint32_t kind) const {
    return std::any_of(kept_.begin(), kept_.end(), [kind](const fp_event& event) { return event.kind == kind; });
  }
  // Which of two kinds is kept, and came first.
  std::uint32_t kept_first(std::uint32_t one, std::uint32_t other) const {
    for (const fp_event& event : kept_) {
      if (event.kind == one || event.kind == other) return event.kind;
    }
    return FP_EVENT_START;
  }
  std::optional<fp_event> take(std::uint32_t kind) {
    const auto is_it = [kind](const fp_event& event) { return event.kind == kind; };
    const auto first = std::find_if(kept_.begin(), kept_.end(), is_it);
    if (first == kept_.end()) return std::nullopt;
    const fp_event event = *first;
    kept_.erase(first);
    return event;
  }
  void forget_done() {
    while (take(FP_EVENT_ACTION_DONE)) {
    }
  }

  // Reads one message. False: there is none.
  bool read() {
    fp_message message{sizeof message, 0, 0, nullptr};
    if (host_.get_message(handle_, &message) != FP_OK) {
      take(FP_EVENT_MESSAGE);
      return false;
    }
    Said said;
    if (message.size != sizeof said) return true;
    std::memcpy(&said, message.bytes, sizeof said);
    if (said.what == Said::kNo && said.station == goal_) heard_no_ = true;
    if (said.what != Said::kMayI || (said.station != here_ && said.station != goal_)) return true;
    const Said no{Said::kNo, said.station};
    host_.send_unicast(handle_, &no, sizeof no, message.sender);
    return true;
  }

  bool read_or_forget() {
    read();
    return true;
  }

  const fp_host& host_;
  fp_controller* handle_;
  const fp_briefing& briefing_;
  const fp_map& map_;
  Phase phase_ = Phase::kIsIdle;
  std::deque<fp_event> kept_;  // what came and is not yet reacted to
  std::int64_t now_ns_ = 0, until_ns_ = 0, deadline_ns_ = kNoTime, timer_ns_ = kNoTime;
  fp_event order_{};
  std::vector<std::uint32_t> next_;  // the lane from each station towards the destination
  std::uint32_t here_, goal_ = FP_NONE, destination_ = FP_NONE;
  bool is_fetching_ = false, heard_no_ = false;
};

void* create(const fp_host* host, fp_controller* handle, const fp_briefing* briefing) {
  return new CallbackCarrier(*host, handle, *briefing);
}
void on_event(void* agent, const fp_event* event) { static_cast<CallbackCarrier*>(agent)->on_event(*event); }
void destroy(void* agent) { delete static_cast<CallbackCarrier*>(agent); }

constexpr fp_agent_type kType = {sizeof(fp_agent_type),
                                 FP_ABI_MAJOR,
                                 FP_ABI_MINOR,
                                 FP_DETERMINISTIC,
                                 "callback-carrier",
                                 "takes silence for consent",
                                 create,
                                 on_event,
                                 destroy,
                                 nullptr,
                                 nullptr};

}  // namespace

extern "C" {
__attribute__((visibility("default"))) const fp_agent_type* fp_agent_query(std::uint32_t) { return &kType; }
}
