#include "generators/formats/lif_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "core/base/catalogue.hpp"
#include "core/base/outside_text.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"

namespace fleetproof {
namespace {

constexpr const char* kLists[] = {"vehicleTypeNodeProperties", "mobileRobotTypeNodeProperties",
                                  "vehicleTypeEdgeProperties", "mobileRobotTypeEdgeProperties"};

bool has_list(const JsonReader& element) {
  return std::ranges::any_of(kLists, [&](const char* key) { return element.find(key).has_value(); });
}

struct Loads {
  bool empty = false, loaded = false;

  LoadState state() const { return empty && loaded ? LoadState::Any : empty ? LoadState::Empty : LoadState::Loaded; }
};

bool is_named(const JsonReader& rule, const std::string& type) {
  const auto types = types_of(rule);
  return std::ranges::find(types, type) != types.end() || std::ranges::find(types, "") != types.end();
}

// The loads with which a type may be on a node or edge.
Loads loads_of(const std::vector<JsonReader>& rules, const std::string& type) {
  Loads loads{rules.empty(), rules.empty()};
  for (const auto& rule : rules) {
    if (!is_named(rule, type)) continue;
    Loads here{true, true};
    if (const auto restriction = rule.find("loadRestriction")) {
      restriction->read("unloaded", here.empty);
      restriction->read("loaded", here.loaded);
    }
    loads.empty |= here.empty;
    loads.loaded |= here.loaded;
  }
  return loads;
}

Loads operator&(const Loads& a, const Loads& b) { return {a.empty && b.empty, a.loaded && b.loaded}; }

}  // namespace

std::optional<JsonReader> either(const JsonReader& object, std::string_view old_key, std::string_view new_key) {
  auto found = object.find(old_key);
  return found ? found : object.find(new_key);
}

std::string word_of(const JsonReader& rule, std::string_view key, std::span<const std::string_view> words,
                    std::string_view usual) {
  const auto found = rule.find(key);
  if (!found) return std::string(usual);
  auto word = found->text();
  if (std::ranges::find(words, word) == words.end()) found->refuse("there is no such word" + name_hint(word, words));
  return word;
}

std::vector<JsonReader> rules_by_type(const JsonReader& element) {
  std::vector<JsonReader> rules;
  for (const char* key : kLists) {
    if (const auto list = element.find(key)) std::ranges::copy(list->items(), std::back_inserter(rules));
  }
  return rules;
}

std::vector<std::string> types_of(const JsonReader& rule) {
  if (const auto id = either(rule, "vehicleTypeId", "mobileRobotTypeId")) return {id->text()};
  std::vector<std::string> names;
  if (const auto ids = either(rule, "vehicleTypeIds", "mobileRobotTypeIds")) {
    for (const auto& id : ids->items()) names.push_back(id.text());
    return names;
  }
  const auto robots = rule.find("mobileRobotTypes");
  if (!robots) return {""};
  for (const auto& robot : robots->items()) {
    std::string manufacturer;
    robot.read("manufacturer", manufacturer);
    names.push_back((manufacturer.empty() ? "" : manufacturer + ".") + robot.at("seriesName").text());
  }
  return names;
}

LifTypes::LifTypes(const std::vector<JsonReader>& nodes, const std::vector<JsonReader>& edges) {
  for (const auto& node : nodes) note(node, "nodeId");
  for (const auto& edge : edges) note(edge, "edgeId");
}

void LifTypes::note(const JsonReader& element, const char* id) {
  const auto rules = rules_by_type(element);
  if (rules.empty()) ++open_;
  if (rules.empty() && has_list(element)) ++empty_;
  std::set<std::string> here;
  bool twice = false, nameless = false;
  for (const auto& rule : rules) {
    for (const auto& name : types_of(rule)) {
      twice |= !here.insert(name).second;
      nameless |= name.empty();
      if (name.empty() || std::ranges::find(names_, name) != names_.end()) continue;
      if (const char* fault = fault_of_name(name))
        rule.refuse(fmt::format("the type of vehicle {}: {}", in_quotes(name), fault));
      names_.push_back(name);
    }
  }
  if (twice) twice_.push_back(element.at(id).text());
  if (nameless) nameless_.push_back(element.at(id).text());
}

std::optional<std::vector<Permission>> LifTypes::permissions(const JsonReader& edge, const JsonReader& from,
                                                             const JsonReader& to) const {
  const auto at_edge = rules_by_type(edge), at_start = rules_by_type(from), at_end = rules_by_type(to);
  std::vector<Permission> found;
  for (const auto& name : names_.empty() ? std::vector<std::string>{""} : names_) {
    const Loads loads = loads_of(at_edge, name) & loads_of(at_start, name) & loads_of(at_end, name);
    if (loads.empty || loads.loaded) found.push_back({name, loads.state()});
  }
  if (found.empty()) return std::nullopt;
  const bool alike = std::ranges::all_of(found, [&](const Permission& one) { return one.load == found[0].load; });
  if (!alike || found.size() < names_.size()) return found;
  if (found[0].load == LoadState::Any) return std::vector<Permission>{};
  return std::vector<Permission>{{"", found[0].load}};
}

void LifTypes::count(const std::vector<Permission>& permissions) {
  ++edges_;
  const auto is_named = [](const Permission& one) { return !one.vehicle_type.empty(); };
  restricted_ += std::ranges::any_of(permissions, is_named) ? 1 : 0;
}

std::vector<std::string> LifTypes::odd_rules() const {
  std::vector<std::string> sentences;
  if (const std::size_t open = names_.empty() ? empty_ : open_; open > 0)
    sentences.push_back(
        fmt::format("{} nodes and edges have no rule for any type of vehicle; here all types may use them", open));
  if (!twice_.empty())
    sentences.push_back(fmt::format(
        "{} nodes and edges have two rules for one type of vehicle ({}); here it may drive with the loads and "
        "in the directions of both",
        twice_.size(), name_list(twice_)));
  if (!nameless_.empty() && !names_.empty())
    sentences.push_back(
        fmt::format("{} nodes and edges have a rule that names no type of vehicle ({}); here it holds "
                    "for every type",
                    nameless_.size(), name_list(nameless_)));
  return sentences;
}

std::string LifTypes::sentence() const {
  if (names_.empty()) return "";
  if (restricted_ == 0) {
    return fmt::format("nodes and edges have rules for {} types of vehicles ({}); here they hold for every AGV",
                       names_.size(), name_list(names_));
  }
  return fmt::format(
      "{} of {} edges are for some types of vehicles only; a campaign needs a [[vehicle]] with one of their names "
      "({}), "
      "or lets every AGV drive what one of them may (any_type). What stations are for holds for all types",
      restricted_, edges_, name_list(names_, names_.size()));
}

}  // namespace fleetproof
