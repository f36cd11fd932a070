// A program that speaks lockstep for the agents of a shared object: what a bridge in C or C++ has to do. Written from
// the page on the protocol (core/sdk/lockstep.md).   lockstep_host FILE.so
#include <dlfcn.h>

#include <cstdio>
#include <cstring>
#include <deque>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/sdk/fact_store.hpp"
#include "core/sdk/fleetproof/agent.h"

using Json = nlohmann::json;

namespace {

// ---- words and bytes

std::uint32_t place_of(const std::string& word, std::initializer_list<const char*> words) {
  std::uint32_t place = 0;
  for (const char* known : words) {
    if (word == known) return place;
    ++place;
  }
  throw std::runtime_error("the word " + word + " is unknown");
}
std::int32_t result_in(const Json& answer) {
  constexpr std::int32_t kResults[] = {FP_OK, FP_EMPTY, FP_REFUSED, FP_INVALID, FP_SUSPENDED};
  return kResults[place_of(answer.at("answer"), {"ok", "empty", "refused", "invalid", "suspended"})];
}
std::uint32_t action_of(const Json& word) {
  return place_of(
      word, {"idle", "driving", "turning", "picking", "dropping", "parked", "charging_now", "out_of_order", "stopped"});
}
std::uint32_t load_state_in(const Json& told) { return place_of(told, {"any_load", "empty_only", "loaded_only"}); }
std::uint32_t id_in(const Json& told) { return told.is_null() ? FP_NONE : told.get<std::uint32_t>(); }
Json id_of(std::uint32_t id) { return id == FP_NONE ? Json() : Json(id); }

// One character for each byte, in UTF-8.
std::string text_of(const void* bytes, std::uint32_t size) {
  std::string text;
  for (std::uint32_t i = 0; i < size; ++i) {
    const auto byte = static_cast<const unsigned char*>(bytes)[i];
    if (byte >= 0x80) text += static_cast<char>(0xc0U | byte >> 6U);
    text += static_cast<char>(byte >= 0x80 ? 0x80U | (byte & 0x3fU) : byte);
  }
  return text;
}
std::string bytes_of(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    bytes +=
        byte < 0x80 ? text[i] : static_cast<char>((byte & 3U) << 6U | (static_cast<unsigned char>(text[++i]) & 0x3fU));
  }
  return bytes;
}
std::string hex(std::uint64_t word) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(word));
  return digits;
}
std::uint64_t bits_in(const Json& told) { return std::stoull(told.get<std::string>(), nullptr, 16); }

fp_pose pose_in(const Json& told) { return {told.at(0), told.at(1), told.at(2), told.at(3)}; }

Json line() {
  std::string text;
  return std::getline(std::cin, text) ? Json::parse(text) : Json();
}
void say(const Json& what) { std::cout << what << std::endl; }

// What the host knows of a participant in its activation.
struct Activation {
  Json told;                   // the event
  Json calls = Json::array();  // that were made since the last question
  std::deque<Json> unread;     // messages
  bool has_acted = false;
  std::string bytes;               // of the last message or record
  std::map<Json, Json> conflicts;  // the answers

  void begin(const Json& event) {
    told = event;
    for (Json& message : told.at("messages")) unread.push_back(std::move(message));
    has_acted = false;
  }
  void call(Json made) { calls.push_back(std::move(made)); }
  Json ask(Json made) {
    say({{"calls", std::exchange(calls, Json::array())}, {"ask", std::move(made)}});
    return line();
  }
  // Its result is hardly ever another one: if it is, the event `refused` says so, and the program ends.
  std::int32_t tell(Json made) {
    call(std::move(made));
    return FP_OK;
  }
  std::int32_t result(Json made) { return result_in(ask(std::move(made))); }
  std::int32_t act(Json made) {
    has_acted = true;
    return result(std::move(made));
  }
};

// The type of the header is the host's to define.
Activation& of(fp_controller* c) { return *reinterpret_cast<Activation*>(c); }

// ---- the controller

template <const char* const& kName>
std::int32_t on_segment(fp_controller* c, std::uint32_t segment) {
  return of(c).act({kName, id_of(segment)});
}
constexpr const char *kMove = "move", *kPick = "pick", *kDrop = "drop", *kPark = "park", *kCharge = "charge";

