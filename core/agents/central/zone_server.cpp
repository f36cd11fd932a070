// The program of the computer of a central fleet: it plans for all followers and grants each its next steps. It keeps
// the book of the floor (floor_book.hpp), and repeats what an AGV does not seem to have.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/agents/central/fleet_planner.hpp"
#include "core/agents/central/floor_book.hpp"
#include "core/agents/central/messages.hpp"
#include "core/agents/central/programs.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/disk_table.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/settings.hpp"

namespace fleetproof::agents::central {
namespace {

class ZoneServer : public Program {
 public:
  ZoneServer(const fp_host& host, fp_controller* handle, const fp_briefing& briefing, const ServerOptions& options)
      : options_(options),
        controller_(host, handle, briefing.boot),
        settings_(read_settings(briefing.config)),
        facts_(briefing),
        map_(facts_.shared()),
        geometry_(map_, briefing),
        disk_(controller_, {briefing.fleet_count, map_.station_count(), map_.lane_count()}, briefing.fleet_count,
              briefing.boot),
        book_(map_, geometry_, briefing.fleet_count, briefing.boot, options),
        planner_(map_, geometry_, book_, settings_, options),
        told_(briefing.fleet_count, Told{.owes = briefing.boot > 0, .heard_ns = controller_.now_ns()}) {
    if (briefing.boot == 0) return;
    controller_.sometimes("restarted");
    const auto records = disk_.recall<AgvRecord>();
    if (!records.empty()) controller_.sometimes("recalled");
    for (std::uint32_t agv = 0; agv < records.size(); ++agv) {
      book_.recall(agv, records[agv]);
      planner_.recall(agv, records[agv]);
      told_[agv].kept = mark_of(agv);
    }
  }

  void on_event(const fp_event& event) override {
    controller_.set_clock(event.now_ns);
    if (event.kind == FP_EVENT_MESSAGE) {
      bool news = false;
      controller_.drain_inbox(
          [&](std::uint32_t sender, std::span<const std::byte> bytes) { news = hear(sender, bytes) || news; });
      if (news) plan();
    }
    // An order of no AGV comes to the server; after a restart again, until it is done.
    if (event.kind == FP_EVENT_WITHDRAWN) planner_.withdraw(event.order_id);
    if (event.kind == FP_EVENT_ORDER) planner_.take_open_order({event.order_id, event.from, event.to});
    if (event.kind == FP_EVENT_START || event.kind == FP_EVENT_TIMER) tick();
  }

 private:
  // What has to be on the disk anew when it changes.
  using Mark = std::array<std::uint32_t, 3>;  // the boot of the AGV, so many steps, so many orders
  // What an AGV was told, and what was said of it.
  struct Told {
    std::uint32_t steps = 0;  // so many were sent at least once
    bool owes = false;        // an answer to what it told
    Mark kept{FP_NONE};       // what is on the disk
    std::uint32_t work = FP_NONE, waits_for = FP_NONE;
    std::int64_t heard_ns = 0;  // when it was heard; only a faulty server looks
  };

