#include "generators/formats/rmf_left_out.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <string_view>

#include "generators/formats/left_out.hpp"
#include "generators/formats/rmf_words.hpp"
#include "generators/text/yaml_text.hpp"

namespace fleetproof {
namespace {

constexpr Topic kDoors{"{0} doors are left out ({1}); doors are not modelled: an AGV drives through without waiting"};
constexpr Topic kRmfLifts{"{0} lifts are left out ({1}); lifts are not modelled, and only one level is read"};
constexpr Topic kParts{"{0} parts of the file are left out ({1}); they change no lane"};
constexpr Topic kUnused{"{0} vertices lie on no lane that is read and are left out ({1})"};
constexpr Topic kLostPlaces{
    "{0} chargers, parking spots, dispensers and ingestors lie on no lane that is read and are left out ({1})"};
constexpr Topic kVertexHeights{"{0} vertices lie above or below the floor ({1}); here the floor is flat"};
constexpr Topic kMutexes{"{0} mutex groups of vertices are left out ({1}); here a block holds lanes alone"};
constexpr Topic kDocks{"{0} docking manoeuvres are left out ({1})"};
constexpr Topic kRobots{"{0} robots of the fleet are left out ({1}); a campaign has its own fleet"};
constexpr Topic kRobotTypes{"{0} types of robots are left out ({1})"};
constexpr Topic kHolding{"is_holding_point of {0} vertices ({1}) is left out; here an AGV may wait at every station"};
constexpr Topic kPassing{
    "is_passthrough_point of {0} vertices ({1}) is left out; here an AGV may stop at every station"};
constexpr Topic kMarks{"{0} kinds of marks on vertices are left out ({1})"};
constexpr Topic kMocks{"{0} kinds of marks on lanes are left out ({1})"};
constexpr Topic kOfNoLength{"{0} kinds of attributes of lanes without a length are left out ({1})"};
constexpr Topic kUnknownAttributes{"{0} attributes are unknown here and left out ({1})"};

enum class NamedBy : std::uint8_t { ByOwner, ByKey, ByValue };

struct RmfRule {
  std::string_view key;
  const Topic* topic = nullptr;  // null: it is read
  NamedBy named = NamedBy::ByOwner;
};
constexpr RmfRule kLaneRules[] = {{"bidirectional"},
                                  {"is_bidirectional"},
                                  {"graph_idx"},
                                  {"speed_limit"},
                                  {"orientation"},
                                  {"orientation_constraint"},
                                  {"mutex"},
                                  {"dock_name", &kDocks, NamedBy::ByValue},
                                  {"undock_name", &kDocks, NamedBy::ByValue},
                                  {"door_name", &kDoors, NamedBy::ByValue},
                                  {"lift", &kRmfLifts, NamedBy::ByValue},
                                  {"demo_mock_lift_name", &kMocks, NamedBy::ByKey},
                                  {"demo_mock_floor_name", &kMocks, NamedBy::ByKey}};
constexpr RmfRule kVertexRules[] = {{"name"},
                                    {"is_charger"},
                                    {"is_parking_spot"},
                                    {"pickup_dispenser"},
                                    {"dropoff_ingestor"},
                                    {"lift_cabin"},
                                    {"lift"},
                                    {"mutex", &kMutexes, NamedBy::ByValue},
                                    {"dock_name", &kDocks, NamedBy::ByValue},
                                    {"spawn_robot_name", &kRobots, NamedBy::ByValue},
                                    {"spawn_robot_type", &kRobotTypes, NamedBy::ByValue},
                                    {"is_holding_point", &kHolding},
                                    {"is_passthrough_point", &kPassing},
                                    {"is_cleaning_zone", &kMarks, NamedBy::ByKey},
                                    {"human_goal_set_name", &kMarks, NamedBy::ByKey},
                                    {"merge_radius", &kMarks, NamedBy::ByKey}};
constexpr std::string_view kReadRoot[] = {"levels", "name", "building_name", "coordinate_system"};
constexpr std::string_view kReadLevel[] = {"vertices", "lanes", "measurements"};
constexpr std::string_view kScale[] = {"reference_level_name", "fiducials"};  // of levels but the reference

bool contains(const auto& words, std::string_view word) { return std::ranges::find(words, word) != std::end(words); }

bool is_empty(const YAML::Node& node) { return node.IsNull() || (!node.IsScalar() && node.size() == 0); }

std::string word_of(const YAML::Node& key) { return key.IsScalar() ? key.Scalar() : shown(key); }

// The building file says [type, value] where the nav graph says value. Empty if the attribute says nothing.
std::string value_of(const YAML::Node& node) {
  const auto value = node.IsSequence() && node.size() == 2 ? node[1] : node;
  if (!value.IsDefined() || is_empty(value)) return "";
  if (!value.IsScalar()) return "...";
  const auto text = value.Scalar();
  return text == "0.0" || !said_truth(text).value_or(true) ? "" : text;
}

bool is_place(const YAML::Node& vertex) {
  if (!vertex.IsSequence() || vertex.size() < 3) return false;
  const auto words = vertex[vertex.size() - 1];
  constexpr const char* kPlaceProperties[] = {"is_charger", "is_parking_spot", "pickup_dispenser", "dropoff_ingestor"};
  return std::ranges::any_of(kPlaceProperties, [&](const char* word) { return names_something(words, word); });
}

class LevelWalk {
 public:
  LevelWalk(const YamlText& yaml, const ReadLevel& read, LeftOutThings& things)
      : yaml_(yaml), read_(read), things_(things) {}

