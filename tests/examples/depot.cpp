// A central fleet in one source. The server hears the open orders and lets one AGV drive at a time, by a way on which
// it meets no AGV that stands. The right to drive is a token: a TRIP gives it, and the STATE of an AGV that rests again
// gives it back. With the parameter "impatient", a FAULT, the server gives the token to another AGV after 3 s of
// silence.
#include <algorithm>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
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

// An AGV says this only while it rests: each second, and as its answer to each message. So STATEs with equal numbers
// say the same, however late they come.
struct State {
  uint32_t server = 0, agv_boot = 0, done = 0, station = 0, load = FP_NONE;  // done: the trip that ended last
};

struct Participant {
  const fp_host* host;
  fp_controller* self;
  const fp_briefing* briefing;
  int64_t now_ns = 0, again_ns = 0, timer_ns = -1;  // when it says the same again; to when its timer is set

  Participant(const fp_host* h, fp_controller* s, const fp_briefing* b) : host(h), self(s), briefing(b) {}
  virtual ~Participant() = default;
  virtual void on_event(const fp_event& event) = 0;

  void receive(const fp_event& event) {
    now_ns = event.now_ns;
    if (event.kind == FP_EVENT_TIMER) timer_ns = -1;
    // While a computer is frozen, events wait. One that came before this timer may have set it anew.
    if (event.kind != FP_EVENT_TIMER || now_ns >= again_ns) on_event(event);
  }
  void wait_until_again() {
    if (timer_ns != again_ns) host->set_timer(self, 0, timer_ns = again_ns);
  }
  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(briefing->map, number); }
  template <class Content>
  void send(const Content& content, uint32_t receiver, const char* kind) const {
    host->describe(self, kind);
    host->send_unicast(self, &content, sizeof content, receiver);
  }
  // False: the inbox is empty. A message of another size has no content.
  template <class Content>
  bool read(uint32_t& sender, Content& content) const {
    fp_message message{sizeof message, 0, 0, nullptr};
    if (host->get_message(self, &message) != FP_OK) return false;
    sender = message.sender, content = Content();
    if (message.size == sizeof content) std::memcpy(&content, message.bytes, sizeof content);
    return true;
  }
};

// It reads nothing while it does not rest. What came meanwhile counts as lost: whatever is still true is said again.
struct Agv : Participant {
  using Participant::Participant;
  State state;
  Trip trip;
  uint32_t step = 0;                       // of the trip
  bool is_driving = false, rests = false;  // neither: perhaps an action of its former self is under way

  void on_event(const fp_event& event) override {
    if (event.kind == FP_EVENT_MESSAGE && !rests) return;
    if (event.kind == FP_EVENT_ACTION_DONE && rests) return;  // of its former self: a freeze has delayed the event
    if (event.kind == FP_EVENT_START) start();
    if (event.kind == FP_EVENT_MESSAGE) {
      answer();
    } else if (!is_driving) {
      rest();
    } else if (event.kind == FP_EVENT_ACTION_DONE) {
      next_step(event.result);
    }
    if (!is_driving) wait_until_again();
  }
  void start() {
    state.agv_boot = briefing->boot, state.station = briefing->start_station;
    if (briefing->start_segment == FP_NONE) return;
    for (uint32_t i = 0; i < briefing->map->lane_count; ++i) {  // it is on the way to the end of this one
      const bool is_it = lane(i).segment == (briefing->start_segment & ~FP_BACKWARD);
      if (is_it && lane(i).from == briefing->start_station) state.station = lane(i).to;
    }
  }
  // After a contact, the AGV is out of order, and this boot says nothing any more.
  void rest() {
    again_ns = now_ns + kTick_ns;
    uint32_t action = FP_DRIVING, sender = 0;
    if (!rests && (host->get_action(self, &action) != FP_OK || action != FP_IDLE)) return;
    for (Trip old; !rests && read(sender, old);) continue;
    rests = true;
    say_state();
  }
  void say_state() {
    again_ns = now_ns + kTick_ns;
    host->get_load(self, &state.load);
    send(state, briefing->fleet_count, "STATE");
  }
  void answer() {
    uint32_t server = 0;
    for (Trip heard; read(server, heard);) {
      if (is_new(heard)) return drive(heard);
      say_state();
    }
  }
  bool is_new(const Trip& heard) {
    if (heard.server > state.server) state.server = heard.server, state.done = 0;
    return heard.server == state.server && heard.agv_boot == state.agv_boot && heard.number > state.done;
  }
  void drive(const Trip& heard) {
    trip = heard, step = 0, is_driving = true, rests = false;
    next_step(FP_OK);
  }
  // A step that is refused ends the trip.
  void next_step(int32_t result) {
    if (result == FP_OK && step > 0 && step <= trip.lane_count) state.station = lane(trip.lanes[step - 1]).to;
    if (result == FP_OK) result = begin(step++);
    if (result == FP_OK) return;
    is_driving = false, state.done = trip.number;
    rest();
  }
  int32_t begin(uint32_t number) {
    if (number < trip.lane_count) {
      const fp_lane& next = lane(trip.lanes[number]);
      return host->move(self, next.segment | (next.backward != 0 ? FP_BACKWARD : 0));
    }
    if (number > trip.lane_count || trip.at_end == FP_NONE) return FP_REFUSED;  // there is no such step
    return trip.at_end == FP_CALL_PICK ? host->pick_load(self, FP_HERE, trip.order) : host->drop(self, FP_HERE);
  }
};

struct Order {
  uint32_t id, from, to;
};

