#include "generators/scenario_file/validator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "core/scenario/draw_numbers.hpp"
#include "core/scenario/lane_rules.hpp"
#include "core/scenario/scenario.hpp"
#include "core/scenario/scenario_fields.hpp"
#include "generators/map/core_only.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/map/problem.hpp"
#include "generators/scenario_file/exempt_pairs.hpp"
#include "generators/scenario_file/field_rules.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

class ScriptCheck {
 public:
  ScriptCheck(const Scenario& scenario, std::size_t agv, Problems& problems)
      : map_(*scenario.map),
        agv_(scenario.agvs[agv]),
        type_(agv_.type < scenario.vehicle_types.size() ? std::string_view(scenario.type_of(agv_).name) : ""),
        place_(fmt::format("/agvs/{}/script", agv)),
        problems_(problems) {}

  void check() {
    Duration last{};
    for (std::size_t k = 0; k < agv_.script.size(); ++k) {
      const ScriptedCall& call = agv_.script[k];
      if (!call.segment.valid())
        call_without_segment(k);
      else if (call.segment.index() >= map_.segment_count())
        add(k, "segment", "there is no such segment");
      else
        call_with_segment(k);
      if (call.at < last)
        problems_.push_back({ProblemKind::NumberOutOfRange, fmt::format("{}/{}/at_ns", place_, k),
                             fmt::format("{} s: calls are listed in order of time", to_seconds(call.at))});
      last = call.at;
    }
  }

 private:
  void add(std::size_t k, std::string_view key, std::string sentence) {
    problems_.push_back({ProblemKind::UnknownReference, fmt::format("{}/{}/{}", place_, k, key), std::move(sentence)});
  }

  // Where a later call begins depends on the run.
  bool starts_here(std::size_t k) const { return k == 0 && agv_.start.index() < map_.station_count(); }

  void call_without_segment(std::size_t k) {
    const ScriptedCall& call = agv_.script[k];
    if (call.action == ScriptedCall::Action::Move)
      return add(k, "action",
                 "a move needs a segment; name it (only pick, drop, park and charge may leave it out: then the AGV "
                 "does them where it stands)");
    if (call.backward)
      add(k, "backward", "without a segment the AGV does not drive; leave backward out, or name the segment");
    if (!starts_here(k) || LaneRules{map_, type_}.may_stay(agv_.start, agv_.heading)) return;
    const Station& station = map_.station(agv_.start);
    add(k, "action",
        fmt::format("{} cannot {} at {} with its first heading [{:g}, {:g}]; the station wants [{:g}, {:g}]: start "
                    "with that heading, or name a segment to drive first",
                    in_quotes(agv_.name), name_of(call.action), in_quotes(station.name), agv_.heading.x(),
                    agv_.heading.y(), station.heading->x(), station.heading->y()));
  }

  void call_with_segment(std::size_t k) {
    const ScriptedCall& call = agv_.script[k];
    const Segment& segment = map_.segment(call.segment);
    if (!call.backward) return;
    const bool first = starts_here(k) && (agv_.start == segment.from || agv_.start == segment.to);
    const bool there = map_.backward_lane(call.segment, segment.from) != nullptr,
               back = map_.backward_lane(call.segment, segment.to) != nullptr;
    if (first ? (agv_.start == segment.from ? there : back) : there || back) return;
    add(k, "backward",
        fmt::format("{} cannot drive segment {} backward{}; leave backward out, or set {} of the segment to backward "
                    "or either",
                    in_quotes(agv_.name), in_quotes(segment.name),
                    first ? " from " + in_quotes(map_.station(agv_.start).name) : "",
                    first && agv_.start == segment.to ? "back_travel" : "travel"));
  }

  const LogicalMap& map_;
  const AgvSetup& agv_;
  std::string_view type_;
  std::string place_;
  Problems& problems_;
};

// What an AGV cannot do of its script, whatever happens in the run. Only of the first call it is known where the AGV
// is.
void check_script(const Scenario& scenario, std::size_t agv, Problems& problems) {
  ScriptCheck(scenario, agv, problems).check();
}

constexpr std::size_t kMostNames = 20;

// The way from the scenario to a field. It is turned into a JSON pointer only when there is something to say.
struct Place {
  const Place* outer = nullptr;
  std::string_view key;               // in the object that `outer` names
  std::optional<std::size_t> number;  // of an item in the array that `outer` names

