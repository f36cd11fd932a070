// The master control of a VDA 5050 fleet: the planner and the book of the zone-server (core/agents/central) behind
// orders and states. dialog.hpp says how they are told, and why that is safe.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/agents/agent_type.hpp"
#include "core/agents/central/fleet_planner.hpp"
#include "core/agents/central/floor_book.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/disk_table.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/settings.hpp"
#include "core/bridges/mqtt/broker_link.hpp"
#include "core/bridges/vda5050/dialog.hpp"
#include "core/bridges/vda5050/vda5050_programs.hpp"

namespace fleetproof::bridges::vda5050 {
namespace {

using agents::central::FleetPlanner;
using agents::central::FloorBook;
using agents::central::WayNumber;

constexpr std::uint32_t kMasterTimer = 1;
constexpr std::int64_t kPulse_ns = 1'000'000'000, kRepeat_ns = 10'000'000'000;

// All that the disk has of one vehicle.
struct VehicleRecord {
  agents::central::AgvRecord book;
  Leg leg;
  std::uint32_t era() const { return book.era(); }
  void fields(auto& io) {
    book.fields(io);
    leg.fields(io);
  }
};

// What was told, and what was said of it.
struct Told {
  using Mark = std::array<std::uint32_t, 5>;
  Mark kept{FP_NONE};                    // on the disk
  std::int64_t sent_ns = INT64_MIN / 2;  // the barrier or the update that is under way
  std::uint32_t work = FP_NONE, waits_for = FP_NONE;
  std::uint32_t ways = 0;  // that were begun
};

class Master {
 public:
  Master(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle, briefing.boot),
        settings_(agents::read_settings(briefing.config)),
        facts_(briefing),
        map_(facts_.shared()),
        names_(map_, briefing),
        geometry_(map_, briefing),
        disk_(controller_, {briefing.fleet_count, map_.station_count(), map_.lane_count()}, briefing.fleet_count,
              briefing.boot),
        book_(map_, geometry_, briefing.fleet_count, briefing.boot),
        planner_(map_, geometry_, book_, settings_),
        link_(controller_, briefing,
              {.name = "master", .filters = {{topic(Topic::State, "+"), 0}, {topic(Topic::Connection, "+"), 1}}}),
        told_(briefing.fleet_count) {
    for (std::uint32_t agv = 0; agv < briefing.fleet_count; ++agv) dialogs_.emplace_back(map_, names_);
    recall();
  }

  void on_event(const fp_event& event) {
    controller_.set_clock(event.now_ns);
    if (event.kind == FP_EVENT_ORDER) planner_.take_open_order({event.order_id, event.from, event.to});
    if (event.kind == FP_EVENT_WITHDRAWN) planner_.withdraw(event.order_id);
    const bool is_pulse = event.kind == FP_EVENT_START || controller_.now_ns() >= pulse_ns_;
    if (is_pulse) pulse_ns_ = controller_.now_ns() + kPulse_ns;
    bool is_news = is_pulse;
    for (const mqtt::Publish& message : link_.take_news().messages) is_news = hear(message) || is_news;
    if (is_news) plan();
    link_.flush();
    controller_.set_timer(kMasterTimer, std::min(pulse_ns_, link_.deadline_ns()));
  }

 private:
  std::string topic(Topic topic, std::string_view serial) const {
    return std::string(version().topic_prefix) + "/" + kManufacturer + "/" + std::string(serial) + "/" +
           std::string(topic_word(topic));
  }
  static const Version& version() { return versions().back(); }

  void recall() {
    const auto records = disk_.recall<VehicleRecord>();
    for (std::uint32_t agv = 0; agv < told_.size(); ++agv) {
      if (records.empty()) {
        begin_way(agv);
        continue;
      }
      const VehicleRecord& record = records[agv];
      book_.recall(agv, record.book);
      planner_.recall(agv, record.book);
      dialogs_[agv].recall(record.book.state.way, record.leg, record.book.state.station);
      told_[agv].ways = record.book.state.way.agv_boot;
      told_[agv].kept = mark_of(agv);
    }
  }
  void begin_way(std::uint32_t agv) {
    dialogs_[agv].begin({book_.server_boot(), ++told_[agv].ways});
    told_[agv].sent_ns = INT64_MIN / 2;
  }