  void parts(const YAML::Node& map, const auto& read_keys) {
    for (const auto entry : map) {
      const auto key = word_of(entry.first);
      if (contains(read_keys, key) || is_empty(entry.second)) continue;
      if (read_.by_fiducials && contains(kScale, key)) continue;
      if (key == "doors") {
        doors(entry.second);
      } else if (key == "lifts" && entry.second.IsMap()) {
        for (const auto lift : entry.second) things_.add(kRmfLifts, yaml_.place(entry.second), word_of(lift.first));
      } else {
        things_.add(kParts, yaml_.place(entry.second), key);
      }
    }
  }

  void vertices(const YAML::Node& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto vertex = list[i];
      const auto given = given_name(vertex, read_.is_nav_graph), name = given.empty() ? fmt::format("v{}", i) : given;
      if (!read_.vertices.contains(i)) {
        things_.add(is_place(vertex) ? kLostPlaces : kUnused, yaml_.place(vertex), name);
        continue;
      }
      if (!read_.is_nav_graph && vertex.size() > 2 && !value_of(vertex[2]).empty())
        things_.add(kVertexHeights, yaml_.place(vertex), name);
      attributes(vertex, kVertexRules, name);
    }
  }

  void lanes(const YAML::Node& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (const auto lane = read_.lanes.find(i); lane != read_.lanes.end())
        attributes(list[i], kLaneRules, lane->second);
      if (!read_.lanes_of_no_length.contains(i)) continue;
      attributes(list[i], kLaneRules, fmt::format("lane {} of the file", i));
      of_no_length(list[i]);
    }
  }

 private:
  // What is read of other lanes. That AGVs go there and back is kept: they need no way.
  void of_no_length(const YAML::Node& lane) {
    const auto words = lane.size() > 2 ? lane[lane.size() - 1] : YAML::Node();
    for (const char* key : {"mutex", "speed_limit", "orientation", "orientation_constraint"}) {
      const auto value = words.IsMap() && words[key].IsDefined() ? value_of(words[key]) : "";
      if (!value.empty() && value != "none") things_.add(kOfNoLength, yaml_.place(lane), key);
    }
  }

  void doors(const YAML::Node& list) {
    if (list.IsMap()) {
      for (const auto door : list) things_.add(kDoors, yaml_.place(list), word_of(door.first));
      return;
    }
    std::size_t number = 0;
    for (const auto door : list) {
      const auto words = door.IsSequence() && door.size() > 2 ? door[2] : door;
      const auto name = words.IsMap() ? words["name"] : YAML::Node(YAML::NodeType::Undefined);
      const auto text = name.IsDefined() ? value_of(name) : "";
      things_.add(kDoors, yaml_.place(list), text.empty() ? fmt::format("door {}", number) : text);
      ++number;
    }
  }

  void attributes(const YAML::Node& item, const auto& rules, const std::string& owner) {
    const auto words = item.size() > 2 ? item[item.size() - 1] : YAML::Node();
    if (!words.IsMap()) return;
    for (const auto entry : words) {
      const auto key = word_of(entry.first), value = value_of(entry.second);
      const auto rule = std::ranges::find(rules, key, &RmfRule::key);
      if (rule == std::end(rules)) {
        things_.add(kUnknownAttributes, yaml_.place(item), key);
      } else if (rule->topic != nullptr && !value.empty()) {
        things_.add(*rule->topic, yaml_.place(item),
                    rule->named == NamedBy::ByValue ? value
                    : rule->named == NamedBy::ByKey ? key
                                                    : owner);
      }
    }
  }

  const YamlText& yaml_;
  const ReadLevel& read_;
  LeftOutThings& things_;
};

}  // namespace

void note_left_out(const YamlText& yaml, const YAML::Node& root, const YAML::Node& level, const ReadLevel& read,
                   std::vector<std::string>& warnings) {
  LeftOutThings things;
  LevelWalk walk(yaml, read, things);
  walk.parts(root, kReadRoot);
  walk.parts(level, kReadLevel);
  walk.vertices(level["vertices"]);
  walk.lanes(level["lanes"]);
  things.tell(warnings);
}

}  // namespace fleetproof
