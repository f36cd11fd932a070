// The program of a vehicle whose fleet has a zone-server: it carries out the steps that the server grants, one after
// the other, and stands where they end. It tells the server what it has done, and its orders. floor_book.hpp says what
// it promises and why this is enough. The first computer of the fleet is its server.
#include <algorithm>
#include <deque>
#include <string>
#include <utility>

#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/hull_tables.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"
#include "core/agents/settings.hpp"

namespace fleetproof::agents::central {
namespace {

constexpr double kWrongClock = 1.02;  // clocks may run wrong by up to 1 %

bool has_nothing_under_way(std::uint32_t action) {
  return action == FP_IDLE || action == FP_PARKED || action == FP_CHARGING_NOW;
}

class Follower : public Program {
 public:
  Follower(const fp_host& host, fp_controller* handle, const fp_briefing& briefing, const FollowerOptions& options)
      : options_(options),
        controller_(host, handle, briefing.boot),
        facts_(briefing),
        map_(facts_.shared()),
        settings_(read_settings(briefing.config)) {
    way_.way.agv_boot = briefing.boot;
    held_.station = briefing.start_station;
    // Its former self has begun these. What else the former self was granted, it does not know and does not use.
    for (const std::uint32_t segment : {briefing.start_segment, briefing.next_segment})
      append_segment(map_, held_, segment);
    held_ = end_of(map_, held_);
  }

  void on_event(const fp_event& event) override {
    controller_.set_clock(event.now_ns);
    if (event.kind == FP_EVENT_START) start();
    if (event.kind == FP_EVENT_TIMER) tick();
    if (event.kind == FP_EVENT_ACTION_DONE) action_done(event.result);
    if (event.kind == FP_EVENT_ORDER)
      orders_.push_back({{event.order_id, event.from, event.to}, controller_.order_on_board() == event.order_id});
    if (event.kind == FP_EVENT_MESSAGE) {
      controller_.drain_inbox([&](std::uint32_t sender, std::span<const std::byte> bytes) {
        if (sender == server()) obey(bytes);
      });
    }
    act();
    controller_.declare_state(activity());
  }

 private:
  // Lost: since a restart, it does not know its place, or actions of its former self are under way. Ending: it has
  // heard of another boot of the server, and finishes what is under way.
  enum class Phase : std::uint8_t { Lost, Ending, OnWay };
  struct OwnOrder {
    Order order;
    bool on_board = false;  // when it came: after a restart
    bool done = false;
  };

  std::uint32_t server() const { return facts_.shared().fleet_count; }

  void start() {
    await_new_positions(kSecond_ns);
    fp_pose pose{};
    if (way_.way.agv_boot > 0) {
      controller_.sometimes("restarted");
    } else {
      if (controller_.pose(pose)) held_.heading = {pose.heading_x, pose.heading_y};
      begin_way();
    }
    tick();
  }

