#include "generators/formats/rmf.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "generators/formats/rmf_left_out.hpp"
#include "generators/map/antiparallel.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/yaml_text.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kListed = 50;  // levels in a sentence

class LevelReader {
 public:
  LevelReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
              const RmfChoice& choice)
      : yaml_(source), warnings_(warnings), choice_(choice), root_(YAML::Load(std::string(text))) {}

  Layout read() {
    if (!root_.IsMap() || !root_["levels"].IsDefined())
      throw InputError(yaml_.source(), "has no \"levels\"; expected an Open-RMF building or nav graph");
    yaml_.refuse_second_keys(root_);
    const auto level = choose_level();
    yaml_.refuse_second_keys(level);
    const auto vertices = yaml_.list(level, "vertices", "the level"), lanes = yaml_.list(level, "lanes", "the level");
    for (const auto vertex : vertices) vertices_.push_back(vertex);
    if (vertices_.empty()) yaml_.refuse(vertices, "the level is empty: it has no vertex");
    is_nav_graph_ = read_.is_nav_graph =
        !vertices_[0].IsSequence() || vertices_[0].size() < 3 || vertices_[0][2].IsMap();
    if (is_nav_graph_ && choice_.graph_idx != 0)
      throw InputError(yaml_.source(),
                       fmt::format("is a nav graph, which is one graph alone; leave out graph {}", choice_.graph_idx));
    read_scale(level);
    std::size_t place = 0;
    for (const auto lane : lanes) add_lane(lane, place++);
    if (layout_.segments.empty()) refuse_choice(lanes);
    if (!told_.other_end_back.empty())
      warn(level, fmt::format("{} two-way lanes ask for an orientation ({}); AGVs drive them back with the other end "
                              "first, without a turn",
                              told_.other_end_back.size(), name_list(told_.other_end_back)));
    if (told_.other_graphs > 0) warn(lanes, fmt::format("{} lanes of other graphs are left out", told_.other_graphs));
    note_left_out(yaml_, root_, level, read_, warnings_);
    fit_floor(layout_, kFloorMargin_m);
    refuse_problems(level);
    settle_twins(layout_, choice_.twins, yaml_.source(), warnings_);
    return std::move(layout_);
  }

 private:
  void warn(const YAML::Node& node, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", yaml_.place(node), sentence));
  }

  [[noreturn]] void refuse_choice(const YAML::Node& lanes) const {
    std::vector<std::string> levels;
    for (const auto entry : root_["levels"]) levels.push_back(entry.first.Scalar());
    yaml_.refuse(
        lanes,
        told_.graphs.empty()
            ? fmt::format("level {} has no lane; levels of the file: {}", in_quotes(read_.name),
                          name_list(levels, kListed))
            : fmt::format("no lane of level {} belongs to graph {}; graphs of its lanes: {}; levels of the file: {}",
                          in_quotes(read_.name), choice_.graph_idx, fmt::join(told_.graphs, ", "),
                          name_list(levels, kListed)));
  }

  YAML::Node choose_level() {
    const auto levels = root_["levels"];
    if (!levels.IsMap() || levels.size() == 0)
      yaml_.refuse(levels, "levels is not a map of levels; expected levels: {L1: ...}");
    yaml_.refuse_second_keys(levels);
    std::vector<std::string> names;
    for (const auto entry : levels) {
      if (!entry.first.IsScalar() || !entry.second.IsMap())
        yaml_.refuse(levels, "a level is not a map of vertices and lanes; expected L1: {vertices: ..., lanes: ...}");
      names.push_back(entry.first.Scalar());
    }
    const auto& wanted = read_.name = choice_.level.empty() ? names[0] : choice_.level;
    for (const auto entry : levels) {
      if (entry.first.Scalar() != wanted) continue;
      if (names.size() > 1)
        warn(levels, fmt::format("of {} levels, {} is read (levels: {})", names.size(), in_quotes(wanted),
                                 name_list(names, kListed)));
      layout_.name = wanted;
      for (const char* key : {"building_name", "name"}) {
        if (const auto name = root_[key]; name.IsDefined() && name.IsScalar())
          layout_.name = name.Scalar() + " " + wanted;
      }
      return entry.second;
    }
    yaml_.refuse(levels, fmt::format("there is no level {}; levels of the file: {}", in_quotes(wanted),
                                     name_list(names, kListed)));
  }

  std::size_t vertex_index(const YAML::Node& list, std::size_t at, const char* what) const {
    return yaml_.index_below(vertices_.size(), yaml_.item(list, at, what), fmt::format("{} names vertex", what));
  }

  // The building file says [type, value] where the nav graph says value. Undefined if the attribute does not exist.
  static YAML::Node parameter(const YAML::Node& words, const char* word) {
    if (!words.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const auto found = words[word];
    return found.IsDefined() && found.IsSequence() && found.size() == 2 ? found[1] : found;
  }

  // Whether the attribute exists and is true. One without a value is not.
  bool is_set(const YAML::Node& words, const char* word) const {
    const auto value = parameter(words, word);
    return value.IsDefined() && !value.IsNull() && yaml_.truth(value, word);
  }

  // Whether the attribute names something, such as the dispenser at a vertex. A word for false names nothing.
  static bool names_something(const YAML::Node& words, const char* word) {
    const auto value = parameter(words, word);
    if (!value.IsDefined() || value.IsNull()) return false;
    return !value.IsScalar() || (!value.Scalar().empty() && said_truth(value.Scalar()).value_or(true));
  }

  // The attributes of a vertex or lane: its last item, if that is a map. An item after them, or in their place, is
  // refused: it would hide them. `what` shows all items.
  YAML::Node words_of(const YAML::Node& list, std::size_t most, std::string_view what) const {
    if (!list.IsSequence() || list.size() <= 2) return YAML::Node(YAML::NodeType::Undefined);
    const std::size_t last = list.size() - 1;
    for (std::size_t i = 2; i <= last; ++i) {
      if (list[i].IsMap() ? i == last : i + 1 < most || (i + 1 == most && list[i].IsNull())) continue;
      const std::size_t wrong = list[i].IsMap() ? i + 1 : i;
      yaml_.refuse(list,
                   fmt::format("item {} is {}; expected {}, and nothing else", wrong + 1, shown(list[wrong]), what));
    }
    yaml_.refuse_second_keys(list[last]);
    return list[last];
  }
  YAML::Node words_of_lane(const YAML::Node& lane) const {
    return words_of(lane, 3, "a lane [FROM, TO, {ATTRIBUTES}]");
  }
  YAML::Node words_of_vertex(const YAML::Node& vertex) const {
    return is_nav_graph_ ? words_of(vertex, 3, "a vertex [X, Y, {ATTRIBUTES}]")
                         : words_of(vertex, 5, "a vertex [X, Y, Z, NAME, {ATTRIBUTES}]");
  }

  void read_scale(const YAML::Node& level) {
    if (is_nav_graph_) return;
    const auto system = root_["coordinate_system"];
    const auto name = system.IsDefined() && system.IsScalar() ? system.Scalar() : "reference_image";
    if (name == "cartesian_meters") return;
    if (name != "reference_image") {
      yaml_.refuse(
          system,
          fmt::format(
              "coordinate_system is {}, which needs a map projection; generate nav graphs and import one of them",
              in_quotes(name)));
    }
    down_ = true;
    double sum = 0.0;
    std::size_t count = 0;
    const auto measurements = level["measurements"];
    if (measurements.IsDefined() && measurements.IsSequence()) {
      for (const auto measurement : measurements) {
        const auto a = vertex_index(measurement, 0, "a measurement"), b = vertex_index(measurement, 1, "a measurement");
        const double pixels = (raw_position(a) - raw_position(b)).norm();
        const auto words = words_of(measurement, 3, "a measurement [FROM, TO, {ATTRIBUTES}]");
        const auto distance = parameter(words, "distance");
        if (!distance.IsDefined())
          yaml_.refuse(measurement, "the measurement has no distance; add {distance: [3, METRES]}");
        const double metres = yaml_.number(distance, "distance");
        if (!(metres > 0.0 && pixels > 0.0))
          yaml_.refuse(measurement,
                       fmt::format("{} m for {} pixels give no scale; correct the measurement", metres, pixels));
        sum += metres / pixels;
        ++count;
      }
    }
    if (count == 0) return warn(level, "there are no measurements; a pixel is taken as 1 m");
    scale_m_ = sum / static_cast<double>(count);
  }

  Vec2 raw_position(std::size_t vertex) const {
    const auto& node = vertices_[vertex];
    return {yaml_.number(yaml_.item(node, 0, "a vertex"), "x of a vertex"),
            yaml_.number(yaml_.item(node, 1, "a vertex"), "y of a vertex")};
  }

  StationId station_of(std::size_t vertex) {
    if (const auto found = stations_.find(vertex); found != stations_.end()) return found->second;
    const auto& node = vertices_[vertex];
    const auto words = words_of_vertex(node);
    Station station;
    const auto name = is_nav_graph_ ? parameter(words, "name") : node.size() > 3 ? node[3] : YAML::Node();
    station.name = name.IsDefined() && name.IsScalar() ? name.Scalar() : "";
    if (station.name.empty()) station.name = fmt::format("v{}", vertex);
    if (const char* fault = fault_of_name(station.name))
      yaml_.refuse(node, fmt::format("name {}: {}", in_quotes(station.name), fault));
    if (!names_.insert(station.name).second) {
      auto other = fmt::format("v{}", vertex);
      while (!names_.insert(other).second) other += '_';
      warn(node, fmt::format("a second vertex is named {}; it becomes {}", in_quotes(station.name), in_quotes(other)));
      station.name = std::move(other);
    }
    const Vec2 position = raw_position(vertex) * scale_m_;
    station.position_m = {position.x(), down_ ? 0.0 - position.y() : position.y()};
    const auto give = [&](bool given, Purpose purpose) {
      if (given) station.purposes = station.purposes | purpose;
    };
    give(is_set(words, "is_charger"), Purpose::Charging);
    give(is_set(words, "is_parking_spot"), Purpose::Parking);
    give(names_something(words, "pickup_dispenser"), Purpose::Storage);
    give(names_something(words, "dropoff_ingestor"), Purpose::Storage);
    if (names_something(words, "lift_cabin") || names_something(words, "lift"))
      warn(node, fmt::format("vertex {} lies in a lift; here it is part of the floor", in_quotes(station.name)));
    const StationId id{layout_.stations.size()};
    layout_.stations.push_back(std::move(station));
    used_.push_back(vertex);
    read_.vertices.insert(vertex);
    stations_.emplace(vertex, id);
    return id;
  }

  // `place`: in the list of lanes.
  void add_lane(const YAML::Node& lane, std::size_t place) {
    const auto from = vertex_index(lane, 0, "a lane"), to = vertex_index(lane, 1, "a lane");
    const auto words = words_of_lane(lane);
    const auto graph = parameter(words, "graph_idx");
    if (!is_nav_graph_ &&
        (graph.IsDefined() ? yaml_.number(graph, "graph_idx") : 0.0) != static_cast<double>(choice_.graph_idx)) {
      ++told_.other_graphs;
      told_.graphs.insert(graph.IsDefined() ? text_of(words, "graph_idx") : "0");
      return;
    }
    if (from == to) yaml_.refuse(lane, fmt::format("a lane leads from vertex {} to itself; leave it out", from));
    Segment segment;
    segment.from = station_of(from);
    segment.to = station_of(to);
    segment.bidirectional = is_set(words, "bidirectional");
    segment.name = fmt::format("lane {}", lanes_.size());
    if (const auto limit = parameter(words, "speed_limit"); limit.IsDefined()) {
      const double limit_mps = yaml_.number(limit, "speed_limit");
      segment.speed_limit_mps = limit_mps > 0.0 ? limit_mps : 0.0;  // 0, or -1 in older files: none
      if (segment.bidirectional) segment.back_speed_limit_mps = segment.speed_limit_mps;
    }
    say_travel(lane, words, segment);
    say_mutex(words, segment);
    layout_.segments.push_back(std::move(segment));
    lanes_.push_back(lane);
    read_.lanes.insert(place);
  }

  // Along the lane as drawn. A two-way lane is driven back with the other end first, without a turn.
  void say_travel(const YAML::Node& lane, const YAML::Node& words, Segment& segment) {
    for (const char* key : {"orientation", "orientation_constraint"}) {
      const std::string word = text_of(words, key);
      if (word.empty() || word == "none") continue;
      const auto travel = value_of<Travel>(word);
      if (!travel || *travel == Travel::Either) {
        warn(lane, fmt::format("{} asks for the orientation {}, which is unknown here; AGVs drive it nose first",
                               segment.name, in_quotes(word)));
        continue;
      }
      segment.travel = *travel;
      if (!segment.bidirectional) continue;
      segment.back_travel = *travel == Travel::Forward ? Travel::Backward : Travel::Forward;
      told_.other_end_back.push_back(segment.name);
    }
  }

  // All lanes of one mutex group are one block.
  void say_mutex(const YAML::Node& words, Segment& segment) {
    const std::string name = text_of(words, "mutex");
    if (name.empty()) return;
    auto& blocks = layout_.blocks;
    const auto known = std::ranges::find(blocks, name, &SegmentBlock::name);
    segment.blocks.push_back(static_cast<std::uint32_t>(known - blocks.begin()));
    if (known == blocks.end()) blocks.push_back({name, BlockKind::OneVehicle});
  }

  // Empty if there is no such parameter.
  static std::string text_of(const YAML::Node& words, const char* key) {
    const auto value = parameter(words, key);
    return value.IsDefined() && value.IsScalar() ? value.Scalar() : "";
  }

  void refuse_problems(const YAML::Node& level) const {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const std::string_view pointer = problems[0].pointer;
    std::size_t index = 0;
    if (const bool of_segment = pointer.starts_with("/segments/"); of_segment || pointer.starts_with("/stations/")) {
      const auto digits = pointer.substr(10);
      std::from_chars(digits.data(), digits.data() + digits.size(), index);
      yaml_.refuse(of_segment ? lanes_[index] : vertices_[used_[index]],
                   fmt::format("{}: {}", of_segment ? "lane" : "vertex", problems[0].sentence));
    }
    yaml_.refuse(level, problems[0].sentence);
  }

  YamlText yaml_;
  std::vector<std::string>& warnings_;
  const RmfChoice& choice_;
  const YAML::Node root_;
  std::vector<YAML::Node> vertices_, lanes_;  // as in the file; by segment
  bool is_nav_graph_ = false, down_ = false;
  double scale_m_ = 1.0;
  Layout layout_;
  std::map<std::size_t, StationId> stations_;  // by vertex
  std::vector<std::size_t> used_;              // vertex, by station
  std::set<std::string> names_;
  ReadLevel read_;
  struct {
    std::size_t other_graphs = 0;             // lanes
    std::set<std::string> graphs;             // other ones, by number
    std::vector<std::string> other_end_back;  // names of segments
  } told_;
};

}  // namespace

Layout read_rmf(const std::string& path, std::vector<std::string>& warnings, const RmfChoice& choice) {
  return parse_rmf(read_text_file(path), path, warnings, choice);
}

Layout parse_rmf(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                 const RmfChoice& choice) {
  try {
    return LevelReader(text, source, warnings, choice).read();
  } catch (const YAML::Exception& error) {
    // yaml-cpp quotes single bytes and whole names of the file.
    const std::string reason = "not YAML: " + printable(error.msg, 200);
    if (error.mark.is_null()) throw InputError(source, reason);
    throw InputError(fmt::format("{}:{}:{}", source, error.mark.line + 1, error.mark.column + 1), reason);
  }
}

}  // namespace fleetproof