  void tick() {
    const double pause_s = kPulse_s * (0.8 + 0.4 * controller_.random(kPulseDraws));
    controller_.set_timer(kPulseTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
    disk_.open(book_.server_boot());
    fail_on_purpose();
    plan();
    for (const std::uint32_t agv : book_.agvs()) {
      const FloorBook::Way& way = book_.way(agv);
      const bool repeats = way.joined && way.known < way.granted();
      if (repeats) controller_.sometimes("retransmission");
      if (repeats || told_[agv].owes || !way.joined) send(agv);
    }
    controller_.declare_state(book_.all_joined() ? "planning" : "learning");
  }

  // Of faulty servers.
  void fail_on_purpose() {
    const std::int64_t now_ns = controller_.now_ns(), silence_ns = options_.silence_frees_after_ns;
    const bool writes = options_.writes_every_ns > 0 && now_ns - written_ns_ > options_.writes_every_ns;
    if (writes) written_ns_ = now_ns;
    for (const std::uint32_t agv : book_.agvs()) {
      if (writes) keep(agv);
      if (silence_ns > 0 && now_ns - told_[agv].heard_ns > silence_ns) book_.lose(agv);
    }
  }

  // True if there may be something new to grant.
  bool hear(std::uint32_t sender, std::span<const std::byte> bytes) {
    const std::optional<State> state = decode_as<State>(bytes);
    if (!state || !is_possible(sender, *state)) return false;
    Told& told = told_[sender];
    told.heard_ns = controller_.now_ns();
    const bool knew = book_.way(sender).joined;
    const Path before = book_.way(sender).held;
    const FloorBook::News news = book_.hear(sender, *state);
    const Path& held = book_.way(sender).held;
    if (news == FloorBook::News::Joined) {
      if (knew && !share_a_station(map_, before, held) && !book_.is_free(sender, held))
        controller_.sometimes("set-down-in-the-way");
      planner_.begin(sender);
      told.steps = 0;
      told.owes = true;  // so that its way is on the disk, also if it gets no work
    }
    const bool is_present = state->way == book_.number_of(sender);
    told.owes = told.owes || !state->orders.empty() || !is_present || state->has_work != has_work(sender);
    if (!state->stands || !is_present) return false;
    const bool takes = planner_.take_orders(sender, state->first_order, state->orders);
    return takes || news != FloorBook::News::None;
  }

  bool is_possible(std::uint32_t sender, const State& state) const {
    const auto exists = [&](std::uint32_t station) { return station < map_.station_count(); };
    return sender < book_.fleet_count() && exists(state.station) &&
           std::ranges::all_of(state.orders,
                               [&](const Order& order) { return exists(order.from) && exists(order.to); });
  }

  void plan() {
    planner_.plan(controller_.now_ns());
    for (const std::uint32_t agv : book_.agvs()) {
      if (told_[agv].steps >= book_.way(agv).granted()) continue;
      controller_.sometimes("grant");
      send(agv);
    }
    // For results: whose work an open order is before its load is picked, and who is to blame if an AGV stands.
    for (const std::uint32_t agv : book_.agvs()) {
      const std::uint32_t work = planner_.work_of(agv), waits_for = planner_.waits_for(agv);
      if (work != std::exchange(told_[agv].work, work)) controller_.works_on(agv, work);
      if (waits_for != std::exchange(told_[agv].waits_for, waits_for)) controller_.declare_waiting(agv, waits_for);
    }
  }

  Mark mark_of(std::uint32_t agv) const {
    return {book_.way(agv).boot, book_.way(agv).granted(), planner_.work(agv).orders};
  }
  bool has_work(std::uint32_t agv) const { return planner_.work_of(agv) != FP_NONE; }

  // What an AGV is told is on the disk before. False: it is not, and has to wait.
  bool keep(std::uint32_t agv) {
    const Mark now = mark_of(agv);
    if (!book_.way(agv).joined || told_[agv].kept == now) return true;
    AgvRecord record = book_.record_of(agv);
    record.work = planner_.work(agv);
    record.grant.orders = record.work.orders;
    if (!disk_.keep(agv, record)) return false;
    told_[agv].kept = now;
    return true;
  }

  void send(std::uint32_t agv) {
    if (options_.writes_every_ns == 0 && !keep(agv)) return;
    Told& told = told_[agv];
    Grant grant = book_.unknown_steps(agv);
    if (!options_.repeats_grants && grant.first + grant.steps.size() <= told.steps) grant.steps.clear();
    grant.orders = planner_.work(agv).orders;
    grant.has_work = has_work(agv);
    const auto last = static_cast<std::uint32_t>(grant.first + grant.steps.size());
    told.owes = false;
    told.steps = std::max(told.steps, last);
    const std::string steps = "steps " + std::to_string(grant.first + 1) + " to " + std::to_string(last);
    controller_.describe(("GRANT: " + (grant.steps.empty() ? "nothing new" : steps)).c_str(), nullptr,
                         grant.way.name().c_str());
    controller_.send(encode(grant), agv);
  }

  const ServerOptions options_;
  Controller controller_;
  const Settings settings_;
  const Facts facts_;
  const MapView map_;
  HullGeometry geometry_;
  DiskTable disk_;
  FloorBook book_;
  FleetPlanner planner_;
  std::vector<Told> told_;       // by AGV
  std::int64_t written_ns_ = 0;  // only a faulty server looks
};

}  // namespace

Program* create(const fp_host& host, fp_controller* controller, const fp_briefing& briefing,
                const ServerOptions& options) {
  return new ZoneServer(host, controller, briefing, options);
}

}  // namespace fleetproof::agents::central