// The event tells what it shows; the call is made all the same, because it takes time.
template <class Value>
std::int32_t look(fp_controller* c, const char* call, const char* member, Value* out, Value (*read)(const Json&)) {
  if (!of(c).told.contains(member)) return of(c).result({call});  // a computer has none
  of(c).call({call});
  *out = read(of(c).told.at(member));
  return FP_OK;
}

// An action of this activation may have changed it.
std::int32_t get_action(fp_controller* c, std::uint32_t* out) {
  if (!of(c).has_acted) return look<std::uint32_t>(c, "get_action", "action", out, action_of);
  const Json answer = of(c).ask({"get_action"});
  const std::int32_t result = result_in(answer);
  if (result == FP_OK) *out = action_of(answer.at("action"));
  return result;
}

std::int32_t get_message(fp_controller* c, fp_message* out) {
  of(c).call({"get_message"});
  if (of(c).unread.empty()) return FP_EMPTY;
  of(c).bytes = bytes_of(of(c).unread.front().at("bytes"));
  out->sender = of(c).unread.front().at("sender");
  of(c).unread.pop_front();
  out->size = static_cast<std::uint32_t>(of(c).bytes.size());
  out->bytes = of(c).bytes.data();
  return FP_OK;
}

std::int32_t recall(fp_controller* c, std::uint32_t record, fp_record* out) {
  const Json answer = of(c).ask({"recall", record});
  const std::int32_t result = result_in(answer);
  if (result != FP_OK) return result;
  of(c).bytes = bytes_of(answer.at("bytes"));
  out->size = static_cast<std::uint32_t>(of(c).bytes.size());
  out->bytes = of(c).bytes.data();
  return FP_OK;
}

Json occupancy(const fp_occupancy& of) {
  constexpr const char* kLoads[] = {"any_load", "empty_only", "loaded_only"};
  Json told{{"vehicle_type", of.vehicle_type}, {"load", kLoads[of.load]}};
  told[of.lane == FP_NONE ? "station" : "lane"] = of.lane == FP_NONE ? of.station : of.lane;
  if (of.heading_x != 0.0 || of.heading_y != 0.0) told["heading"] = {of.heading_x, of.heading_y};
  return told;
}

std::int32_t conflict(fp_controller* c, const fp_occupancy* a, const fp_occupancy* b, double margin_m,
                      std::uint32_t* out) {
  const Json question{"conflict", occupancy(*a), occupancy(*b), margin_m};
  const auto [known, is_new] = of(c).conflicts.try_emplace(question);  // the answer never changes
  if (is_new) known->second = of(c).ask(question);
  const std::int32_t result = result_in(known->second);
  if (result == FP_OK) *out = known->second["conflict"].get<bool>() ? 1 : 0;
  return result;
}

