#include "generators/formats/lif_travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "core/geometry/rotation.hpp"
#include "generators/formats/heading.hpp"
#include "generators/formats/lif_types.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kWords[] = {"NONE", "CCW", "CW", "BOTH"};

}  // namespace

LifTurns::Node& LifTurns::node(StationId station) {
  if (nodes_.size() <= station.index()) nodes_.resize(station.index() + 1);
  return nodes_[station.index()];
}

void LifTurns::add(const JsonReader& edge, StationId from, StationId to, bool sideways) {
  add_end(edge, "rotationAtStartNodeAllowed", node(from), &Node::leaving, sideways);
  add_end(edge, "rotationAtEndNodeAllowed", node(to), &Node::arriving, sideways);
}

void LifTurns::add_end(const JsonReader& edge, const char* key, Node& node, Ends Node::*ends, bool sideways) {
  const auto rules = rules_by_type(edge);
  std::size_t never = 0, on_edge = 0;
  for (const auto& rule : rules) {
    const auto word = word_of(rule, key, kWords, "BOTH");
    bool turns = sideways;
    rule.read("rotationAllowed", turns);
    never += word == "NONE" ? 1 : 0;
    on_edge += turns || sideways ? 1 : 0;
    node.one_way_round |= word == "CW" || word == "CCW";
  }
  const bool forbids = never > 0 && never == rules.size() && on_edge == 0;
  node.some_may |= never > 0 && !forbids;
  Ends& here = node.*ends;
  ++here.all;
  here.never += forbids ? 1 : 0;
}

std::vector<std::string> LifTurns::settle(Layout& layout) {
  std::vector<std::string> between_some, one_way_round;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    Station& station = layout.stations[i];
    station.turning = !node.arriving.forbid() && !node.leaving.forbid();
    if (!station.turning) continue;
    if (node.arriving.differ() || node.leaving.differ() || node.some_may) between_some.push_back(station.name);
    if (node.one_way_round) one_way_round.push_back(station.name);
  }
  std::vector<std::string> sentences;
  if (!between_some.empty()) {
    sentences.push_back(
        fmt::format("{} nodes let some AGVs turn, or between some edges only ({}); here every AGV may turn there",
                    between_some.size(), name_list(between_some)));
  }
  if (!one_way_round.empty()) {
    sentences.push_back(fmt::format("{} nodes let an AGV turn in one sense only ({}); here it turns the shorter way",
                                    one_way_round.size(), name_list(one_way_round)));
  }
  return sentences;
}

namespace {

constexpr double kHalfTurns = 0.005;      // tolerance of an orientation, in half turns
constexpr double kFullTurn_rad = 6.2832;  // rounded up, as files round it
constexpr std::string_view kReferences[] = {"TANGENTIAL", "GLOBAL"};

// Of an orientation along the edge: whether the nose goes first. None: it is aside.
std::optional<bool> is_forward(double rad) {
  const double turns = std::abs(rad) / std::numbers::pi;  // half turns
  const auto whole = static_cast<std::int64_t>(turns + 0.5);
  if (std::abs(turns - static_cast<double>(whole)) >= kHalfTurns) return std::nullopt;
  return whole % 2 == 0;
}

// The same of an orientation on the map, along a straight edge.
std::optional<bool> is_forward_on_map(double rad, const Vec2& straight) {
  const Vec2 nose = rotated(straight.normalized(), unit_vector(-rad));
  if (std::abs(nose.y()) >= kHalfTurns * std::numbers::pi) return std::nullopt;
  return nose.x() > 0.0;
}

std::optional<double> angle_of(const JsonReader& reader) {
  const auto& scalar = reader.value().scalar;
  if (reader.value().shape != JsonValue::Shape::Scalar || reader.is_text() ||
      std::holds_alternative<std::nullptr_t>(scalar) || std::holds_alternative<bool>(scalar))
    return std::nullopt;
  const double rad = reader.number();
  return std::abs(rad) <= kLargestHeading_rad ? std::optional(rad) : std::nullopt;
}

// None: this is no list of angles.
std::optional<std::vector<double>> angles_of(const JsonReader& list) {
  if (list.value().shape != JsonValue::Shape::Array) return std::nullopt;
  std::vector<double> angles_rad;
  for (const auto& item : list.items()) {
    const auto rad = angle_of(item);
    if (!rad) return std::nullopt;
    angles_rad.push_back(*rad);
  }
  return angles_rad.empty() ? std::nullopt : std::optional(std::move(angles_rad));
}

// LIF 1.0 means nose first if it gives none; its successor, whose rules list types, means any orientation.
bool leaves_orientation_open(const JsonReader& rule) {
  return rule.find("mobileRobotTypes") || rule.find("vehicleTypeIds") || rule.find("mobileRobotTypeIds");
}

// Adds the edge once: its rules are read in a row.
void note(std::vector<std::string>& edges, const std::string& edge) {
  if (edges.empty() || edges.back() != edge) edges.push_back(edge);
}

}  // namespace