  void tick() {
    const double pause_s = kPulse_s * (0.8 + 0.4 * controller_.random(kPulseDraws));
    controller_.set_timer(kPulseTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
    if (phase_ == Phase::Lost) find_place();
    if (options_.patience_ns > 0) lose_patience();
    report();
  }

  // No position that it perceives after this is older than now.
  void await_new_positions(std::int64_t more_ns) {
    const double late_s = kWrongClock * settings_.position_late_s;
    rests_from_ns_ = controller_.now_ns() + static_cast<std::int64_t>(late_s * 1e9) + more_ns;
  }

  // If the AGV was idle at two looks and no action ended between them, nothing of its former self is under way, and no
  // end of such an action is still to be told. When no position can be older than its last motion, the heading is
  // right. An AGV that a contact stopped is out of order; it may be beside the station.
  void find_place() {
    const bool idle = has_nothing_under_way(controller_.action());
    const bool was_idle = std::exchange(seen_idle_, idle);
    if (!idle) await_new_positions(0);
    fp_pose pose{};
    if (!idle || !was_idle || controller_.now_ns() <= rests_from_ns_ || !controller_.pose(pose)) return;
    const double off_m = length(Vec{pose.x_m, pose.y_m} - map_.position_m(held_.station));
    if (off_m > 2.0 * settings_.position_error_m + kHullTolerance_m) return;
    held_.heading = {pose.heading_x, pose.heading_y};
    begin_way();
  }

  // Of a faulty follower: it takes the request for lost, and what answers it later for an answer to something else.
  void lose_patience() {
    const bool waits = phase_ == Phase::OnWay && steps_.empty();
    const bool is_over = waits && controller_.now_ns() - waits_from_ns_ > options_.patience_ns;
    if (!waits || is_over) waits_from_ns_ = controller_.now_ns();
    if (!is_over) return;
    ++way_.way.agv_boot;
    begin_way();
  }

  // Requires: the AGV rests, and the held path says where.
  void begin_way() {
    phase_ = Phase::OnWay;
    way_.stands = true;
    way_.station = held_.station;
    way_.heading = held_.heading;
    way_.known = way_.done = 0;
    way_.load = controller_.order_on_board();
    // Its former self may have put down a load that was still on board when the orders came.
    std::erase_if(orders_,
                  [&](const OwnOrder& own) { return own.done || (own.on_board && own.order.id != way_.load); });
    orders_told_ = 0;
  }

  void obey(std::span<const std::byte> bytes) {
    const std::optional<Grant> grant = decode_as<Grant>(bytes);
    if (!grant) return;
    if (grant->way.server_boot > way_.way.server_boot) follow_boot(grant->way.server_boot);
    if (phase_ != Phase::OnWay || (options_.ways_count && grant->way != way_.way))
      return controller_.sometimes("grant-of-another-way");
    way_.has_work = grant->has_work;
    orders_told_ = std::clamp(grant->orders, orders_told_, static_cast<std::uint32_t>(orders_.size()));
    take_steps(*grant);
  }

  // It forgets the steps of the former boot, but for those under way: at their end a new way begins.
  void follow_boot(std::uint32_t server_boot) {
    controller_.sometimes("server-restarted");
    way_.way.server_boot = server_boot;
    if (phase_ == Phase::Lost) return;
    if (options_.former_steps_end) steps_.resize(under_way_);
    const auto lanes = static_cast<std::uint32_t>(std::ranges::count_if(steps_, &Step::drives));
    held_.count = std::min(held_.count, lanes);
    phase_ = Phase::Ending;
    way_.stands = false;
    if (under_way_ == 0 || !options_.ways_begin_at_rest) begin_way();
  }

  // The first steps of the message may be known already; if others are missing before them, it waits for these.
  void take_steps(const Grant& grant) {
    const bool is_new = !options_.numbers_count && steps_.empty() && grant.first == 0;
    const std::uint32_t first = is_new ? way_.known : grant.first;
    if (first > way_.known) return controller_.sometimes("grant-lost");
    if (first + grant.steps.size() <= way_.known) return;
    for (std::uint32_t i = way_.known - first; i < grant.steps.size(); ++i) {
      const Step& step = grant.steps[i];
      if (step.drives()) {
        Path longer = held_;
        if (step.what >= map_.lane_count() || !longer.append(step.what) || !is_driveable(map_, longer)) break;
        held_ = longer;
      }
      steps_.push_back(step);
      ++way_.known;
    }
    act();
    report();
  }

  // After a refusal, the AGV is out of order where it is, for good: this step never ends.
  void action_done(std::int32_t result) {
    seen_idle_ = false;
    if (under_way_ == 0 || result != FP_OK) return;
    --under_way_;
    finish_step();
    if (phase_ == Phase::Ending && under_way_ == 0) begin_way();
    act();
    report();
  }

  void act() {
    while (phase_ == Phase::OnWay && under_way_ == 0 && !steps_.empty()) {
      const Step step = steps_.front();
      if (!is_needless(step)) {
        if (begin(step)) {
          under_way_ = 1;
          break;
        }
        if (step.kind != Step::Kind::Pick || !has_nothing_under_way(controller_.action())) return;
        finish_order(step.what);  // its load is not here
      }
      finish_step();
    }
    roll_on();
  }

  bool begin(const Step& step) {
    if (step.drives()) return controller_.move(map_.action_segment(step.what));
    if (step.kind == Step::Kind::Pick) return controller_.pick_load(FP_HERE, step.what);
    return step.charges() ? controller_.charge(FP_HERE) : controller_.drop(FP_HERE);
  }

  // What its former self did already, or what a load that was not there has made pointless.
  bool is_needless(const Step& transfer) {
    if (transfer.kind == Step::Kind::Pick) return controller_.order_on_board() == transfer.what;
    return transfer.kind == Step::Kind::Drop && controller_.order_on_board() != transfer.what;
  }

  // If the move is given before the AGV brakes, the AGV does not stop between two lanes.
  void roll_on() {
    if (phase_ != Phase::OnWay || under_way_ != 1 || steps_.size() < 2) return;
    const Step &now = steps_[0], &next = steps_[1];
    if (!now.drives() || !next.drives()) return;
    const bool straight_on = same_heading(map_.end_heading(now.what), map_.start_heading(next.what));
    if (straight_on && controller_.move(map_.action_segment(next.what))) under_way_ = 2;
  }

  void finish_step() {
    const Step step = steps_.front();
    steps_.pop_front();
    ++way_.done;
    if (step.drives()) pass_first_lane(map_, held_);
    if (step.kind == Step::Kind::Drop) finish_order(step.what);
  }

  void finish_order(std::uint32_t id) {
    for (OwnOrder& own : orders_) own.done = own.done || own.order.id == id;
  }

  void report() {
    ++way_.number;
    State state = way_;
    state.battery = controller_.battery_level();
    state.out_of_order = controller_.out_of_order();
    state.done += !options_.lanes_to_their_end && under_way_ == 2 && state.out_of_order ? 1 : 0;
    state.first_order = orders_told_;
    for (std::size_t i = orders_told_; i < orders_.size() && state.orders.size() < kMostOrdersInAMessage; ++i)
      state.orders.push_back(orders_[i].order);
    const std::string text = "STATE: " + std::to_string(way_.done) + " of " + std::to_string(way_.known) + " steps";
    controller_.describe(text.c_str(), way_.way.name().c_str(), nullptr);
    controller_.send(encode(state), server());
  }

  const char* activity() {
    constexpr const char* kNames[] = {"driving", "picking", "dropping", "connecting to a charger"};  // by kind
    if (phase_ == Phase::Lost) return "finding its place";
    if (under_way_ > 0) return kNames[static_cast<std::size_t>(steps_.front().kind)];
    const bool has_orders = !orders_.empty() && !orders_.back().done;
    return has_orders || way_.has_work || controller_.order_on_board() != FP_NONE ? "waiting" : "idle";
  }

  const FollowerOptions options_;
  Controller controller_;
  const Facts facts_;
  const MapView map_;
  const Settings settings_;

  Phase phase_ = Phase::Lost;
  bool seen_idle_ = false;          // Lost: at the last look, and no action has ended since
  std::int64_t rests_from_ns_ = 0;  // Lost: then a position shows how it stands
  State way_;                       // what it says of its way, in its newest message
  Path held_;                       // from where it stands or drives, as far as it has steps
  std::deque<Step> steps_;          // not done
  std::uint32_t under_way_ = 0;     // of these: the first one, and perhaps the move that has been given to follow it
  std::vector<OwnOrder> orders_;
  std::uint32_t orders_told_ = 0;   // the server has so many of them
  std::int64_t waits_from_ns_ = 0;  // since then, it has waited for a Grant; only the impatient look
};

}  // namespace

Program* create(const fp_host& host, fp_controller* controller, const fp_briefing& briefing,
                const FollowerOptions& options) {
  return new Follower(host, controller, briefing, options);
}

}  // namespace fleetproof::agents::central