  std::string pointer() const {
    if (outer == nullptr) return {};
    return number ? fmt::format("{}/{}", outer->pointer(), *number) : fmt::format("{}/{}", outer->pointer(), key);
  }
};

// Bounds of all fields, by their lists.
class BoundsCheck {
 public:
  explicit BoundsCheck(Problems& problems) : problems_(problems) {}

  template <HasFields Setup>
  void fields(const Setup& setup, const Place& place) {
    visit_fields(setup, [&](const Field& field, const auto& value) {
      if (!field.left_out) check(field, value, {&place, field.scenario_place(), {}});
    });
  }

 private:
  template <class Value>
  void check(const Field& field, const Value& value, const Place& place) {
    if constexpr (std::is_same_v<Value, Duration>) {
      const auto fault = fault_of(field, value);
      if (fault.empty()) return;
      const std::string pointer = place.pointer();
      add(pointer.substr(0, pointer.size() - 1) + "ns", fault);
    } else if constexpr (NumberValue<Value>) {
      demand(fault_of(field, value), place);
    } else if constexpr (HasFields<Value>) {
      fields(value, place);
    } else if constexpr (std::is_same_v<Value, Vec2>) {
      for (const double coordinate : {value.x(), value.y()}) demand(fault_of(field, coordinate), place);
    } else if constexpr (std::is_same_v<Value, std::optional<Vec2>>) {
      check(field, *value, place);
    } else {
      other(value, place);
    }
  }
  template <HasFields Item>
  void other(const std::vector<Item>& items, const Place& place) {
    for (std::size_t i = 0; i < items.size(); ++i) fields(items[i], {&place, {}, i});
  }
  void other(const Direction<const Vec2>& direction, const Place& place) {
    const Vec2& h = direction.vector;
    if (std::abs(h.squaredNorm() - 1.0) <= kUnitVector) return;
    demand(fmt::format("[{}, {}] is not a direction; a heading is a unit vector", h.x(), h.y()), place);
  }
  template <class Value>
  void other(const Value&, const Place&) {}  // words, texts, references and lists of them have no bounds

  void demand(std::string fault, const Place& place) {
    if (!fault.empty()) add(place.pointer(), std::move(fault));
  }
  void add(std::string pointer, std::string sentence) {
    problems_.push_back({ProblemKind::NumberOutOfRange, std::move(pointer), std::move(sentence)});
  }

  Problems& problems_;
};

std::vector<std::string> types_of(const Scenario& scenario) {
  std::vector<std::string> types;
  for (const VehicleType& type : scenario.vehicle_types) types.push_back(type.name);
  return types;
}

// Names, references, and rules between fields.
class MeaningCheck {
 public:
  MeaningCheck(const Scenario& scenario, Problems& problems) : scenario_(scenario), problems_(problems) {}

