#include "generators/formats/lif.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "core/scenario/layout.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/heading.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/formats/lif_left_out.hpp"
#include "generators/formats/lif_spots.hpp"
#include "generators/formats/lif_trajectories.hpp"
#include "generators/formats/lif_travel.hpp"
#include "generators/formats/lif_types.hpp"
#include "generators/formats/opentcs_purposes.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/antiparallel.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

// A layout means something else without them, or nothing.
constexpr std::string_view kNeeded[] = {
    "layouts",    "nodes",      "nodeId",        "nodePosition",       "x",
    "y",          "edges",      "edgeId",        "startNodeId",        "endNodeId",
    "actionType", "knotVector", "controlPoints", "interactionNodeIds", "vehicleTypeId",
    "seriesName", "loaded",     "unloaded"};

bool says_nothing(const std::string& key, const JsonValue& value) {
  return value.shape == JsonValue::Shape::Scalar && std::holds_alternative<std::nullptr_t>(value.scalar) &&
         std::ranges::find(kNeeded, key) == std::end(kNeeded);
}

void drop_nulls(JsonValue& value) {
  std::vector<std::string> keys;
  std::vector<JsonValue> items;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    drop_nulls(value.items[i]);
    if (value.shape == JsonValue::Shape::Object) {
      if (says_nothing(value.keys[i], value.items[i])) continue;
      keys.push_back(std::move(value.keys[i]));
    }
    items.push_back(std::move(value.items[i]));
  }
  value.keys = std::move(keys);
  value.items = std::move(items);
}

// The JSON text of a LIF file. A key whose value is null is taken out: programs write it where they have no value. Keys
// that LIF asks for stay, so that they are refused where they are read.
JsonValue parse_lif_tree(std::string_view text, std::string_view source) {
  auto root = parse_json(text, source);
  drop_nulls(root);
  return root;
}

// The keys of the left and the right side: as two drafts of LIF 2.0 and, between them, VDA 5050 spell them.
constexpr const char* kSides[][2] = {
    {"maximumLeftWidth", "maximumRightWidth"}, {"leftWidth", "rightWidth"}, {"maxLeft", "maxRight"}};

double side_m(const JsonReader& corridor, const char* key) {
  const auto side = corridor.find(key);
  if (side && !(side->number() >= 0.0)) side->refuse("expected a width of 0 m or more");
  return side ? side->number() : 0.0;
}

// How wide the corridors of an edge of LIF are, in metres: the widest of all rules, at most kWidestFloor_m; 0 without a
// corridor. Throws InputError if a width is below 0.
double corridor_width_m(const std::vector<JsonReader>& rules) {
  double widest_m = 0.0;
  for (const JsonReader& rule : rules) {
    const auto corridor = rule.find("corridor");
    if (!corridor) continue;
    for (const auto& [left, right] : kSides)
      widest_m = std::max(widest_m, side_m(*corridor, left) + side_m(*corridor, right));
  }
  return std::min(widest_m, kWidestFloor_m);
}

Purposes purpose_of_action(std::string_view type, const PurposeWords& own) {
  if (const auto said = own.said_of(type)) return *said;
  if (type == "pick" || type == "drop") return Purpose::Storage;
  return type == "startCharging" ? Purposes(Purpose::Charging) : Purposes::from_bits(0);
}

// LIF 1.0 has one list of them, its successor two.
std::vector<JsonReader> actions_of(const JsonReader& rule) {
  std::vector<JsonReader> all;
  for (const char* key : {"actions", "requiredActions", "feasibleActions"}) {
    if (const auto list = rule.find(key)) std::ranges::copy(list->items(), std::back_inserter(all));
  }
  return all;
}

// What AGVs of all types do on a node or edge with these rules.
Purposes purposes_of_actions(const std::vector<JsonReader>& rules, const PurposeWords& own) {
  auto purposes = Purposes::from_bits(0);
  for (const auto& rule : rules) {
    for (const auto& action : actions_of(rule))
      purposes = purposes | purpose_of_action(action.at("actionType").text(), own);
  }
  return purposes;
}

