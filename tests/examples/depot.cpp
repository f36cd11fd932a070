// A central fleet in one source. The server hears the open orders and lets one AGV drive at a time, by a way on which
// it meets no AGV that stands. The right to drive is a token: a TRIP gives it, and the STATE of an AGV that rests again
// gives it back. With the parameter "impatient", a FAULT, the server gives the token to another AGV after 3 s of
// silence.
#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "fleetproof/agent.h"

using Lanes = std::vector<uint32_t>;
constexpr uint32_t kLanesMax = 200;
constexpr int64_t kTick_ns = 1'000'000'000, kPatience_ns = 3'000'000'000;

// It names the boots of server (from 1) and AGV: what was said to or by a former self has no effect.
struct Trip {
  uint32_t server = 0, agv_boot = 0, number = 0, at_end = FP_NONE, order = FP_NONE;  // at_end: fp_call
  uint32_t lane_count = 0, lanes[kLanesMax] = {};
};

// An AGV says this only while it rests. So STATEs with equal numbers say the same, however late they come.
struct State {
  uint32_t server = 0, agv_boot = 0, done = 0, station = 0, load = FP_NONE;  // done: the trip that ended last
};

struct Participant {
  const fp_host* host;
  fp_controller* self;
  const fp_briefing* briefing;

  Participant(const fp_host* h, fp_controller* s, const fp_briefing* b) : host(h), self(s), briefing(b) {}
  virtual ~Participant() = default;
  virtual void on_event(const fp_event& event) = 0;

  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(briefing->map, number); }
  template <class Content>
  void send(const Content& content, uint32_t receiver, const char* kind) const {
    host->describe(self, kind);
    host->send_unicast(self, &content, sizeof content, receiver);
  }
  template <class Content, class Hear>
  void read(Hear hear) const {
    fp_message message{sizeof message, 0, 0, nullptr};
    while (host->get_message(self, &message) == FP_OK) {
      Content content;
      if (message.size != sizeof content) continue;
      std::memcpy(&content, message.bytes, sizeof content);
      hear(message.sender, content);
    }
  }
};

struct Agv : Participant {
  using Participant::Participant;
  State state;
  Trip trip;
  uint32_t step = 0;                       // of the trip
  bool is_driving = false, rests = false;  // neither: perhaps an action of its former self is under way

  void on_event(const fp_event& event) override {
    if (event.kind == FP_EVENT_START) start();
    if (event.kind == FP_EVENT_MESSAGE) read<Trip>([this](uint32_t, const Trip& heard) { hear(heard); });
    if (event.kind == FP_EVENT_ACTION_DONE && is_driving && event.result == FP_OK) next_step();
    if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
    uint32_t action = FP_DRIVING;
    if (!is_driving && host->get_action(self, &action) == FP_OK && action == FP_IDLE) say_state();
    host->set_timer(self, 0, event.now_ns + kTick_ns);
  }
  void start() {
    state.agv_boot = briefing->boot, state.station = briefing->start_station;
    if (briefing->start_segment == FP_NONE) return;
    for (uint32_t i = 0; i < briefing->map->lane_count; ++i) {  // it is on the way to the end of this one
      const bool is_it = lane(i).segment == (briefing->start_segment & ~FP_BACKWARD);
      if (is_it && lane(i).from == briefing->start_station) state.station = lane(i).to;
    }
  }
  void say_state() {
    rests = true;
    host->get_load(self, &state.load);
    send(state, briefing->fleet_count, "STATE");
  }
  void hear(const Trip& heard) {
    if (heard.server > state.server) state.server = heard.server, state.done = 0;
    if (!rests || heard.server != state.server || heard.agv_boot != state.agv_boot) return;
    if (heard.number <= state.done) return;  // a repetition
    trip = heard, step = 0, is_driving = true, rests = false;
    next_step();
  }
  void next_step() {
    int32_t result = FP_REFUSED;  // a step that is refused ends the trip
    if (step < trip.lane_count) {
      const fp_lane& next = lane(trip.lanes[step]);
      result = host->move(self, next.segment | (next.backward != 0 ? FP_BACKWARD : 0));
      if (result == FP_OK) state.station = next.to;
    } else if (step == trip.lane_count && trip.at_end != FP_NONE) {
      const bool is_pick = trip.at_end == FP_CALL_PICK;
      result = is_pick ? host->pick_load(self, FP_HERE, trip.order) : host->drop(self, FP_HERE);
    }
    ++step;
    if (result == FP_OK) return;
    is_driving = false;
    if (trip.server == state.server) state.done = trip.number;
    say_state();
  }
};