fp_host controller_functions() {
  using C = fp_controller;
  using U32 = std::uint32_t;
  fp_host host{};
  host.struct_size = sizeof host, host.abi_major = FP_ABI_MAJOR, host.abi_minor = FP_ABI_MINOR;
  host.move = on_segment<kMove>, host.pick = on_segment<kPick>, host.drop = on_segment<kDrop>;
  host.park = on_segment<kPark>, host.charge = on_segment<kCharge>;
  host.pick_load = [](C* c, U32 segment, U32 order) { return of(c).act({"pick_load", id_of(segment), order}); };
  host.stop = [](C* c) { return of(c).act({"stop"}); };
  host.go_on = [](C* c) { return of(c).act({"go_on"}); };
  host.send_broadcast = [](C* c, const void* bytes, U32 size) {
    return of(c).tell({"send_broadcast", text_of(bytes, size)});
  };
  host.send_unicast = [](C* c, const void* bytes, U32 size, U32 receiver) {
    return of(c).tell({"send_unicast", text_of(bytes, size), receiver});
  };
  host.get_position = [](C* c, fp_pose* out) { return look<fp_pose>(c, "get_position", "pose", out, pose_in); };
  host.get_battery_level = [](C* c, double* out) {
    return look<double>(c, "get_battery_level", "battery_level", out,
                        [](const Json& told) { return told.get<double>(); });
  };
  host.is_loaded = [](C* c, U32* out) {
    return look<U32>(c, "is_loaded", "load", out, [](const Json& told) { return told.is_null() ? 0U : 1U; });
  };
  host.get_load = [](C* c, U32* out) { return look<U32>(c, "get_load", "load", out, id_in); };
  host.get_action = get_action, host.get_message = get_message;
  host.now_ns = [](C* c) {
    of(c).call({"now_ns"});
    return of(c).told.at("now_ns").get<std::int64_t>();
  };
  host.set_timer = [](C* c, U32 timer, std::int64_t at_ns) { return of(c).tell({"set_timer", timer, at_ns}); };
  host.random = [](C* c, U32 purpose, std::uint64_t index) {
    return bits_in(of(c).ask({"random", purpose, hex(index)}).at("value"));
  };
  host.declare_cost_ns = [](C* c, std::int64_t cost_ns) { return of(c).tell({"declare_cost_ns", cost_ns}); };
  host.safe_mode = [](C* c, U32 on) { return of(c).tell({"safe_mode", on != 0}); };
  host.waiting_for = [](C* c, U32 agv) { return of(c).tell({"waiting_for", id_of(agv)}); };
  host.works_on = [](C* c, U32 agv, U32 order) { return of(c).tell({"works_on", agv, id_of(order)}); };
  host.declare_waiting = [](C* c, U32 agv, U32 on) { return of(c).tell({"declare_waiting", agv, id_of(on)}); };
  host.sometimes = [](C* c, const char* probe) { return of(c).tell({"sometimes", probe}); };
  host.log = [](C* c, const char* text) { return of(c).tell({"log", text}); };
  host.keep = [](C* c, U32 record, const void* bytes, U32 size) {
    return of(c).result({"keep", record, text_of(bytes, size)});
  };
  host.recall = recall, host.conflict = conflict;
  host.describe = [](C* c, const char* kind) { of(c).call({"describe", kind}); };
  host.describe_message = [](C* c, const fp_message_fields* fields) {
    Json given;
    for (const auto& [name, text] :
         std::initializer_list<std::pair<const char*, const char*>>{{"kind", fields->kind},
                                                                    {"content", fields->content},
                                                                    {"asks", fields->asks},
                                                                    {"answers", fields->answers},
                                                                    {"about", fields->about}}) {
      if (text != nullptr) given[name] = text;
    }
    of(c).call({"describe", given});
  };
  host.declare_state = [](C* c, const char* state) { of(c).call({"declare_state", state}); };
  host.believe = [](C* c, U32 agv, const fp_pose* at, std::int64_t as_of_ns) {
    of(c).call({"believe", agv, {at->x_m, at->y_m, at->heading_x, at->heading_y}, as_of_ns});
  };
  host.cannot_start = [](C* c, const char* why) { return of(c).result({"fail", false, why}); };
  host.fail = [](C* c, U32 hang, const char* text) { return of(c).result({"fail", hang != 0, text}); };
  return host;
}

// ---- the world of a run

// Map, fleet and names as agent.h has them, from the line `run`.
class World {
 public:
  explicit World(const Json& run)
      : run_(run), orders_(place_of(run.at("orders"), {"assigned", "open"})), seed_(bits_in(run.at("seed"))) {
    for (const Json& agv : run_.at("fleet")) add_agv(agv);
    const Json& map = run_.at("map");
    for (const Json& station : map.at("stations")) add_station(station);
    for (const Json& lane : map.at("lanes")) add_lane(lane);
    for (const Json& block : map.at("blocks"))
      blocks_.push_back({name(block.at("name")), place_of(block.at("kind"), {"one_vehicle", "same_direction"})});
    for (const Json& each : run_.at("vehicle_type_names")) type_names_.push_back(name(each));
    for (const Json& each : run_.at("segment_names")) segment_names_.push_back(name(each));
    for (const Json& each : run_.at("computers")) add_computer(each);
    map_ = {sizeof map_,    count(stations_), count(lanes_), count(segment_names_), sizeof(fp_station), sizeof(fp_lane),
            sizeof(fp_arc), stations_.data(), lanes_.data(), count(blocks_),        sizeof(fp_block),   blocks_.data()};
    facts_ = std::make_unique<fleetproof::FactStore>(map_, fleet_.data(), count(fleet_), sizeof(fp_agv),
                                                     run_.at("safety_distance_m").get<double>());
  }