// Whether a rule forbids to pick or to drop there (forbiddenActionTypes).
bool forbid_transfers(const std::vector<JsonReader>& rules) {
  return std::ranges::any_of(rules, [](const JsonReader& rule) {
    const auto forbidden = rule.find("forbiddenActionTypes");
    return forbidden && std::ranges::any_of(forbidden->items(), [](const JsonReader& type) {
             return type.text() == "pick" || type.text() == "drop";
           });
  });
}

struct ChosenLayout {
  JsonReader layout;
  std::set<std::string> elsewhere{};  // ids of the nodes of the other layouts
  std::string sentence{};             // begins with file and line; empty if there was no choice
};

// Those of the file and of all its origins.
std::vector<JsonReader> layouts_of(const JsonReader& root) {
  const auto origins = root.find("origins");
  if (!origins && !root.find("layouts"))
    root.refuse("has neither \"layouts\" nor \"origins\"; expected a file in the Layout Interchange Format (LIF)");
  if (!origins) return root.at("layouts").items();
  std::vector<JsonReader> all;
  if (const auto layouts = root.find("layouts")) all = layouts->items();
  for (const auto& origin : origins->items()) {
    const auto layouts = origin.find("layouts");
    if (layouts) std::ranges::copy(layouts->items(), std::back_inserter(all));
  }
  return all;
}

std::string text_in(const JsonReader& layout, const char* key) {
  const auto found = layout.find(key);
  return found && found->is_text() ? found->text() : "";
}

// `"Hall" (level "2")`
std::string called(const JsonReader& layout) {
  const auto level = text_in(layout, "layoutLevelId");
  return in_quotes(text_in(layout, "layoutId")) + (level.empty() ? "" : fmt::format(" (level {})", in_quotes(level)));
}

// An id is unique, a level is not: what is an id does not count as a level.
std::vector<std::size_t> matching(const std::vector<JsonReader>& all, const std::string& wanted) {
  for (const char* key : {"layoutId", "layoutLevelId"}) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (wanted.empty() || text_in(all[i], key) == wanted) found.push_back(i);
    }
    if (!found.empty()) return found;
  }
  return {};
}

std::size_t place_of_choice(const JsonReader& holder, const std::vector<JsonReader>& all, const std::string& wanted) {
  const auto found = matching(all, wanted);
  if (found.size() == 1) return found[0];
  std::string known;
  for (const JsonReader& layout : all) known += (known.empty() ? "" : ", ") + called(layout);
  if (wanted.empty())
    holder.refuse(
        fmt::format("there are {} layouts; choose one by its id or level (import --level, or level = \"...\" in a "
                    "campaign): {}",
                    all.size(), known));
  const bool by_id = !found.empty() && text_in(all[found[0]], "layoutId") == wanted;
  if (by_id)
    holder.refuse(
        fmt::format("{} layouts have the id {}; ids are unique: rename one", found.size(), in_quotes(wanted)));
  holder.refuse(fmt::format("{} layouts have the id or level {}; choose one of: {}",
                            found.empty() ? "no" : std::to_string(found.size()), in_quotes(wanted), known));
}

// The layout of a LIF file with this layoutId, or if there is none with this layoutLevelId, among the layouts of the
// file and of all its origins. An empty `wanted` is the layout of a file that has one. Throws InputError that lists the
// layouts if none or several match.
ChosenLayout choose_layout(const JsonReader& root, const std::string& wanted) {
  const auto all = layouts_of(root);
  const auto holder = root.find("layouts") ? root.at("layouts") : root.at("origins");
  if (all.empty()) holder.refuse("there is no layout; add one");
  const auto chosen = place_of_choice(holder, all, wanted);
  ChosenLayout found{all[chosen]};
  if (all.size() > 1)
    found.sentence = fmt::format("{}: of {} layouts, {} is read", holder.place(), all.size(), called(all[chosen]));
  for (const auto& other : all) {
    if (&other == &all[chosen]) continue;
    if (const auto nodes = other.find("nodes")) {
      for (const auto& node : nodes->items()) found.elsewhere.insert(node.at("nodeId").text());
    }
  }
  return found;
}