struct Server : Participant {
  std::vector<State> fleet;                       // where each rested last; server 0: it has not answered this server
  Lanes stood_at;                                 // the stations of the AGVs for which `ways` holds
  std::vector<Lanes> ways;                        // by AGV and station: the last lane of its way to there
  std::vector<Order> orders;                      // oldest first
  Trip trip;                                      // the last one
  uint32_t driver = FP_NONE, given_up = FP_NONE;  // who has the token; from whom an impatient server has taken it
  int64_t given_at_ns = 0;

  Server(const fp_host* h, fp_controller* s, const fp_briefing* b) : Participant(h, s, b), fleet(b->fleet_count) {
    trip.server = briefing->boot + 1;
  }
  void on_event(const fp_event& event) override {
    if (event.kind == FP_EVENT_WITHDRAWN) return;  // the pick will be refused, and that ends the order
    if (event.kind == FP_EVENT_START) again_ns = now_ns + kTick_ns;
    if (event.kind == FP_EVENT_ORDER) orders.push_back({event.order_id, event.from, event.to});
    uint32_t agv = 0;
    for (State said; event.kind == FP_EVENT_MESSAGE && read(agv, said);) {
      hear(agv, said);
      go_on();
    }
    if (event.kind != FP_EVENT_MESSAGE) go_on();
    wait_until_again();
  }
  void go_on() {
    const bool is_late = driver != FP_NONE && now_ns - given_at_ns > kPatience_ns;
    if (is_late && std::string_view(briefing->config) == "impatient") given_up = driver, driver = FP_NONE;
    if (now_ns >= again_ns) {
      again_ns = now_ns + kTick_ns;
      if (driver != FP_NONE) send(trip, driver, text_of(trip, "again, ").c_str());
    }
    if (driver == FP_NONE) plan();
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
  void plan() {
    const auto has_answered = [](const State& agv) { return agv.server != 0; };
    if (orders.empty() || !std::all_of(fleet.begin(), fleet.end(), has_answered)) return;
    find_ways();
    const auto goes = [&](const Order& order) { return carry_out(order); };
    if (std::any_of(orders.begin(), orders.end(), goes)) return;
    const uint32_t agv = host->random(self, 0, now_ns) % fleet.size();
    Lanes away = ways[agv];
    std::erase_if(away, [&](uint32_t i) { return i == FP_NONE || lane(i).from != fleet[agv].station; });
    if (!away.empty()) give_token(agv, {away[host->random(self, 1, now_ns) % away.size()]}, FP_NONE, FP_NONE);
  }
  bool carry_out(const Order& order) {
    const auto carries = [&](const State& agv) { return agv.load == order.id; };
    const bool is_on_board = std::any_of(fleet.begin(), fleet.end(), carries);
    uint32_t best = FP_NONE;
    Lanes best_way, way;
    for (uint32_t agv = 0; agv < fleet.size(); ++agv) {
      if (agv == given_up || fleet[agv].load != (is_on_board ? order.id : FP_NONE)) continue;
      if (!find_way(agv, is_on_board ? order.to : order.from, way)) continue;
      if (best == FP_NONE || way.size() < best_way.size()) best = agv, best_way = way;
    }
    if (best != FP_NONE) give_token(best, best_way, is_on_board ? FP_CALL_DROP : FP_CALL_PICK, order.id);
    return best != FP_NONE;
  }
  // For people who look at a trace: what stands before ": " is the kind of the message.
  std::string text_of(const Trip& of, const char* repeated = "") const {
    const char* end = of.at_end == FP_CALL_PICK ? ", pick" : of.at_end == FP_CALL_DROP ? ", drop" : "";
    return "TRIP: " + (repeated + std::to_string(of.lane_count)) + " lanes" + end;
  }
  void give_token(uint32_t agv, const Lanes& way, uint32_t at_end, uint32_t order) {
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
  // Its answers change only when an AGV stands elsewhere.
  void find_ways() {
    Lanes stations;
    for (const State& known : fleet) stations.push_back(known.station);
    if (std::exchange(stood_at, stations) == stations) return;
    ways.clear();
    for (uint32_t agv = 0; agv < fleet.size(); ++agv) ways.push_back(ways_of(agv));
  }
  // By the fewest lanes.
  Lanes ways_of(uint32_t agv) const {
    const Lanes free = free_lanes(agv);
    Lanes last(briefing->map->station_count, FP_NONE), reached{fleet[agv].station};
    for (size_t k = 0; k < reached.size(); ++k) {
      for (const uint32_t i : free) {
        const uint32_t to = lane(i).to;
        if (lane(i).from != reached[k] || to == reached[0] || last[to] != FP_NONE) continue;
        last[to] = i;
        reached.push_back(to);
      }
    }
    return last;
  }
  bool find_way(uint32_t agv, uint32_t to, Lanes& way) const {
    way.clear();
    uint32_t at = to;
    for (; at != fleet[agv].station && ways[agv][at] != FP_NONE; at = lane(way.back()).from)
      way.push_back(ways[agv][at]);
    std::reverse(way.begin(), way.end());
    return at == fleet[agv].station;
  }
};

static void* create(const fp_host* host, fp_controller* self, const fp_briefing* briefing) {
  if (briefing->role == FP_COMPUTER) return static_cast<Participant*>(new Server(host, self, briefing));
  return static_cast<Participant*>(new Agv(host, self, briefing));
}
static void on_event(void* agent, const fp_event* event) { static_cast<Participant*>(agent)->receive(*event); }
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