  void run() {
    if (!is_plain_utf8(scenario_.name))
      add(ProblemKind::BadName, "/name", "a name is UTF-8 without control characters");
    rules("/radio/", rule_faults(scenario_.radio));
    rules("/operator/", rule_faults(scenario_.operator_help));
    for (std::size_t i = 0; i < scenario_.law.exempt_pairs.size(); ++i) exempt_pair(i);
    if (scenario_.vehicle_types.empty())
      add(ProblemKind::UnknownReference, "/vehicle_types", "at least one vehicle type is needed");
    names("/vehicle_types", scenario_.vehicle_types);
    permissions();
    if (scenario_.agvs.empty()) add(ProblemKind::EmptyFleet, "/agvs", "a scenario needs at least one AGV");
    names("/agvs", scenario_.agvs);
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) agv(i);
    for (std::size_t k = 0; k < scenario_.open_orders.size(); ++k)
      transport(fmt::format("/transports/{}", k), scenario_.open_orders[k]);
    computers();
    names("/obstacles", scenario_.obstacles);
    for (std::size_t i = 0; i < scenario_.obstacles.size(); ++i) {
      if (scenario_.obstacles[i].leaves <= scenario_.obstacles[i].appears)
        add(ProblemKind::NumberOutOfRange, fmt::format("/obstacles/{}/leaves_ns", i),
            "an obstacle leaves after it has appeared");
    }
    for (std::size_t i = 0; i < scenario_.faults.size(); ++i) fault(i);
    deliveries();
    draw_numbers();
  }

 private:
  void add(ProblemKind kind, std::string pointer, std::string sentence) {
    problems_.push_back({kind, std::move(pointer), std::move(sentence)});
  }

  void rules(std::string_view object, const std::vector<FieldFault>& faults) {
    for (const auto& [key, sentence] : faults)
      add(ProblemKind::NumberOutOfRange, fmt::format("{}{}", object, key), sentence);
  }

  void exempt_pair(std::size_t i) {
    std::vector<std::string> types;
    for (const VehicleType& type : scenario_.vehicle_types) types.push_back(type.name);
    const auto fault = fault_of_exempt_pair(scenario_.law.exempt_pairs[i], types);
    if (!fault.empty()) add(ProblemKind::UnknownReference, fmt::format("/law/exempt_pairs/{}", i), fault);
  }

  template <class Named>
  void names(std::string_view list, const std::vector<Named>& all) {
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto pointer = [&] { return fmt::format("{}/{}/name", list, i); };
      if (const char* fault = fault_of_name(all[i].name)) add(ProblemKind::BadName, pointer(), fault);
      if (!seen.insert(all[i].name).second)
        add(ProblemKind::BadName, pointer(),
            fmt::format("the name {} is taken; choose another", in_quotes(all[i].name)));
    }
  }

  void fault(std::size_t i) {
    const Fault& f = scenario_.faults[i];
    if (!f.agv.valid()) return fault_of_open_order(i);
    if (f.agv >= scenario_.first_obstacle())
      return add(ProblemKind::UnknownReference, fmt::format("/faults/{}/agv", i), "there is no such AGV or computer");
    const char* why_not = f.kind == Fault::Kind::Named ? fault_of_name(f.word) : nullptr;
    if (why_not != nullptr) add(ProblemKind::BadName, fmt::format("/faults/{}/word", i), why_not);
    if (scenario_.is_computer(f.agv)) return fault_of_computer(i);
    const AgvSetup& agv = scenario_.agvs[f.agv.index()];
    if (!f.transport || *f.transport < agv.transports.size()) return;
    add(ProblemKind::UnknownReference, fmt::format("/faults/{}/transport", i),
        fmt::format("{} has {} transports; they count from 0", in_quotes(agv.name), agv.transports.size()));
  }

  void fault_of_open_order(std::size_t i) {
    const Fault& f = scenario_.faults[i];
    if (!f.transport)
      return add(ProblemKind::UnknownReference, fmt::format("/faults/{}/agv", i),
                 "a fault names an AGV, a computer or an open transport; give it agv or transport");
    if (*f.transport < scenario_.open_orders.size()) return;
    add(ProblemKind::UnknownReference, fmt::format("/faults/{}/transport", i),
        fmt::format("there are {} open transports; they count from 0", scenario_.open_orders.size()));
  }

  void fault_of_computer(std::size_t i) {
    const Fault& f = scenario_.faults[i];
    const std::string name = in_quotes(scenario_.name_of(f.agv));
    if (!strikes_computers(f.kind)) {
      std::vector<std::string> kinds;
      for (const Fault::Kind kind : kValuesOf<Fault::Kind>) {
        if (strikes_computers(kind)) kinds.emplace_back(name_of(kind));
      }
      add(ProblemKind::UnknownReference, fmt::format("/faults/{}/kind", i),
          fmt::format("{} is a computer and has no {}; choose {}", name, name_of(f.kind),
                      name_list(kinds, kMostNames)));
    }
    if (f.transport)
      add(ProblemKind::UnknownReference, fmt::format("/faults/{}/transport", i),
          name + " is a computer and carries nothing; leave transport out");
  }

  // Files name AGVs and computers by one name.
  void computers() {
    names("/computers", scenario_.computers);
    if (scenario_.computers.size() > kMostComputers)
      add(ProblemKind::NumberOutOfRange, "/computers",
          fmt::format("{} computers are too many; use at most {}", scenario_.computers.size(), kMostComputers));
    for (std::size_t i = 0; i < scenario_.computers.size(); ++i) {
      const std::string& name = scenario_.computers[i].name;
      if (std::ranges::find(scenario_.agvs, name, &AgvSetup::name) != scenario_.agvs.end())
        add(ProblemKind::BadName, fmt::format("/computers/{}/name", i),
            fmt::format("an AGV has the name {}; choose another", in_quotes(name)));
    }
  }

  void deliveries() {
    std::set<std::tuple<AgvId, AgvId, Duration, std::uint32_t>> seen;
    for (std::size_t i = 0; i < scenario_.deliveries.size(); ++i) {
      const GivenDelivery& delivery = scenario_.deliveries[i];
      const auto bad = [&](std::string_view key, const char* sentence) {
        add(ProblemKind::UnknownReference, fmt::format("/fates/{}{}", i, key), sentence);
      };
      if (delivery.sender >= scenario_.first_obstacle()) bad("/sender", "there is no such AGV or computer");
      if (delivery.receiver >= scenario_.first_obstacle()) bad("/receiver", "there is no such AGV or computer");
      if (delivery.sender == delivery.receiver) bad("/receiver", "nobody sends to itself; name another receiver");
      if (scenario_.is_computer(delivery.sender) && scenario_.is_computer(delivery.receiver))
        bad("", "between two computers is a wire: it loses nothing, and all takes wire/takes_s; leave this fate out");
      if (!seen.emplace(delivery.sender, delivery.receiver, delivery.sent, delivery.ordinal).second)
        bad("", "this message has a delivery already; give each message one");
    }
  }

  void draw_numbers() {
    constexpr std::size_t kMostNumbers = DrawNumbers::kLast + 1;
    const DrawNumbers numbers(scenario_);
    if (scenario_.participant_count() > kMostNumbers)
      return add(ProblemKind::NumberOutOfRange, "/agvs",
                 fmt::format("{} AGVs are too many: what is random about messages is drawn by numbers, of which there "
                             "are {}; use fewer AGVs",
                             scenario_.agvs.size(), kMostNumbers - scenario_.computers.size()));
    std::map<EntityId, std::size_t> seen;
    for (std::size_t i = 0; i < scenario_.participant_count(); ++i) {
      const auto [other, is_new] = seen.emplace(numbers.of(EntityId{i}), i);
      if (is_new) continue;
      const std::size_t at = has_own_number(i) ? i : other->second;
      add(ProblemKind::NumberOutOfRange, draws_as_pointer(at),
          fmt::format("{} draws under this number, too; give each its own",
                      in_quotes(scenario_.name_of(EntityId{at == i ? other->second : i}))));
    }
  }
  bool has_own_number(std::size_t i) const {
    const bool is_agv = scenario_.is_agv(EntityId{i});
    return (is_agv ? scenario_.agvs[i].draws_as : scenario_.computer(EntityId{i}).draws_as).has_value();
  }
  std::string draws_as_pointer(std::size_t i) const {
    const std::size_t agvs = scenario_.agvs.size();
    return i < agvs ? fmt::format("/agvs/{}/draws_as", i) : fmt::format("/computers/{}/draws_as", i - agvs);
  }

  // A type that is spelled nearly like one of the fleet: a mistake. Any other may belong to a fleet that is not here.
  void permissions() {
    const auto fleet = types_of(scenario_);
    for (const auto& type : foreign_types(scenario_.map->layout(), fleet)) {
      if (type.meant.empty()) continue;
      add(ProblemKind::UnknownReference,
          fmt::format("/layout/segments/{}/permissions/{}/vehicle_type", type.segment, type.permission),
          sentence_on(type, scenario_.map->layout(), fleet));
    }
  }

  bool has_station(StationId id) const { return id.index() < scenario_.map->station_count(); }

  void agv(std::size_t i) {
    const auto& a = scenario_.agvs[i];
    const auto unknown = [&](std::string_view key, const char* sentence) {
      add(ProblemKind::UnknownReference, fmt::format("/agvs/{}/{}", i, key), sentence);
    };
    if (a.type >= scenario_.vehicle_types.size()) unknown("type", "there is no such vehicle type");
    if (!has_station(a.start)) unknown("start", "there is no such station");
    for (std::size_t k = 0; k < a.transports.size(); ++k)
      transport(fmt::format("/agvs/{}/transports/{}", i, k), a.transports[k]);
    check_script(scenario_, i, problems_);
  }

  void transport(const std::string& place, const TransportOrder& order) {
    const auto unknown = [&](std::string_view key, const char* sentence) {
      add(ProblemKind::UnknownReference, fmt::format("{}/{}", place, key), sentence);
    };
    if (!has_station(order.from)) unknown("from", "there is no such station");
    if (!has_station(order.to)) unknown("to", "there is no such station");
    if (order.from == order.to) unknown("to", "a transport leads to another station than it comes from");
    if (order.withdrawn < order.release)
      add(ProblemKind::NumberOutOfRange, place + "/withdrawn_ns",
          fmt::format("{:g} s: a transport is withdrawn after its release, which is at {:g} s",
                      to_seconds(order.withdrawn), to_seconds(order.release)));
  }

  const Scenario& scenario_;
  Problems& problems_;
};

