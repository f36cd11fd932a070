// A vehicle that is led by VDA 5050 messages: the protocol (vehicle_protocol.hpp) with a connection and a body. It does
// what its master releases, and drives on to the end of its base when the connection is gone.
#include <algorithm>
#include <cstdlib>
#include <deque>
#include <string>
#include <utility>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/settings.hpp"
#include "core/bridges/mqtt/broker_link.hpp"
#include "core/bridges/vda5050/plant_names.hpp"
#include "core/bridges/vda5050/vda5050_programs.hpp"
#include "core/bridges/vda5050/vehicle_profile.hpp"
#include "core/bridges/vda5050/vehicle_protocol.hpp"

namespace fleetproof::bridges::vda5050 {
namespace {

constexpr std::uint32_t kVehicleTimer = 1;
constexpr std::int64_t kLook_ns = 500'000'000;
constexpr double kClockRunsWrong = 1.02;  // clocks may run wrong by up to 1 %

const Version& version() { return versions().back(); }

class Vehicle {
 public:
  Vehicle(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle, briefing.boot),
        facts_(briefing),
        map_(facts_.shared()),
        names_(map_, briefing),
        settings_(agents::read_settings(briefing.config)),
        protocol_(protocol_settings(briefing.self), factsheet(briefing)),
        link_(controller_, briefing,
              {.name = serial_number(briefing.self),
               .filters = {{topic(briefing.self, Topic::Order), 0}, {topic(briefing.self, Topic::InstantActions), 0}}},
              [this] {
                const Publication will = protocol_.last_will(controller_.now_ns());
                return mqtt::Will{topic(self_, will.topic), will.payload, will.qos, will.retained};
              }),
        self_(briefing.self),
        is_lost_(briefing.boot > 0),
        station_(briefing.start_station) {
    for (const std::uint32_t segment : {briefing.start_segment, briefing.next_segment}) follow(segment);
    if (is_lost_) {
      await_new_positions(1'000'000'000);
      protocol_.hear(Driving{true});
    } else {
      protocol_.hear(StandsAt{names_.node_id(station_)});
    }
  }

  void on_event(const fp_event& event) {
    controller_.set_clock(event.now_ns);
    if (event.kind == FP_EVENT_ACTION_DONE) action_done(event.result);
    if (is_lost_) find_place();
    hear(link_.take_news());
    act();
    tell();
    link_.flush();
    set_timer();
    controller_.declare_state(activity());
  }

 private:
  // What was asked of the body, in order, and has not ended.
  struct Command {
    std::uint32_t edge = 0;  // its sequenceId; 0: an action
    std::uint32_t lane = 0;
    Action action{};
    bool is_drive() const { return edge > 0; }
  };

  static std::string topic(std::uint32_t self, Topic what) {
    return topic_name(version(), kManufacturer, serial_number(self), what);
  }

  void hear(const mqtt::BrokerLink::News& news) {
    if (news.was_lost) protocol_.hear(ConnectionLost{});
    if (news.was_made) protocol_.hear(ConnectionOpened{});
    for (const mqtt::Publish& message : news.messages) {
      if (message.topic == topic(self_, Topic::Order)) protocol_.order_received(message.payload);
      if (message.topic == topic(self_, Topic::InstantActions)) protocol_.instant_actions_received(message.payload);
    }
  }

  VehicleSettings protocol_settings(std::uint32_t self) const {
    VehicleSettings settings;
    settings.identity = {&version(), kManufacturer, serial_number(self), kUnixSecondsAtZero};
    settings.abilities = vehicle_abilities();
    settings.knows_edge = [this](const Edge& edge) {
      return names_.lane_of(edge.edge_id, edge.start_node_id, edge.end_node_id).has_value();
    };
    return settings;
  }
  static Factsheet factsheet(const fp_briefing& briefing) {
    const fp_agv& self = *fp_agv_at(briefing.fleet, briefing.agv_stride, briefing.self);
    return factsheet_of(self, briefing.vehicle_type_names[self.vehicle_type]);
  }

  // ---- the body

  void follow(std::uint32_t segment) {
    for (const std::uint32_t lane : map_.lanes_from(station_)) {
      if (map_.action_segment(lane) != segment) continue;
      station_ = map_.lane(lane).to;
      return;
    }
  }

  // No position that it perceives after this is older than now.
  void await_new_positions(std::int64_t more_ns) {
    const double late_s = kClockRunsWrong * settings_.position_late_s;
    rests_from_ns_ = controller_.now_ns() + static_cast<std::int64_t>(late_s * 1e9) + more_ns;
  }

  // Since a restart it does not know its place, and actions of its former self may be under way. If it was idle at two
  // looks and no action ended between them, nothing is; then it rests at the last station of its former self, unless a
  // contact stopped it before.
  void find_place() {
    const std::uint32_t action = controller_.action();
    const bool is_idle = action == FP_IDLE || action == FP_PARKED || action == FP_CHARGING_NOW;
    const bool was_idle = std::exchange(was_idle_, is_idle);
    if (!is_idle) await_new_positions(0);
    fp_pose pose{};
    if (!is_idle || !was_idle || controller_.now_ns() <= rests_from_ns_ || !controller_.pose(pose)) return;
    const double off_m = length(agents::Vec{pose.x_m, pose.y_m} - map_.position_m(station_));
    if (off_m > 2.0 * settings_.position_error_m + 0.05) return;
    is_lost_ = false;
    protocol_.hear(StandsAt{names_.node_id(station_)});
    protocol_.hear(Driving{false});
  }

  void action_done(std::int32_t result) {
    was_idle_ = false;
    if (commands_.empty() || result != FP_OK) return;  // a contact put it out of order for good
    const Command done = std::move(commands_.front());
    commands_.pop_front();
    if (!done.is_drive()) {
      protocol_.hear(ActionFinished{done.action.action_id, {}});
      return;
    }
    station_ = map_.lane(done.lane).to;
    if (commands_.empty()) protocol_.hear(Driving{false});
    protocol_.hear(NodeReached{done.edge + 1});
  }

  void act() {
    if (is_lost_) return;
    sense();
    while (true) {
      const auto wishes = protocol_.take_action_wishes();
      for (const ActionWish& wish : wishes) {
        if (wish.kind == ActionWish::Kind::Start) begin(wish.action);
      }
      if (wishes.empty()) break;
    }
    drive();
  }
  void begin(const Action& action) {
    const ActionParameter* load = action.parameter("loadId");
    const auto order =
        load == nullptr ? FP_NONE : static_cast<std::uint32_t>(std::strtoul(load->value.c_str(), nullptr, 10));
    const bool is_pick = action.action_type == "pick", is_drop = action.action_type == "drop";
    // Its former self did that already.
    const bool is_needless =
        (is_pick && controller_.order_on_board() == order) || (is_drop && controller_.order_on_board() != order);
    if (is_needless) return protocol_.hear(ActionFinished{action.action_id, "nothing to do"});
    const bool is_begun = is_pick   ? controller_.pick_load(FP_HERE, order)
                          : is_drop ? controller_.drop(FP_HERE)
                                    : controller_.charge(FP_HERE);
    if (!is_begun) return protocol_.hear(ActionFailed{action.action_id, "the vehicle cannot do that here"});
    commands_.push_back({0, 0, action});
    protocol_.hear(ActionBegun{action.action_id});
  }
  // The next edge, and one behind it, if it need not stop in between.
  void drive() {
    while (commands_.size() < 2) {
      const DrivingWish wish = protocol_.driving_wish();
      if (wish.edges.empty() || wish.hold || (!commands_.empty() && !commands_.front().is_drive())) return;
      const Edge& edge = wish.edges.front();
      const auto lane = names_.lane_of(edge.edge_id, edge.start_node_id, edge.end_node_id);
      if (!lane) return;
      if (!commands_.empty() &&
          !agents::same_heading(map_.end_heading(commands_.back().lane), map_.start_heading(*lane)))
        return;
      if (!controller_.move(map_.action_segment(*lane))) return;
      commands_.push_back({edge.sequence_id, *lane, {}});
      protocol_.hear(EdgeBegun{edge.sequence_id});
      protocol_.hear(Driving{true});
    }
  }
  // What has changed of it, for some of that is worth a state of its own.
  void sense() {
    protocol_.hear(BatteryIs{{100.0 * controller_.battery_level(), controller_.action() == FP_CHARGING_NOW}});
    if (fp_pose pose{}; controller_.pose(pose))
      protocol_.hear(Located{{true, pose.x_m, pose.y_m, theta_of({pose.heading_x, pose.heading_y}), kMapId}});
    const std::uint32_t order = controller_.order_on_board();
    if (order != std::exchange(load_, order)) {
      std::vector<Load> loads;
      if (order != FP_NONE) loads.emplace_back().load_id = std::to_string(order);
      protocol_.hear(LoadsAre{std::move(loads)});
    }
    if (controller_.out_of_order() && !std::exchange(is_broken_, true))
      protocol_.hear(ErrorRaised{{"outOfOrder", {}, "a contact stopped the vehicle", {}, ErrorLevel::Fatal}});
  }

  void tell() {
    for (Publication& one : protocol_.publish(controller_.now_ns())) {
      const std::string text = word_of(one.topic) + ": " + serial_number(self_) + ", " + one.about;
      link_.publish(
          {.topic = topic(self_, one.topic), .payload = std::move(one.payload), .qos = one.qos, .retain = one.retained},
          text);
    }
  }
  static std::string word_of(Topic topic) {
    std::string word(topic_word(topic));
    std::ranges::transform(word, word.begin(),
                           [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    return word;
  }

  void set_timer() {
    const std::int64_t now_ns = controller_.now_ns();
    std::int64_t earliest = is_lost_ ? now_ns + kLook_ns : INT64_MAX;
    if (link_.is_connected()) earliest = std::min(earliest, protocol_.next_deadline_ns());
    earliest = std::min(earliest, link_.deadline_ns());
    if (earliest != INT64_MAX) controller_.set_timer(kVehicleTimer, earliest);
  }

  const char* activity() const {
    if (is_lost_) return "finding its place";
    if (commands_.empty()) return protocol_.order().nodes().empty() ? "idle" : "waiting";
    return commands_.front().is_drive() ? "driving" : "acting";
  }

  agents::Controller controller_;
  const agents::Facts facts_;
  const agents::MapView map_;
  const PlantNames names_;
  const agents::Settings settings_;
  VehicleProtocol protocol_;
  mqtt::BrokerLink link_;
  const std::uint32_t self_;
  std::deque<Command> commands_;
  bool is_lost_ = false, was_idle_ = false;
  std::int64_t rests_from_ns_ = 0;  // lost: then a position shows where it stands
  std::uint32_t station_;           // where it stands, or to which it drives
  std::uint32_t load_ = FP_NONE;    // the order of the load on board, as the protocol knows
  bool is_broken_ = false;          // the same
};

fp_agent_type vehicle_type() {
  return agents::agent_type<Vehicle>(
      "vda5050", "a vehicle led by VDA 5050 messages",
      [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
        const bool is_led = briefing->role == FP_AGV && briefing->computer_count > 0;
        if (!is_led) {
          agents::cannot_start(*host, controller, "vda5050 drives an AGV; a computer leads it (vda5050-master)");
          return nullptr;
        }
        return new Vehicle(*host, controller, *briefing);
      });
}

}  // namespace

const fp_agent_type kVehicle = vehicle_type();

}  // namespace fleetproof::bridges::vda5050