struct Order {
  uint32_t id, from, to;
};

struct Server : Participant {
  std::vector<State> fleet;                       // where each rested last; server 0: it has not answered this server
  std::vector<Order> orders;                      // oldest first
  Trip trip;                                      // the last one
  uint32_t driver = FP_NONE, given_up = FP_NONE;  // who has the token; from whom an impatient server has taken it
  int64_t given_at_ns = 0;

  Server(const fp_host* h, fp_controller* s, const fp_briefing* b) : Participant(h, s, b), fleet(b->fleet_count) {
    trip.server = briefing->boot + 1;
  }
  void on_event(const fp_event& event) override {
    if (event.kind == FP_EVENT_ORDER) orders.push_back({event.order_id, event.from, event.to});
    if (event.kind == FP_EVENT_MESSAGE) read<State>([this](uint32_t agv, const State& said) { hear(agv, said); });
    const bool is_late = driver != FP_NONE && event.now_ns - given_at_ns > kPatience_ns;
    if (is_late && std::string_view(briefing->config) == "impatient") given_up = driver, driver = FP_NONE;
    if (event.kind == FP_EVENT_TIMER && driver != FP_NONE) send(trip, driver, text_of(trip, "again, ").c_str());
    if (driver == FP_NONE) plan(event.now_ns);
    if (event.kind == FP_EVENT_START || event.kind == FP_EVENT_TIMER) host->set_timer(self, 0, event.now_ns + kTick_ns);
  }
  void hear(uint32_t agv, const State& said) {
    if (said.server != trip.server) return greet(agv);
    State& known = fleet[agv];
    const bool is_old = said.agv_boot != known.agv_boot ? said.agv_boot < known.agv_boot : said.done < known.done;
    const bool has_ended = said.done == trip.number, has_restarted = said.agv_boot > trip.agv_boot;
    if (is_old || (agv == driver && !has_ended && !has_restarted)) return;
    if (agv == driver && has_restarted) host->sometimes(self, "driver-restarted");
    if (agv == driver && has_ended && trip.at_end == FP_CALL_PICK && said.load == FP_NONE) forget(trip.order);
    if (known.load != FP_NONE && said.load == FP_NONE) forget(known.load);
    if (agv == driver) driver = FP_NONE;
    if (agv == given_up) given_up = FP_NONE;
    known = said;
  }
  // A TRIP without a number: it tells the AGV of this boot of the server.
  void greet(uint32_t agv) const {
    Trip hello;
    hello.server = trip.server;
    send(hello, agv, "HELLO");
  }
  void forget(uint32_t order) {
    std::erase_if(orders, [&](const Order& known) { return known.id == order; });
  }
  // The oldest order that can be carried out goes first. If the AGVs are in each other's way, one drives a lane away.
  void plan(int64_t now_ns) {
    const auto has_answered = [](const State& agv) { return agv.server != 0; };
    if (orders.empty() || !std::all_of(fleet.begin(), fleet.end(), has_answered)) return;
    const auto goes = [&](const Order& order) { return carry_out(order, now_ns); };
    if (std::any_of(orders.begin(), orders.end(), goes)) return;
    const uint32_t agv = host->random(self, 0, now_ns) % fleet.size();
    Lanes free = free_lanes(agv);
    std::erase_if(free, [&](uint32_t i) { return lane(i).from != fleet[agv].station; });
    if (!free.empty()) give_token(agv, {free[host->random(self, 1, now_ns) % free.size()]}, FP_NONE, FP_NONE, now_ns);
  }
  bool carry_out(const Order& order, int64_t now_ns) {
    const auto carries = [&](const State& agv) { return agv.load == order.id; };
    const bool is_on_board = std::any_of(fleet.begin(), fleet.end(), carries);
    uint32_t best = FP_NONE;
    Lanes best_way, way;
    for (uint32_t agv = 0; agv < fleet.size(); ++agv) {
      if (agv == given_up || fleet[agv].load != (is_on_board ? order.id : FP_NONE)) continue;
      if (!find_way(agv, is_on_board ? order.to : order.from, way)) continue;
      if (best == FP_NONE || way.size() < best_way.size()) best = agv, best_way = way;
    }
    if (best != FP_NONE) give_token(best, best_way, is_on_board ? FP_CALL_DROP : FP_CALL_PICK, order.id, now_ns);
    return best != FP_NONE;
  }
  // For people who look at a trace: what stands before ": " is the kind of the message.
  std::string text_of(const Trip& of, const char* repeated = "") const {
    const char* end = of.at_end == FP_CALL_PICK ? ", pick" : of.at_end == FP_CALL_DROP ? ", drop" : "";
    return "TRIP: " + (repeated + std::to_string(of.lane_count)) + " lanes" + end;
  }
  void give_token(uint32_t agv, const Lanes& way, uint32_t at_end, uint32_t order, int64_t now_ns) {
    const bool is_whole = way.size() <= kLanesMax;  // if not, the next trip goes on from there
    trip = {trip.server, fleet[agv].agv_boot, trip.number + 1, is_whole ? at_end : FP_NONE, order};
    trip.lane_count = is_whole ? way.size() : kLanesMax;
    std::copy_n(way.begin(), trip.lane_count, trip.lanes);
    driver = agv, given_at_ns = now_ns;
    host->works_on(self, agv, order);
    send(trip, agv, text_of(trip).c_str());
  }
  // On these lanes, the AGV keeps the safety distance from every AGV that stands, whatever their headings and loads.
  Lanes free_lanes(uint32_t agv) const {
    const auto type = [&](uint32_t i) { return fp_agv_at(briefing->fleet, briefing->agv_stride, i)->vehicle_type; };
    Lanes free;
    for (uint32_t i = 0; i < briefing->map->lane_count; ++i) {
      const fp_occupancy drive{sizeof drive, type(agv), FP_ANY_LOAD, i, FP_NONE, 0, 0};
      uint32_t conflicts = 0;
      for (uint32_t other = 0; other < fleet.size() && conflicts == 0; ++other) {
        const fp_occupancy stand{sizeof stand, type(other), FP_ANY_LOAD, FP_NONE, fleet[other].station, 0, 0};
        if (other != agv) host->conflict(self, &drive, &stand, 0, &conflicts);
      }
      if (conflicts == 0) free.push_back(i);
    }
    return free;
  }
  // By the fewest lanes, searched from the end.
  bool find_way(uint32_t agv, uint32_t to, Lanes& way) const {
    const Lanes free = free_lanes(agv);
    Lanes next(briefing->map->station_count, FP_NONE), reached{to};
    for (size_t k = 0; k < reached.size(); ++k) {
      for (const uint32_t i : free) {
        const uint32_t from = lane(i).from;
        if (lane(i).to != reached[k] || from == to || next[from] != FP_NONE) continue;
        next[from] = i;
        reached.push_back(from);
      }
    }
    way.clear();
    uint32_t at = fleet[agv].station;
    for (; at != to && next[at] != FP_NONE; at = lane(next[at]).to) way.push_back(next[at]);
    return at == to;
  }
};

static void* create(const fp_host* host, fp_controller* self, const fp_briefing* briefing) {
  if (briefing->role == FP_COMPUTER) return static_cast<Participant*>(new Server(host, self, briefing));
  return static_cast<Participant*>(new Agv(host, self, briefing));
}
static void on_event(void* agent, const fp_event* event) { static_cast<Participant*>(agent)->on_event(*event); }
static void destroy(void* agent) { delete static_cast<Participant*>(agent); }

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  constexpr uint32_t kFlags = FP_DETERMINISTIC | FP_SERVES_COMPUTERS;
  static const fp_agent_type kDepot = {sizeof(fp_agent_type),
                                       FP_ABI_MAJOR,
                                       FP_ABI_MINOR,
                                       kFlags,
                                       "depot",
                                       "a server lets one AGV drive at a time",
                                       create,
                                       on_event,
                                       destroy,
                                       nullptr,
                                       nullptr};
  return &kDepot;
}