class WorldCheck {
 public:
  WorldCheck(const Scenario& scenario, const Reachability& reachability)
      : scenario_(scenario), reachability_(reachability) {}

  Problems run() {
    if (reachability_.core_share() < kSmallestCoreShare) {
      const bool rules = has_rules(scenario_.map->layout());
      add(ProblemKind::WeakCore, "/layout",
          fmt::format("only {}, less than 90 %; {}",
                      rules ? core_under_rules() : reachability_text(scenario_.map->layout()),
                      rules ? remedy_under_rules() : remedy_without_rules()));
    }
    starts();
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) transports(i);
    open_transports();
    return std::move(problems_);
  }

 private:
  void add(ProblemKind kind, std::string pointer, std::string sentence) {
    problems_.push_back({kind, std::move(pointer), std::move(sentence)});
  }

  std::string remedy_without_rules() const {
    return reachability_.core().size() < 2 ? "no two stations can reach each other; add segments that lead back"
                                           : "add segments that lead back, or leave these stations out (core_only)";
  }

  // Where more ways lead back if a rule is lifted, the rule is the cause.
  std::string remedy_under_rules() const {
    const std::size_t of_all_types = Reachability(*scenario_.map).core().size(), all = scenario_.map->station_count();
    const bool strong = static_cast<double>(of_all_types) >= kSmallestCoreShare * static_cast<double>(all);
    const std::string lift = "give the fleet the types that the segments are for, or lift these permissions (any_type)";
    if (of_all_types > reachability_.core().size())
      return lift + (strong ? ""
                            : fmt::format("; then {} of {} stations remain, and core_only leaves the others out",
                                          of_all_types, all));
    const std::size_t by_segments = strong_core_size(scenario_.map->layout());
    return by_segments > of_all_types ? "turns, headings, loads or the end that goes first keep AGVs from ways that "
                                        "lead back; lift such rules, "
                                        "or leave these stations out (core_only)"
                                      : remedy_without_rules();
  }

  // By the segments alone.
  static std::size_t strong_core_size(const Layout& layout) {
    std::vector<Arrow> arrows;
    for (const auto& segment : layout.segments) {
      arrows.push_back({segment.from.value, segment.to.value});
      if (segment.bidirectional) arrows.push_back({segment.to.value, segment.from.value});
    }
    return strong_components(layout.stations.size(), arrows).largest_size;
  }

  std::string core_under_rules() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario_.map->station_count(); ++i) {
      if (!reachability_.in_core(StationId{i})) names.push_back(scenario_.map->station(StationId{i}).name);
    }
    return fmt::format(
        "{} of {} stations can be reached and left by what the layout permits the vehicle types of this fleet (turns, "
        "headings, loads and types{}); cut off: {}",
        reachability_.core().size(), scenario_.map->station_count(),
        foreign_types_hint(scenario_.map->layout(), types_of(scenario_)), name_list(names, kMostNames));
  }

  void starts() {
    const double distance_m = scenario_.law.safety_distance_m;
    std::vector<OrientedRectangle> bodies;
    for (const auto& agv : scenario_.agvs) bodies.push_back(start_body(scenario_, agv));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto& agv = scenario_.agvs[i];
      const auto pointer = [&] { return fmt::format("/agvs/{}/start", i); };
      for (std::size_t k = 0; k < i; ++k) {
        if (!closer_than(bodies[k], bodies[i], distance_m)) continue;
        add(ProblemKind::StartsTooClose, pointer(),
            fmt::format("{} starts closer than {} m to {}{}; choose another start", in_quotes(agv.name), distance_m,
                        in_quotes(scenario_.agvs[k].name), with_load(agv, scenario_.agvs[k])));
      }
      for (const auto& obstacle : scenario_.obstacles) {
        if (obstacle.appears > Duration::zero() ||
            !closer_than(placed(obstacle.footprint, obstacle.pose), bodies[i], distance_m))
          continue;
        add(ProblemKind::StartNearObstacle, pointer(),
            fmt::format("{} starts closer than {} m to obstacle {}{}; move one", in_quotes(agv.name), distance_m,
                        in_quotes(obstacle.name), with_load(agv, agv)));
      }
      const LaneRules rules{*scenario_.map, scenario_.type_of(agv).name, false};
      const auto& lanes = scenario_.map->lanes_from(agv.start);
      if (std::ranges::none_of(
              lanes, [&](std::uint32_t lane) { return rules.may_drive(scenario_.map->lanes()[lane], agv.heading); })) {
        add(ProblemKind::StartWithoutLane, pointer(),
            fmt::format("no lane leaves the station where {} starts{}", in_quotes(agv.name),
                        lanes.empty() ? std::string()
                                      : ", by what the layout allows it: permissions, and turns on the spot" +
                                            foreign_types_hint(scenario_.map->layout(), types_of(scenario_))));
      }
    }
  }

  // If a load makes one of the bodies larger, the error says that the bodies were measured with their loads.
  std::string_view with_load(const AgvSetup& one, const AgvSetup& other) const {
    const auto grows = [&](const AgvSetup& agv) {
      const LoadEffect& loaded = scenario_.type_of(agv).loaded;
      return loaded.extra_length_m > 0.0 || loaded.extra_width_m > 0.0;
    };
    return grows(one) || grows(other) ? " once loaded" : "";
  }

  std::string_view loads(bool loaded) const {
    if (!has_rules(scenario_.map->layout())) return "";
    return loaded ? " for an AGV with a load" : " for an AGV without a load";
  }

  void transports(std::size_t i) {
    const auto& agv = scenario_.agvs[i];
    for (std::size_t k = 0; k < agv.transports.size(); ++k) {
      const auto& order = agv.transports[k];
      const auto need = [&](StationId from, StationId to, std::string_view field, bool loaded) {
        if (reachability_.reaches(from, to, loaded, agv.type)) return;
        const auto name = [&](StationId id) { return in_quotes(scenario_.map->station(id).name); };
        add(ProblemKind::Unreachable, fmt::format("/agvs/{}/transports/{}{}", i, k, field),
            fmt::format("no way leads from {} to {}{}{}", name(from), name(to), loads(loaded),
                        foreign_types_hint(scenario_.map->layout(), types_of(scenario_))));
      };
      need(agv.start, order.from, "/from", false);
      need(order.from, order.to, "/to", true);
      need(order.to, order.from, "/from", false);
    }
  }

  // Some AGV must be able to carry it out.
  void open_transports() {
    const auto carries_out = [&](const AgvSetup& agv, const TransportOrder& order) {
      return reachability_.reaches(agv.start, order.from, false, agv.type) &&
             reachability_.reaches(order.from, order.to, true, agv.type) &&
             reachability_.reaches(order.to, order.from, false, agv.type);
    };
    for (std::size_t k = 0; k < scenario_.open_orders.size(); ++k) {
      const TransportOrder& order = scenario_.open_orders[k];
      if (std::ranges::any_of(scenario_.agvs, [&](const AgvSetup& agv) { return carries_out(agv, order); })) continue;
      add(ProblemKind::Unreachable, fmt::format("/transports/{}/from", k),
          fmt::format("no AGV of the fleet can fetch the load at {} and bring it to {}{}; choose other stations",
                      in_quotes(scenario_.map->station(order.from).name),
                      in_quotes(scenario_.map->station(order.to).name),
                      foreign_types_hint(scenario_.map->layout(), types_of(scenario_))));
    }
  }

  const Scenario& scenario_;
  const Reachability& reachability_;
  Problems problems_;
};

}  // namespace

