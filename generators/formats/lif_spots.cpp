#include "generators/formats/lif_spots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "generators/formats/lif_types.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

// `"N1" with "N2", "N3"`
std::string label_of(const Layout& layout, const std::vector<std::size_t>& nodes) {
  std::vector<std::string> others;
  for (std::size_t i = 1; i < nodes.size(); ++i) others.push_back(layout.stations[nodes[i]].name);
  const auto first = in_quotes(layout.stations[nodes[0]].name);
  return others.empty() ? first : first + " with " + name_list(others, others.size());
}

}  // namespace

bool LifSpots::stays(const JsonReader& edge, const Vec2& from_m, const Vec2& to_m) {
  if (!((to_m - from_m).norm() <= kOnTheNode_m)) return false;
  for (const auto& rule : rules_by_type(edge)) {
    const auto trajectory = rule.find("trajectory");
    if (!trajectory) continue;
    for (const auto& point : trajectory->at("controlPoints").items()) {
      const Vec2 point_m(point.at("x").number(), point.at("y").number());
      if (!((point_m - from_m).norm() <= kOnTheNode_m)) return false;
    }
  }
  return true;
}

void LifSpots::add(const JsonReader& edge, StationId from, StationId to, bool for_all) {
  if (turns_.empty()) place_ = edge.place();
  const auto a = first_of(from.index()), b = first_of(to.index());
  earlier_[std::max(a, b)] = earlier_[std::min(a, b)] = std::min(a, b);
  Turn turn{from.index(), false, for_all, false};
  for (const auto& rule : rules_by_type(edge)) {
    bool on_edge = false, before = true;
    rule.read("rotationAllowed", on_edge);
    rule.read("reachOrientationBeforeEntering", before);
    turn.on_edge |= on_edge || !before;
    turn.limited |= either(rule, "maxSpeed", "maximumSpeed").has_value();
  }
  turns_.push_back(turn);
}

void LifSpots::share_purposes(Layout& layout) {
  const auto all = spots();
  for (const auto& [first, spot] : all) {
    note_tasks(layout, spot);
    auto& purposes = layout.stations[first].purposes;
    for (const auto node : spot.nodes) purposes = purposes | layout.stations[node].purposes;
    for (const auto node : spot.nodes) layout.stations[node].purposes = purposes;
  }
}

void LifSpots::join(Layout& layout, std::vector<JsonReader>& nodes, std::vector<std::string>& warnings) {
  const auto all = spots();
  if (all.empty()) return;
  share_purposes(layout);
  tell(layout, all, warnings);
  for (const auto& [first, spot] : all) unite(layout, spot);
  std::vector<Station> stations;
  std::vector<JsonReader> kept;
  std::vector<StationId> now(layout.stations.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (const auto first = first_of(i); first != i) {
      now[i] = now[first];
      continue;
    }
    now[i] = StationId{stations.size()};
    stations.push_back(std::move(layout.stations[i]));
    kept.push_back(nodes[i]);
  }
  for (Segment& segment : layout.segments) {
    segment.from = now[segment.from.index()];
    segment.to = now[segment.to.index()];
  }
  layout.stations = std::move(stations);
  nodes = std::move(kept);
}

// Purposes that are shared say nothing of one node.
void LifSpots::note_tasks(const Layout& layout, const Spot& spot) {
  if (std::ranges::any_of(spot.nodes, [&](auto node) { return with_tasks_.contains(node); })) return;
  for (const auto node : spot.nodes) {
    if (layout.stations[node].purposes != Purposes(Purpose::Routing)) with_tasks_.insert(node);
  }
}

std::optional<Vec2> LifSpots::heading_of(const Layout& layout, const Spot& spot) const {
  const bool has_tasks = std::ranges::any_of(spot.nodes, [&](auto node) { return with_tasks_.contains(node); });
  std::optional<Vec2> heading;
  for (const auto node : spot.nodes) {
    const auto& asked = layout.stations[node].heading;
    if (!asked || (has_tasks && !with_tasks_.contains(node))) continue;
    if (heading && *heading != *asked) return std::nullopt;
    heading = asked;
  }
  return heading;
}

// Makes the first station stand for all.
void LifSpots::unite(Layout& layout, const Spot& spot) const {
  const auto heading = heading_of(layout, spot);
  Station& first = layout.stations[spot.nodes[0]];
  first.turning =
      spot.turns || std::ranges::any_of(spot.nodes, [&](auto node) { return layout.stations[node].turning; });
  first.heading = heading;
}

// Halves the way to the first for all on it, so that long rows of nodes stay quick.
std::size_t LifSpots::first_of(std::size_t node) {
  for (auto found = earlier_.find(node); found != earlier_.end() && found->second != node;) {
    const auto before = earlier_.find(found->second);
    found->second = before->second;
    node = before->first;
    found = before;
  }
  return node;
}

std::map<std::size_t, LifSpots::Spot> LifSpots::spots() {
  std::map<std::size_t, Spot> all;
  for (const auto& [node, earlier] : earlier_) all[first_of(node)].nodes.push_back(node);
  for (const Turn& turn : turns_) {
    Spot& spot = all[first_of(turn.node)];
    spot.turns |= turn.on_edge;
    spot.for_all &= turn.for_all;
    spot.limited |= turn.limited;
  }
  return all;
}

void LifSpots::tell(const Layout& layout, const std::map<std::size_t, Spot>& spots,
                    std::vector<std::string>& warnings) const {
  const auto say = [&](std::string_view sentence, const auto& matches) {
    std::string list;
    std::size_t count = 0;
    for (const auto& [first, spot] : spots) {
      if (!matches(spot)) continue;
      list += (count++ == 0 ? "" : "; ") + label_of(layout, spot.nodes);
    }
    if (count > 0) warnings.push_back(place_ + ": " + fmt::vformat(sentence, fmt::make_format_args(count, list)));
  };
  const auto turning_nodes = [&](const Spot& spot) {
    return std::ranges::count_if(spot.nodes, [&](std::size_t node) { return layout.stations[node].turning; });
  };
  const auto turn = [&](const Spot& spot) { return spot.turns || turning_nodes(spot) > 0; };
  say("{0} stations have edges of no length, on which AGVs turn on the spot ({1}); nodes that such an edge joins are "
      "one station here, which has the name of the first, and an AGV goes on from each of its edges to each other",
      turn);
  say("{0} stations have edges of no length, and no edge lets an AGV turn there ({1}); nodes that such an edge joins "
      "are one station here, which has the name of the first",
      [&](const Spot& spot) { return !turn(spot); });
  say("edges of no length at {0} stations are for some AGVs or loads only ({1}); here every AGV may turn there, with a "
      "load and without one",
      [&](const Spot& spot) { return turn(spot) && !spot.for_all; });
  say("{0} stations do not let an AGV turn at each of their nodes ({1}); here it may turn there between all edges",
      [&](const Spot& spot) {
        return turn(spot) && turning_nodes(spot) < static_cast<std::ptrdiff_t>(spot.nodes.size());
      });
  say("the nodes of {0} stations do not ask for one heading ({1}); here the one for which those with tasks ask holds "
      "for all tasks there; if they ask for several, an AGV stands as it arrives",
      [&](const Spot& spot) {
        const auto taken = heading_of(layout, spot);
        return std::ranges::any_of(spot.nodes, [&](std::size_t node) {
          const auto& asked = layout.stations[node].heading;
          return asked ? asked != taken : taken && with_tasks_.contains(node);
        });
      });
  say("edges of no length have a speed limit at {0} stations ({1}); it is left out",
      [](const Spot& spot) { return spot.limited; });
}

}  // namespace fleetproof
