#include "core/agents/central/zone_server.hpp"

#include <algorithm>
#include <string>

#include "core/agents/agent_type.hpp"
#include "core/agents/central/roles.hpp"

namespace fleetproof::agents::central {

ZoneServer::ZoneServer(const fp_host& host, fp_controller* handle, const fp_briefing& briefing,
                       const ServerOptions& options)
    : options_(options),
      controller_(host, handle, briefing.boot),
      settings_(read_settings(briefing.config)),
      facts_(briefing),
      map_(facts_.shared()),
      geometry_(map_, briefing),
      disk_(controller_, map_, briefing.fleet_count, briefing.boot),
      book_(map_, geometry_, briefing.fleet_count, briefing.boot, options),
      planner_(map_, geometry_, book_, settings_, options),
      declared_(briefing.fleet_count),
      kept_(briefing.fleet_count),
      owes_(briefing.fleet_count, briefing.boot > 0),
      told_(briefing.fleet_count),
      heard_ns_(briefing.fleet_count, controller_.now_ns()) {
  if (briefing.boot == 0) return;
  const std::vector<AgvRecord> records = disk_.recall();
  controller_.sometimes("restarted");
  if (!records.empty()) controller_.sometimes("recalled");
  book_.recall(records);
  for (std::uint32_t agv = 0; agv < records.size(); ++agv) {
    planner_.recall(agv, records[agv]);
    kept_[agv] = kept_now(agv);
  }
}

void ZoneServer::on_event(const fp_event& event) {
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

void ZoneServer::tick() {
  const double pause_s = kPulse_s * (0.8 + 0.4 * controller_.random(kPulseDraws));
  controller_.set_timer(kPulseTimer, controller_.now_ns() + static_cast<std::int64_t>(pause_s * 1e9));
  disk_.open(book_.server_boot());
  if (options_.writes_every_ns > 0) write_late();
  if (options_.silence_frees_after_ns > 0) lose_the_silent();
  plan();
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    const FloorBook::Way& way = book_.way(agv);
    const bool repeats = way.joined && way.known < way.granted();
    if (repeats) controller_.sometimes("retransmission");
    if (repeats || owes_[agv] || !way.joined) send(agv);
  }
  controller_.declare_state(book_.all_joined() ? "planning" : "learning");
}

// Of a faulty server.
void ZoneServer::lose_the_silent() {
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    if (controller_.now_ns() - heard_ns_[agv] > options_.silence_frees_after_ns) book_.lose(agv);
  }
}

// Of a faulty server.
void ZoneServer::write_late() {
  if (controller_.now_ns() - written_ns_ < options_.writes_every_ns) return;
  written_ns_ = controller_.now_ns();
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) keep(agv);
}

// True if there may be something new to grant.
bool ZoneServer::hear(std::uint32_t sender, std::span<const std::byte> bytes) {
  const std::optional<State> state = decode_state(bytes);
  if (!state || !is_possible(sender, *state)) return false;
  heard_ns_[sender] = controller_.now_ns();
  const Path held = book_.way(sender).held;
  const bool knew = book_.way(sender).joined;
  const FloorBook::News news = book_.hear(sender, *state);
  if (news == FloorBook::News::Joined && knew && !share_a_station(map_, held, book_.way(sender).held) &&
      !book_.is_free(sender, book_.way(sender).held))
    controller_.sometimes("set-down-in-the-way");
  if (news == FloorBook::News::Joined) {
    planner_.begin(sender);
    told_[sender] = 0;
    owes_[sender] = true;  // so that its way is on the disk, also if it gets no work
  }
  owes_[sender] = owes_[sender] || !state->orders.empty() || state->way != book_.number_of(sender) ||
                  state->has_work != has_work(sender);
  if (!state->stands || state->way != book_.number_of(sender)) return false;
  const std::uint32_t orders = planner_.orders_of(sender);
  planner_.take_orders(sender, state->first_order, state->orders);
  return news != FloorBook::News::None || planner_.orders_of(sender) != orders;
}

bool ZoneServer::is_possible(std::uint32_t sender, const State& state) const {
  const auto exists = [&](std::uint32_t station) { return station < map_.station_count(); };
  return sender < book_.fleet_count() && exists(state.station) &&
         std::ranges::all_of(state.orders, [&](const Order& order) { return exists(order.from) && exists(order.to); });
}

void ZoneServer::plan() {
  planner_.plan(controller_.now_ns());
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    if (told_[agv] >= book_.way(agv).granted()) continue;
    controller_.sometimes("grant");
    send(agv);
  }
  declare();
}

// For results: whose work an open order is before its load is picked, and who is to blame if an AGV stands.
void ZoneServer::declare() {
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    const Declared now{planner_.work_of(agv), planner_.waits_for(agv)};
    Declared& known = declared_[agv];
    if (now.work != known.work) controller_.works_on(agv, now.work);
    if (now.waits_for != known.waits_for) controller_.declare_waiting(agv, now.waits_for);
    known = now;
  }
}

// What an AGV is told is on the disk before. False: it is not, and has to wait.
bool ZoneServer::keep(std::uint32_t agv) {
  const Kept now = kept_now(agv);
  if (!book_.way(agv).joined || kept_[agv] == now) return true;
  AgvRecord record = book_.record_of(agv);
  planner_.put_work(agv, record);
  if (!disk_.keep(agv, record)) return false;
  kept_[agv] = now;
  return true;
}

void ZoneServer::send(std::uint32_t agv) {
  if (options_.writes_every_ns == 0 && !keep(agv)) return;
  Grant grant = book_.unknown_steps(agv);
  if (!options_.repeats_grants && grant.first + grant.steps.size() <= told_[agv]) grant.steps.clear();
  grant.orders = planner_.orders_of(agv);
  grant.has_work = has_work(agv);
  owes_[agv] = false;
  told_[agv] = std::max(told_[agv], static_cast<std::uint32_t>(grant.first + grant.steps.size()));
  const std::string text = grant.steps.empty() ? std::string("GRANT: nothing new")
                                               : "GRANT: steps " + std::to_string(grant.first + 1) + " to " +
                                                     std::to_string(grant.first + grant.steps.size());
  controller_.describe(text.c_str());
  controller_.send(encode(grant), agv);
}

void* create_zone_server(const fp_host* host, fp_controller* controller, const fp_briefing* briefing,
                         const ServerOptions& options) {
  if (!can_start(*host, controller, *briefing, FP_COMPUTER)) return nullptr;
  return new ZoneServer(*host, controller, *briefing, options);
}

constinit const fp_agent_type kZoneServer = faulty_zone_server<ServerOptions{}>(
    "zone-server", "plans for a fleet of followers and grants each the floor that it may use");

}  // namespace fleetproof::agents::central