Problems unusable_problems(const Scenario& scenario) {
  ensure(scenario.map != nullptr, "a scenario has a map");
  Problems problems;
  BoundsCheck(problems).fields(scenario, Place{});
  MeaningCheck(scenario, problems).run();
  return problems;
}

Problems world_problems(const Scenario& scenario, const Reachability& reachability) {
  return WorldCheck(scenario, reachability).run();
}

Problems problems_of(const Scenario& scenario) {
  const auto types = types_of(scenario);
  auto problems = unusable_problems(scenario);
  if (problems.empty()) problems = world_problems(scenario, Reachability(*scenario.map, types));
  return problems;
}

bool closer_than(const OrientedRectangle& a, const OrientedRectangle& b, double distance_m) {
  // Most pairs are far apart and need no exact distance.
  const double reach = a.half_length_m + a.half_width_m + b.half_length_m + b.half_width_m + distance_m;
  if ((a.centre_m - b.centre_m).squaredNorm() > reach * reach) return false;
  return clearance_m(a, b) < distance_m - kBuiltToTheLimit_m;
}

OrientedRectangle start_body(const Scenario& scenario, const AgvSetup& agv) {
  const Footprint largest = scenario.type_of(agv).footprint_with(true);
  return placed(largest, {scenario.map->station(agv.start).position_m, agv.heading});
}

}  // namespace fleetproof