constexpr double kGuideTolerance = 0.02;  // share by which a stored length may be wrong

constexpr Topic kElsewhere{"{0} edges lead to another layout and are left out ({1})"};
constexpr Topic kForNobody{
    "no AGV may drive {0} edges ({1}), because no type of vehicle has a rule at them and at both of their nodes, "
    "with a load or without one; they are left out"};
constexpr Topic kTwoLimits{
    "{0} edges have two speed limits, \"maxSpeed\" and \"maximumSpeed\" ({1}); the lower counts"};
constexpr Topic kNodeElsewhere{"{0} nodes of stations are in another layout and are left out ({1})"};
constexpr Topic kTakenForStorage{
    "no action says what {0} nodes are for, which belong to stations ({1}); they are taken to be for storage"};
constexpr Topic kStationTypes{
    "{0} types of stations say nothing that is known here ({1}); name what they are for (--purposes \"TYPE=storage\")"};
constexpr Topic kWithoutTransfer{
    "no action says what {0} nodes are for, which belong to stations ({1}); they forbid to pick or drop, so AGVs only "
    "pass"};

class LifReader {
 public:
  LifReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
            const ReadChoice& choice)
      : root_(parse_lif_tree(text, source)), source_(source), warnings_(warnings), choice_(choice) {}

  Layout read() {
    auto chosen = choose_layout(JsonReader(root_, source_), choice_.level);
    if (!chosen.sentence.empty()) warnings_.push_back(chosen.sentence);
    ids_.elsewhere = std::move(chosen.elsewhere);
    const JsonReader& layout = chosen.layout;
    layout.read("layoutId", layout_.name);
    layout.read("layoutName", layout_.name);
    for (const auto& node : layout.at("nodes").items()) add_node(node);
    if (layout_.stations.empty()) layout.refuse("the layout is empty: it has no node");
    const auto edges = layout.at("edges").items();
    types_ = LifTypes(nodes_, edges);
    for (const auto& edge : edges) add_edge(edge);
    if (layout_.segments.empty()) layout.refuse("the layout has no edge that can be driven; add some");
    spots_.share_purposes(layout_);
    if (const auto stations = layout.find("stations")) {
      for (const auto& station : stations->items()) note_station(station);
    }
    changed_.tell(warnings_);
    for (const auto& [index, purposes] : purposes_.stated) layout_.stations[index].purposes = purposes;
    note_left_out(JsonReader(root_, source_), layout, choice_.purposes, warnings_);
    note_types(layout);
    spots_.join(layout_, nodes_, warnings_);
    shift_far_plant(layout_, source_, warnings_);
    fit_floor(layout_, kFloorMargin_m);
    refuse_problems(layout);
    note_headings(layout);
    compare_guides(layout);
    reunite_ways_back();
    settle_twins(layout_, choice_.twins, source_, warnings_);
    return std::move(layout_);
  }

 private:
  void warn(const JsonReader& at, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", at.place(), sentence));
  }

  void note_headings(const JsonReader& layout) {
    const auto torn = settle_headings(layout_);
    if (!torn.empty())
      warn(layout, fmt::format("{} nodes ask for a heading with which no edge arrives ({}); it is left out, because an "
                               "AGV stands there as it arrives",
                               torn.size(), name_list(torn)));
  }

  void note_types(const JsonReader& layout) {
    const auto tell = [&](const std::string& sentence) {
      if (!sentence.empty()) warn(layout, sentence);
    };
    tell(types_.sentence());
    for (const auto& sentence : types_.odd_rules()) tell(sentence);
    for (const auto& sentence : rules_.turns.settle(layout_)) tell(sentence);
    if (told_.of_types > 0)
      tell(fmt::format("{} edges have a speed limit for each type of vehicle; the lowest is taken for all",
                       told_.of_types));
    if (!told_.act.empty())
      tell(fmt::format("{} edges have actions to pick, drop or charge ({}); here their end nodes are for that",
                       told_.act.size(), name_list(told_.act)));
    rules_.trajectories.tell(warnings_);
    for (const auto& sentence : rules_.travel.sentences()) tell(sentence);
    if (!told_.torn.empty())
      tell(fmt::format("{} nodes ask each type of vehicle for another heading ({}); here an AGV stands as it arrives",
                       told_.torn.size(), name_list(told_.torn)));
  }

  static std::string name_in(const JsonReader& id, std::set<std::string>& taken) {
    auto name = id.text();
    if (const char* fault = fault_of_name(name)) id.refuse(fault);
    if (!taken.insert(name).second) id.refuse("this id is taken already; rename one");
    return name;
  }

  void add_node(const JsonReader& node) {
    Station station;
    station.name = name_in(node.at("nodeId"), ids_.nodes);
    const auto position = node.at("nodePosition");
    station.position_m = {position.at("x").number(), position.at("y").number()};
    const auto rules = rules_by_type(node);
    station.heading = heading_of(rules, station.name);
    const auto index = layout_.stations.size();
    std::string description;
    if (const auto found = node.find("nodeDescription"); found && found->is_text()) description = found->text();
    if (description.starts_with(kPurposesMark)) {
      if (const auto stated = purposes_of_text(std::string_view(description).substr(kPurposesMark.size())))
        purposes_.stated.emplace(index, *stated);
    }
    stations_.emplace(station.name, StationId{index});
    layout_.stations.push_back(std::move(station));
    nodes_.push_back(node);
    add_purposes(index, purposes_of_actions(rules, choice_.purposes));
  }

  // None: the actions say nothing of what the node is for.
  void add_purposes(std::size_t node, Purposes of_actions) {
    auto& purposes = layout_.stations[node].purposes;
    purposes = purposes | of_actions;
    if (of_actions != Purposes::from_bits(0)) purposes_.by_actions.insert(node);
  }

  // The heading for which all rules ask that ask for any.
  std::optional<Vec2> heading_of(const std::vector<JsonReader>& rules, const std::string& name) {
    std::optional<Vec2> heading;
    for (const auto& rule : rules) {
      const auto theta = rule.find("theta");
      if (!theta) continue;
      if (!(std::abs(theta->number()) <= kLargestHeading_rad)) theta->refuse("expected an angle in radians");
      const Vec2 asked = heading_at(theta->number());
      if (heading && *heading != asked) {
        told_.torn.push_back(name);
        return std::nullopt;
      }
      heading = asked;
    }
    return heading;
  }

  // None: a node of another layout.
  std::optional<StationId> station_in(const JsonReader& id) {
    const auto name = id.text();
    if (const auto found = stations_.find(name); found != stations_.end()) return found->second;
    if (ids_.elsewhere.contains(name)) return std::nullopt;
    std::vector<std::string_view> known;
    for (const auto& station : layout_.stations) known.push_back(station.name);
    const auto nearest = nearest_name(name, known);
    id.refuse(nearest ? fmt::format("there is no such node; did you mean {}?", in_quotes(*nearest))
                      : "there is no such node; add it or correct the id");
  }

  void add_edge(const JsonReader& edge) {
    Segment segment;
    segment.name = name_in(edge.at("edgeId"), ids_.edges);
    const auto from = station_in(edge.at("startNodeId")), to = station_in(edge.at("endNodeId"));
    if (!from || !to) return changed_.add(kElsewhere, edge.place(), segment.name);
    segment.from = *from;
    segment.to = *to;
    const auto types = rules_by_type(edge);
    const auto acts = purposes_of_actions(types, choice_.purposes);
    auto permissions = types_.permissions(edge, nodes_[from->index()], nodes_[to->index()]);
    if (!permissions) return changed_.add(kForNobody, edge.place(), segment.name);
    add_purposes(to->index(), acts);
    if (LifSpots::stays(edge, layout_.stations[from->index()].position_m, layout_.stations[to->index()].position_m)) {
      spots_.add(edge, *from, *to, permissions->empty());
      return rules_.turns.add(edge, *from, *to, false);
    }
    if (*from == *to)
      edge.at("endNodeId").refuse("the edge leads from a node back to itself; put another node on its trajectory");
    types_.count(*permissions);
    segment.permissions = std::move(*permissions);
    rules_.trajectories.bend(types, layout_.stations[from->index()].position_m,
                             layout_.stations[to->index()].position_m, segment);
    limit_speed(types, segment);
    segment.width_m = corridor_width_m(types);
    for (const auto& type : types) {
      const auto guide = type.find("physicalLineGuidedProperty");
      const auto length = guide ? guide->find("length") : std::nullopt;
      if (length) told_.guides.push_back({layout_.segments.size(), length->number()});
    }
    rules_.turns.add(edge, segment.from, segment.to, rules_.travel.add(types, straight_way(segment), segment));
    if (acts.has(Purpose::Storage) || acts.has(Purpose::Charging)) told_.act.push_back(segment.name);
    layout_.segments.push_back(std::move(segment));
    edges_.push_back(edge);
  }

  // None: the segment is curved.
  std::optional<Vec2> straight_way(const Segment& segment) const {
    const Vec2 from_m = layout_.stations[segment.from.index()].position_m,
               way_m = layout_.stations[segment.to.index()].position_m - from_m;
    const Vec2 left = Vec2(-way_m.y(), way_m.x()).normalized();
    const bool is_straight = std::ranges::all_of(segment.control_points_m, [&](const Vec2& point_m) {
      return std::abs((point_m - from_m).dot(left)) <= kSameTrack_m;
    });
    return is_straight ? std::optional(way_m) : std::nullopt;
  }

  // Of all types of vehicles the lowest.
  void limit_speed(const std::vector<JsonReader>& types, Segment& segment) {
    std::vector<double> limits_mps;
    for (const auto& type : types) {
      limits_mps.push_back(std::numeric_limits<double>::infinity());
      for (const char* key : {"maxSpeed", "maximumSpeed"}) {
        const auto limit = type.find(key);
        if (!limit) continue;
        if (!(limit->number() >= kSlowest && limit->number() <= kFastest))
          limit->refuse(fmt::format("expected a speed of {} to {} m/s", kSlowest, kFastest));
        if (std::isfinite(limits_mps.back()) && limits_mps.back() != limit->number())
          changed_.add(kTwoLimits, limit->place(), segment.name);
        limits_mps.back() = std::min(limits_mps.back(), limit->number());
      }
    }
    if (limits_mps.empty()) return;
    const auto [lowest, highest] = std::ranges::minmax(limits_mps);
    if (std::isfinite(lowest)) segment.speed_limit_mps = lowest;
    told_.of_types += lowest < highest ? 1 : 0;
  }

  // A line on the floor may bend where nothing is drawn.
  void compare_guides(const JsonReader& layout) {
    std::vector<std::string> names;
    std::string example;
    for (const auto& [segment, length_m] : told_.guides) {
      const double drawn_m = segment_curve(layout_, layout_.segments[segment]).length_m();
      if (std::abs(length_m - drawn_m) <= kGuideTolerance * drawn_m) continue;
      if (names.empty()) example = fmt::format("{:.3f} m instead of {:.3f} m", length_m, drawn_m);
      names.push_back(layout_.segments[segment].name);
    }
    if (!names.empty())
      warn(layout, fmt::format("{} lines that guide AGVs have another length than is drawn, which counts ({}; the "
                               "first with {}); does the line bend? Then draw it with a trajectory",
                               names.size(), name_list(names), example));
  }

  // What the type of a station says. None: nothing that is known.
  std::optional<Purposes> purposes_of_type(const JsonReader& station) {
    const auto type = station.find("stationType");
    if (!type) return std::nullopt;
    const auto said = purpose_of({.name = type->text(), .operations = {}, .symbol = {}}, choice_.purposes);
    if (said.source != nullptr) return said.purposes;
    changed_.add(kStationTypes, type->place(), type->text());
    return std::nullopt;
  }

  void note_station(const JsonReader& station) {
    if (const auto id = station.find("stationId"); id && !id->text().empty()) name_in(*id, ids_.stations);
    const auto by_type = purposes_of_type(station);
    for (const auto& id : station.at("interactionNodeIds").items()) {
      const auto node = station_in(id);
      if (!node) {
        changed_.add(kNodeElsewhere, id.place(), id.text());
        continue;
      }
      const auto index = node->index();
      const bool forbids = forbid_transfers(rules_by_type(nodes_[index]));
      if (by_type && !(forbids && by_type->has(Purpose::Storage))) {
        add_purposes(index, *by_type);
        continue;
      }
      const bool is_known = purposes_.stated.contains(index) || purposes_.by_actions.contains(index);
      if (is_known || layout_.stations[index].purposes != Purposes(Purpose::Routing)) continue;
      if (!forbids) add_purposes(index, Purpose::Storage);
      changed_.add(forbids ? kWithoutTransfer : kTakenForStorage, id.place(), id.text());
    }
  }

  // The two-way segments of a file that to_lif() wrote.
  void reunite_ways_back() {
    std::map<std::string, std::size_t> by_name;
    for (std::size_t i = 0; i < layout_.segments.size(); ++i) by_name.emplace(layout_.segments[i].name, i);
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const auto note = edges_[i].find("edgeDescription");
      if (!note || !note->is_text() || !note->text().starts_with(kBackMark)) continue;
      const auto there = by_name.find(note->text().substr(kBackMark.size()));
      if (there != by_name.end() && there->second != i) pairs.emplace_back(there->second, i);
    }
    merge_pairs(layout_, pairs);
  }

  // Refuses the first fault of the finished layout, at the place in the file that caused it.
  void refuse_problems(const JsonReader& layout) const {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const std::string_view pointer = problems[0].pointer;
    const bool of_segment = pointer.starts_with("/segments/"), of_station = pointer.starts_with("/stations/");
    if (!of_segment && !of_station) layout.refuse(problems[0].sentence);
    const auto digits = pointer.substr(10);
    std::size_t index = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (of_segment && layout_.segments[index].from == layout_.segments[index].to)
      edges_[index].at("edgeId").refuse(
          "its two nodes are one station here, because edges of no length join them; put another node on its "
          "trajectory");
    (of_segment ? edges_ : nodes_)[index].at(of_segment ? "edgeId" : "nodeId").refuse(problems[0].sentence);
  }

  JsonValue root_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  const ReadChoice& choice_;
  Layout layout_;
  std::vector<JsonReader> nodes_, edges_;  // by station and by segment, as long as no two segments are merged
  struct {
    std::set<std::string> nodes, edges, stations, elsewhere;
  } ids_;
  std::map<std::string, StationId> stations_;
  struct {
    std::map<std::size_t, Purposes> stated;  // by station: given in the description of the station
    std::set<std::size_t> by_actions;        // stations of which actions say what they are for
  } purposes_;
  LeftOutThings changed_;
  LifTypes types_{{}, {}};
  struct {
    LifTrajectories trajectories;
    LifTravel travel;
    LifTurns turns;
  } rules_;
  LifSpots spots_;
  struct Guide {
    std::size_t segment = 0;
    double length_m = 0.0;  // as the file gives it
  };
  struct {
    std::size_t of_types = 0;            // edges
    std::vector<std::string> torn, act;  // names of nodes, and of edges
    std::vector<Guide> guides;
  } told_;
};

}  // namespace

Layout read_lif(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice) {
  return parse_lif(read_text_file(path), path, warnings, choice);
}

Layout parse_lif(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                 const ReadChoice& choice) {
  return LifReader(text, source, warnings, choice).read();
}

}  // namespace fleetproof