std::vector<double> LifTravel::orientations(const JsonReader& rule, const std::string& edge) {
  std::vector<double> found_rad;
  if (const auto one = rule.find("vehicleOrientation")) {
    found_rad.push_back(one->number());
    if (!(std::abs(found_rad[0]) <= kLargestHeading_rad)) one->refuse("expected an angle in radians");
  }
  for (const char* key : {"vehicleOrientations", "mobileRobotOrientations"}) {
    const auto list = rule.find(key);
    if (!list) continue;
    const auto angles_rad = angles_of(*list);
    if (!angles_rad) {
      note(unread_, edge);
      continue;
    }
    found_rad.insert(found_rad.end(), angles_rad->begin(), angles_rad->end());
  }
  if (std::ranges::any_of(found_rad, [](double rad) { return std::abs(rad) > kFullTurn_rad; })) note(large_, edge);
  return found_rad;
}

bool LifTravel::add(const std::vector<JsonReader>& rules, const std::optional<Vec2>& straight, Segment& segment) {
  std::map<std::vector<std::string>, std::set<bool>> ways;  // by type: whether forward
  bool forward = false, backward = false, sideways = false, also_sideways = false;
  for (const auto& rule : rules) {
    const bool tangential = word_of(rule, "orientationType", kReferences, kReferences[0]) == kReferences[0];
    bool along = false, aside = false;
    auto orientations_rad = orientations(rule, segment.name);
    if (orientations_rad.empty()) {
      if (leaves_orientation_open(rule) || !tangential) note(open_, segment.name);
      orientations_rad = {tangential || !straight ? 0.0 : angle_between(Vec2(1.0, 0.0), straight->normalized())};
    }
    for (const double rad : orientations_rad) {
      const auto nose_first = tangential ? is_forward(rad)
                              : straight ? is_forward_on_map(rad, *straight)
                                         : std::nullopt;
      (nose_first ? along : aside) = true;
      if (!nose_first) continue;
      (*nose_first ? forward : backward) = true;
      ways[types_of(rule)].insert(*nose_first);
    }
    forward |= !along;
    sideways |= !along;
    also_sideways |= along && aside;
  }
  if (sideways) sideways_.push_back(segment.name);
  if (also_sideways) also_sideways_.push_back(segment.name);
  if (forward && backward && std::ranges::any_of(ways, [](const auto& way) { return way.second.size() == 1; }))
    both_ways_.push_back(segment.name);
  if (backward) segment.travel = forward ? Travel::Either : Travel::Backward;
  return sideways;
}

std::vector<std::string> LifTravel::sentences() const {
  std::vector<std::string> found;
  const auto tell = [&](const std::vector<std::string>& edges, std::string_view sentence) {
    const std::size_t count = edges.size();
    const auto list = name_list(edges);
    if (count > 0) found.push_back(fmt::vformat(sentence, fmt::make_format_args(count, list)));
  };
  tell(sideways_,
       "{0} edges turn the AGV sideways, or by a heading on the map that is not along them ({1}); sideways travel is "
       "not modelled: here AGVs drive them nose first");
  tell(also_sideways_,
       "{0} edges let AGVs drive sideways, too ({1}); sideways travel is not modelled: here AGVs drive them forward or "
       "backward, as they also may");
  tell(both_ways_,
       "{0} edges are driven forward by some types of vehicles and backward by others ({1}); here every type may do "
       "both");
  tell(open_,
       "{0} edges leave the orientation open ({1}); sideways travel is not modelled: here AGVs drive them nose first");
  tell(large_, "{0} edges have orientations of more than a full turn ({1}); they count as radians, as LIF says");
  tell(unread_, "{0} edges list orientations that are no angles in radians ({1}); they are left out");
  return found;
}

}  // namespace fleetproof