  // `start`: the event. The configuration is kept with the participant.
  fp_briefing briefing(const Json& start, const std::string& config) const {
    fp_briefing told{};
    told.struct_size = sizeof told, told.self = start.at("self"), told.fleet_count = count(fleet_);
    told.agv_stride = sizeof(fp_agv), told.fleet = fleet_.data(), told.map = &map_;
    told.start_station = id_in(start.at("start_station"));
    told.safety_distance_m = run_.at("safety_distance_m");
    told.radio_range_m = run_.at("radio_range_m").is_null() ? INFINITY : run_.at("radio_range_m").get<double>();
    told.config = config.c_str(), told.boot = start.at("boot");
    told.start_segment = id_in(start.at("start_segment")), told.next_segment = id_in(start.at("next_segment"));
    told.facts = &facts_->facts(), told.role = place_of(start.at("role"), {"agv", "computer"});
    told.computer_count = count(computers_), told.computer_stride = sizeof(fp_computer);
    told.computers = computers_.data(), told.agv_names = agv_names_.data();
    told.vehicle_type_count = count(type_names_), told.vehicle_type_names = type_names_.data();
    told.segment_names = segment_names_.data(), told.orders = orders_, told.seed = seed_;
    return told;
  }

 private:
  // To what rows point; it stays where it is.
  struct Kept {
    std::deque<std::string> names;
    std::deque<std::vector<std::uint32_t>> numbers;
    std::deque<std::vector<fp_arc>> arcs;
    std::deque<std::vector<fp_permission>> permissions;
  };
  template <class Row>
  static std::uint32_t count(const std::vector<Row>& rows) {
    return static_cast<std::uint32_t>(rows.size());
  }
  const char* name(const Json& told) { return kept_.names.emplace_back(told.get<std::string>()).c_str(); }
  // Where the numbers stay.
  const std::uint32_t* numbers(const Json& told) {
    return kept_.numbers.emplace_back(told.get<std::vector<std::uint32_t>>()).data();
  }

  void add_agv(const Json& of) {
    agv_names_.push_back(name(of.at("name")));
    fleet_.push_back({of.at("length_m"), of.at("width_m"), of.at("speed_mps"), of.at("acceleration_mps2"),
                      of.at("deceleration_mps2"), of.at("turn_speed_radps"), of.at("turn_acceleration_radps2"),
                      of.at("turn_deceleration_radps2"), of.at("loaded_length_m"), of.at("loaded_width_m"),
                      of.at("speed_deviation"), of.at("centre_ahead_m"), of.at("reverse_speed_mps"),
                      of.at("vehicle_type")});
  }
  void add_station(const Json& of) {
    std::uint32_t purposes = 0;
    for (const Json& word : of.at("purposes"))
      purposes |= 1U << place_of(word, {"routing", "storage", "charging", "parking"});
    const Json& heading = of.at("heading");
    stations_.push_back(
        {name(of.at("name")), of.at("x_m"), of.at("y_m"), purposes, static_cast<std::uint32_t>(of.at("lanes").size()),
         numbers(of.at("lanes")), of.at("turning_forbidden").get<bool>() ? 1U : 0U,
         heading.is_null() ? 0.0 : heading.at(0).get<double>(), heading.is_null() ? 0.0 : heading.at(1).get<double>()});
  }
  void add_lane(const Json& of) {
    std::vector<fp_arc>& arcs = kept_.arcs.emplace_back();
    for (const Json& arc : of.at("arcs"))
      arcs.push_back({pose_in(arc.at("start")), arc.at("length_m"), arc.at("curvature_per_m")});
    std::vector<fp_permission>& permissions = kept_.permissions.emplace_back();
    for (const Json& each : of.at("permissions"))
      permissions.push_back({id_in(each.at("vehicle_type")), load_state_in(each.at("load"))});
    lanes_.push_back({of.at("segment"), of.at("from"), of.at("to"), of.at("length_m"), count(arcs), arcs.data(),
                      of.at("speed_limit_mps"), of.at("width_m"), static_cast<std::uint32_t>(of.at("blocks").size()),
                      numbers(of.at("blocks")), of.at("backward").get<bool>() ? 1U : 0U, count(permissions),
                      permissions.data()});
  }
  void add_computer(const Json& of) {
    const bool has_antenna = !of.at("x_m").is_null();
    computers_.push_back({name(of.at("name")), has_antenna ? 1U : 0U, has_antenna ? of.at("x_m").get<double>() : 0.0,
                          has_antenna ? of.at("y_m").get<double>() : 0.0});
  }