  // True if there may be something new to grant.
  bool hear(const mqtt::Publish& message) {
    State state;
    std::string why_not;
    if (!message.topic.ends_with("/state") || !read_document(message.payload, version(), state, why_not)) return false;
    const auto agv = agv_of(state.header.serial_number, book_.fleet_count());
    if (!agv) return false;
    agents::central::State told;
    const Dialog::Heard heard = dialogs_[*agv].hear(state, told);
    if (heard == Dialog::Heard::BeganAgain) {
      controller_.sometimes("vehicle-began-again");
      begin_way(*agv);
    }
    if (heard != Dialog::Heard::OfWay) return false;
    told.load = load_of(state);
    const FloorBook::News news = book_.hear(*agv, told);
    if (news == FloorBook::News::Joined) planner_.begin(*agv);
    return true;
  }
  // The order whose load it carries.
  static std::uint32_t load_of(const State& state) {
    if (!state.loads || state.loads->empty() || !state.loads->front().load_id) return FP_NONE;
    return static_cast<std::uint32_t>(std::strtoul(state.loads->front().load_id->c_str(), nullptr, 10));
  }

  void plan() {
    disk_.open(book_.server_boot());
    planner_.plan(controller_.now_ns());
    for (const std::uint32_t agv : book_.agvs()) {
      tell(agv);
      const std::uint32_t work = planner_.work_of(agv), waits_for = planner_.waits_for(agv);
      if (work != std::exchange(told_[agv].work, work)) controller_.works_on(agv, work);
      if (waits_for != std::exchange(told_[agv].waits_for, waits_for)) controller_.declare_waiting(agv, waits_for);
    }
    controller_.declare_state(book_.all_joined() ? "planning" : "learning");
  }

  Told::Mark mark_of(std::uint32_t agv) const {
    const Leg& leg = dialogs_[agv].leg();
    return {book_.way(agv).boot, book_.way(agv).granted(), planner_.work(agv).orders, leg.number, leg.update};
  }
  // What a vehicle is told is on the disk before.
  bool keep(std::uint32_t agv) {
    const Told::Mark now = mark_of(agv);
    if (!book_.way(agv).joined || told_[agv].kept == now) return true;
    VehicleRecord record{book_.record_of(agv), dialogs_[agv].leg()};
    record.book.work = planner_.work(agv);
    record.book.grant.orders = record.book.work.orders;
    if (!disk_.keep(agv, record)) return false;
    told_[agv].kept = now;
    return true;
  }

  void tell(std::uint32_t agv) {
    Dialog& dialog = dialogs_[agv];
    if (!dialog.is_joining()) {
      auto unknown = book_.unknown_steps(agv);
      if (dialog.send(unknown.first, std::move(unknown.steps))) told_[agv].sent_ns = INT64_MIN / 2;
    }
    if (!link_.is_connected() || controller_.now_ns() - told_[agv].sent_ns < kRepeat_ns || !keep(agv)) return;
    if (auto barrier = dialog.barrier()) {
      barrier->header = next_header(agv);
      publish(agv, Topic::InstantActions, write_document(*barrier, version()),
              "INSTANT ACTION: cancelOrder of " + serial_number(agv));
    } else if (auto order = dialog.order()) {
      order->header = next_header(agv);
      publish(agv, Topic::Order, write_document(*order, version()),
              "ORDER: " + serial_number(agv) + ", order " + order->order_id + " update " +
                  std::to_string(order->order_update_id) + ", header " + std::to_string(order->header.header_id) +
                  ", " + order->nodes.front().node_id + " to " + order->nodes.back().node_id);
    } else {
      return;
    }
    told_[agv].sent_ns = controller_.now_ns();
  }
  void publish(std::uint32_t agv, Topic what, std::string payload, const std::string& text) {
    link_.publish({.topic = topic(what, serial_number(agv)), .payload = std::move(payload)}, text);
  }
  Header next_header(std::uint32_t agv) {
    return {headers_++, timestamp_of(kUnixSecondsAtZero, controller_.now_ns()), std::string(version().number),
            kManufacturer, serial_number(agv)};
  }

  agents::Controller controller_;
  const agents::Settings settings_;
  const agents::Facts facts_;
  const agents::MapView map_;
  const PlantNames names_;
  agents::HullGeometry geometry_;
  agents::DiskTable disk_;
  FloorBook book_;
  FleetPlanner planner_;
  mqtt::BrokerLink link_;
  std::vector<Dialog> dialogs_;
  std::vector<Told> told_;  // by AGV, as the dialogs
  std::uint32_t headers_ = 0;
  std::int64_t pulse_ns_ = 0;
};

fp_agent_type master_type() {
  fp_agent_type type = agents::agent_type<Master>(
      "vda5050-master", "leads vehicles by VDA 5050 messages, with the decisions of zone-server",
      [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
        if (!agents::has_numbers_for_all(*host, controller, *briefing)) return nullptr;
        if (briefing->role != FP_COMPUTER) {
          agents::cannot_start(*host, controller, "vda5050-master runs on a computer; the AGVs need vda5050");
          return nullptr;
        }
        return new Master(*host, controller, *briefing);
      });
  type.flags |= FP_SERVES_COMPUTERS;
  return type;
}

}  // namespace

const fp_agent_type kMaster = master_type();

}  // namespace fleetproof::bridges::vda5050
