// A central fleet in one source, as straight-line code: the twin of depot.cpp, with the same calls in the same order.
// The server hears the open orders and lets one AGV drive at a time, by a way on which it meets no AGV that stands. The
// right to drive is a token: a TRIP gives it, and the STATE of an AGV that rests again gives it back. With the
// parameter "impatient", a FAULT, the server gives the token to another AGV after 3 s of silence.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fleetproof/blocking.hpp"

using namespace std::chrono_literals;
using namespace fleetproof::blocking;

using Lanes = std::vector<uint32_t>;
constexpr uint32_t kLanesMax = 200;
constexpr Duration kTick = 1s, kPatience = 3s;

namespace {

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
  Controller& self;
  const fp_briefing& briefing;

  explicit Participant(Controller& controller) : self(controller), briefing(controller.briefing()) {}
  const fp_lane& lane(uint32_t number) const { return *fp_lane_at(briefing.map, number); }
  template <class Content>
  void send(const Content& content, uint32_t receiver, const char* kind) const {
    self.call(&fp_host::describe, kind);
    self.send(content, receiver);
  }
};

struct Agv : Participant {
  using Participant::Participant;
  State state;

  void run() {
    find_out_where();
    while (true) {
      self.wait_until_rest();  // at first, an action of its former self may be under way; after a contact, for ever
      const Trip trip = wait_for_trip();
      drive(trip);
      state.done = trip.number;
    }
  }
  void find_out_where() {
    state.agv_boot = briefing.boot, state.station = briefing.start_station;
    if (briefing.start_segment == FP_NONE) return;
    for (uint32_t i = 0; i < briefing.map->lane_count; ++i) {  // it is on the way to the end of this one
      const bool is_it = lane(i).segment == (briefing.start_segment & ~FP_BACKWARD);
      if (is_it && lane(i).from == briefing.start_station) state.station = lane(i).to;
    }
  }
  // What came before it rested counts as lost: whatever is still true is said again.
  Trip wait_for_trip() {
    while (self.get_message()) continue;
    while (true) {
      say_state();
      const auto message = self.wait_message(kTick);
      const auto heard = message ? message->as<Trip>() : std::nullopt;
      if (heard && is_new(*heard)) return *heard;
    }
  }
  void say_state() {
    state.load = self.order_on_board();
    send(state, briefing.fleet_count, "STATE");
  }
  bool is_new(const Trip& heard) {
    if (heard.server > state.server) state.server = heard.server, state.done = 0;
    return heard.server == state.server && heard.agv_boot == state.agv_boot && heard.number > state.done;
  }
  // A step that is refused ends the trip.
  void drive(const Trip& trip) {
    for (uint32_t step = 0; step < trip.lane_count; ++step) {
      const fp_lane& next = lane(trip.lanes[step]);
      if (self.move(next.segment | (next.backward != 0 ? FP_BACKWARD : 0)) != FP_OK) return;
      state.station = next.to;
    }
    if (trip.at_end == FP_CALL_PICK) self.pick_load(FP_HERE, trip.order);
    if (trip.at_end == FP_CALL_DROP) self.drop(FP_HERE);
  }
};

struct Server : Participant {
  std::vector<State> fleet;                       // where each rested last; server 0: it has not answered this server
  Lanes stood_at;                                 // the stations of the AGVs for which `ways` holds
  std::vector<Lanes> ways;                        // by AGV and station: the last lane of its way to there
  std::vector<Order> orders;                      // oldest first
  Trip trip;                                      // the last one
  uint32_t driver = FP_NONE, given_up = FP_NONE;  // who has the token; from whom an impatient server has taken it
  Duration given_at = 0s;

  explicit Server(Controller& controller) : Participant(controller), fleet(briefing.fleet_count) {
    trip.server = briefing.boot + 1;
  }
  void run() {
    Duration again = self.now() + kTick;
    while (true) {
      const Event event = self.wait(kOrder | kMessage, again - self.now());
      if (event.kind == kOrder) orders.push_back(event.order());
      if (event.kind == kMessage) hear(event.message.sender, event.message.as<State>().value_or(State()));
      const bool is_late = driver != FP_NONE && self.now() - given_at > kPatience;
      if (is_late && std::string_view(briefing.config) == "impatient") given_up = driver, driver = FP_NONE;
      if (self.now() >= again) {
        again = self.now() + kTick;
        if (driver != FP_NONE) send(trip, driver, text_of(trip, "again, ").c_str());
      }
      if (driver == FP_NONE) plan();
    }
  }
  void hear(uint32_t agv, const State& said) {
    if (said.server != trip.server) return greet(agv);
    State& known = fleet[agv];
    const bool is_old = said.agv_boot != known.agv_boot ? said.agv_boot < known.agv_boot : said.done < known.done;
    const bool has_ended = said.done == trip.number, has_restarted = said.agv_boot > trip.agv_boot;
    if (is_old || (agv == driver && !has_ended && !has_restarted)) return;
    if (agv == driver && has_restarted) self.call(&fp_host::sometimes, "driver-restarted");
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
    const uint32_t agv = random(0) % fleet.size();
    Lanes away = ways[agv];
    std::erase_if(away, [&](uint32_t i) { return i == FP_NONE || lane(i).from != fleet[agv].station; });
    if (!away.empty()) give_token(agv, {away[random(1) % away.size()]}, FP_NONE, FP_NONE);
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
    driver = agv, given_at = self.now();
    self.call(&fp_host::works_on, agv, order);
    send(trip, agv, text_of(trip).c_str());
  }
  uint64_t random(uint32_t purpose) const {
    return self.call(&fp_host::random, purpose, static_cast<uint64_t>(self.now().count()));
  }
  // On these lanes, the AGV keeps the safety distance from every AGV that stands, whatever their headings and loads.
  Lanes free_lanes(uint32_t agv) const {
    const auto type = [&](uint32_t i) { return fp_agv_at(briefing.fleet, briefing.agv_stride, i)->vehicle_type; };
    Lanes free;
    for (uint32_t i = 0; i < briefing.map->lane_count; ++i) {
      const fp_occupancy drive{sizeof drive, type(agv), FP_ANY_LOAD, i, FP_NONE, 0, 0};
      uint32_t conflicts = 0;
      for (uint32_t other = 0; other < fleet.size() && conflicts == 0; ++other) {
        const fp_occupancy stand{sizeof stand, type(other), FP_ANY_LOAD, FP_NONE, fleet[other].station, 0, 0};
        if (other != agv) self.call(&fp_host::conflict, &drive, &stand, 0.0, &conflicts);
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
    Lanes last(briefing.map->station_count, FP_NONE), reached{fleet[agv].station};
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

void run_depot(Controller& controller) {
  if (controller.briefing().role == FP_COMPUTER) Server(controller).run();
  Agv(controller).run();
}

}  // namespace

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  constexpr uint32_t kFlags = FP_DETERMINISTIC | FP_SERVES_COMPUTERS;
  static const fp_agent_type kDepot = agent_type<run_depot>("depot", "a server lets one AGV drive at a time", kFlags);
  return &kDepot;
}