  Json run_;
  std::uint32_t orders_;
  std::uint64_t seed_;
  Kept kept_;
  std::vector<fp_agv> fleet_;
  std::vector<fp_station> stations_;
  std::vector<fp_lane> lanes_;
  std::vector<fp_block> blocks_;
  std::vector<fp_computer> computers_;
  std::vector<const char*> agv_names_, type_names_, segment_names_;
  fp_map map_{};
  std::unique_ptr<fleetproof::FactStore> facts_;
};

// ---- participants

class Participant {
 public:
  Participant(const fp_agent_type& type, const fp_host& host, const World& world, const Json& start)
      : type_(type), config_(start.at("config")), briefing_(world.briefing(start, config_)) {
    activation_.begin(start);
    agent_ = type_.create(&host, reinterpret_cast<fp_controller*>(&activation_), &briefing_);
  }
  ~Participant() {
    if (agent_ != nullptr) type_.destroy(agent_);
  }
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // The event `start` has begun the activation already.
  void hear(const Json& told) {
    const std::string word = told.at("event");
    if (word == "refused") throw std::runtime_error("a call was refused whose result nobody asked for");
    if (word != "start") activation_.begin(told);
    fp_event event{};
    event.struct_size = sizeof event, event.now_ns = told.at("now_ns");
    event.kind = place_of(word, {"start", "order", "message", "timer", "action_done", "fault", "withdrawn"});
    event.timer = told.value("timer", 0U);
    event.order_id = told.value("order_id", 0U), event.from = told.value("from", 0U), event.to = told.value("to", 0U);
    if (word == "action_done") event.result = told.at("result") == "ok" ? FP_OK : FP_REFUSED;
    if (word == "fault") {
      event.fault_word = word_.assign(told.at("fault_word").get<std::string>()).c_str();
      event.fault_number = told.at("fault_number"), event.fault_length_ns = told.at("fault_length_ns");
    }
    if (agent_ != nullptr) type_.on_event(agent_, &event);
    say({{"calls", std::exchange(activation_.calls, Json::array())}});
  }

 private:
  const fp_agent_type& type_;
  std::string config_, word_;
  fp_briefing briefing_;
  Activation activation_;
  void* agent_ = nullptr;
};

void serve(const fp_agent_type& type) {
  const fp_host host = controller_functions();
  std::unique_ptr<World> world;
  std::map<std::uint32_t, Participant> participants;
  for (Json told = line(); !told.is_null(); told = line()) {
    if (told.contains("hello")) {
      say({{"hello", {{"protocol", 1}, {"name", type.name}, {"deterministic", (type.flags & FP_DETERMINISTIC) != 0}}}});
    } else if (told.contains("run")) {
      world = std::make_unique<World>(told.at("run"));
    } else if (told.contains("bye")) {
      participants.clear();
      say({{"bye", Json::object()}});
    } else if (told.contains("destroy")) {
      participants.erase(told.at("destroy").get<std::uint32_t>());
    } else {
      const std::uint32_t self = told.at("self");
      if (told.at("event") == "start") participants.try_emplace(self, type, host, *world, told);
      participants.at(self).hear(told);
    }
  }
}

}  // namespace

int main(int, char** arguments) {
  void* object = dlopen(arguments[1], RTLD_NOW);
  if (object == nullptr) return std::fprintf(stderr, "%s\n", dlerror()), 2;
  const auto query = reinterpret_cast<fp_agent_query_function>(dlsym(object, FP_AGENT_QUERY_SYMBOL));
  serve(*query(FP_ABI_MAJOR));
}
