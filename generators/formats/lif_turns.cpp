#include "generators/formats/lif_turns.hpp"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace fleetproof
