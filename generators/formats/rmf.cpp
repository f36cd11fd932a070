#include "generators/formats/rmf.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "core/geometry/pose.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/rmf_left_out.hpp"
#include "generators/formats/rmf_words.hpp"
#include "generators/map/antiparallel.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/yaml_text.hpp"

namespace fleetproof {
namespace {

// Vertices of an RMF level that lanes of no length join: they are one station.
class JoinedVertices {
 public:
  void join(std::size_t a, std::size_t b);
  // The smallest of those that are joined with the vertex; most stand alone.
  std::size_t first_of(std::size_t vertex) const;
  // In order; `first` alone if it stands alone. Requires: first_of(first) == first.
  std::vector<std::size_t> members_of(std::size_t first) const;

 private:
  std::map<std::size_t, std::vector<std::size_t>> members_;  // by first
  std::map<std::size_t, std::size_t> first_of_;
};

void JoinedVertices::join(std::size_t a, std::size_t b) {
  auto [first, other] = std::minmax({first_of(a), first_of(b)});
  if (first == other) return;
  auto& all = members_.try_emplace(first, std::vector{first}).first->second;
  for (const std::size_t member : members_of(other)) {
    all.push_back(member);
    first_of_[member] = first;
  }
  std::ranges::sort(all);
  members_.erase(other);
}

std::size_t JoinedVertices::first_of(std::size_t vertex) const {
  const auto found = first_of_.find(vertex);
  return found == first_of_.end() ? vertex : found->second;
}

std::vector<std::size_t> JoinedVertices::members_of(std::size_t first) const {
  const auto found = members_.find(first);
  return found == members_.end() ? std::vector{first} : found->second;
}

struct RmfScale {
  double m_per_pixel = 1.0;
  bool by_fiducials = false;
  std::string sentence{};  // if something else decides than the measurements of the level
};

Vec2 pixel_of(const YamlText& yaml, const YAML::Node& list, const std::string& what) {
  return {yaml.number(yaml.item(list, 0, what), "x of " + what), yaml.number(yaml.item(list, 1, what), "y of " + what)};
}

YAML::Node level_of(const YAML::Node& root, const std::string& name) {
  for (const auto entry : root["levels"]) {
    if (entry.first.Scalar() == name) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

double scale_of_measurement(const YamlText& yaml, const YAML::Node& vertices, const YAML::Node& measurement) {
  const auto pixel = [&](std::size_t end) {
    const auto index =
        yaml.index_below(vertices.size(), yaml.item(measurement, end, "a measurement"), "a measurement names vertex");
    return pixel_of(yaml, vertices[index], "a vertex");
  };
  const double pixels = (pixel(0) - pixel(1)).norm();
  const auto words = attributes_of(yaml, measurement, 3, "a measurement [FROM, TO, {ATTRIBUTES}]");
  const auto distance = parameter(words, "distance");
  if (!distance.IsDefined()) yaml.refuse(measurement, "the measurement has no distance; add {distance: [3, METRES]}");
  const double metres = yaml.number(distance, "distance");
  if (!(metres > 0.0 && pixels > 0.0))
    yaml.refuse(measurement, fmt::format("{} m for {} pixels give no scale; correct the measurement", metres, pixels));
  return metres / pixels;
}

// The mean of the measurements of a level; none: it has none.
std::optional<double> measured_scale(const YamlText& yaml, const YAML::Node& level) {
  const auto measurements = level["measurements"];
  if (!measurements.IsDefined() || !measurements.IsSequence() || measurements.size() == 0) return std::nullopt;
  const auto vertices = yaml.list(level, "vertices", "the level");
  double sum = 0.0;
  for (const auto measurement : measurements) sum += scale_of_measurement(yaml, vertices, measurement);
  return sum / static_cast<double>(measurements.size());
}

// Of the fiducials [X, Y, NAME] that two levels have: where each is on one and on the other.
std::vector<std::pair<Vec2, Vec2>> shared_fiducials(const YamlText& yaml, const YAML::Node& reference,
                                                    const YAML::Node& level) {
  std::vector<std::pair<Vec2, Vec2>> shared;
  const auto there = reference["fiducials"], here = level["fiducials"];
  if (!there.IsDefined() || !here.IsDefined()) return shared;
  const auto name_of = [&](const YAML::Node& fiducial) {
    const auto name = yaml.item(fiducial, 2, "a fiducial");
    return name.IsScalar() ? name.Scalar() : "";
  };
  std::multimap<std::string, Vec2> named;
  for (const auto a : there) {
    if (!name_of(a).empty()) named.emplace(name_of(a), pixel_of(yaml, a, "a fiducial"));
  }
  for (const auto b : here) {
    const auto [begin, end] = named.equal_range(name_of(b));
    for (auto a = begin; a != end; ++a) shared.emplace_back(a->second, pixel_of(yaml, b, "a fiducial"));
  }
  return shared;
}

// Pixels of the level for one of the reference level: the mean over all pairs of fiducials.
std::optional<double> relative_scale(const YamlText& yaml, const YAML::Node& reference, const YAML::Node& level) {
  const auto shared = shared_fiducials(yaml, reference, level);
  double sum = 0.0;
  std::size_t pairs = 0;
  for (std::size_t a = 0; a < shared.size(); ++a) {
    for (std::size_t b = a + 1; b < shared.size(); ++b, ++pairs) {
      const double there = (shared[a].first - shared[b].first).norm(),
                   here = (shared[a].second - shared[b].second).norm();
      for (const auto& [pixels, of] : {std::pair{there, reference}, {here, level}}) {
        if (!(pixels > 0.0))
          yaml.refuse(of["fiducials"], "two fiducials are on one spot, and give no scale; correct them");
      }
      sum += here / there;
    }
  }
  return pairs == 0 ? std::nullopt : std::optional(sum / static_cast<double>(pairs));
}

std::string reference_of(const YamlText& yaml, const YAML::Node& root) {
  const auto named = root["reference_level_name"];
  if (!named.IsDefined() || named.IsNull() || !named.IsScalar()) return root["levels"].begin()->first.Scalar();
  if (!level_of(root, named.Scalar()).IsDefined())
    yaml.refuse(named,
                fmt::format("reference_level_name is {}, but there is no such level", in_quotes(named.Scalar())));
  return named.Scalar();
}

// The scale of a level that is drawn on an image, as Open-RMF computes it. The measurements of the reference level
// decide (reference_level_name, or the first level), and for another level the distances of the fiducials that both
// have. A level that shares less than two fiducials has its own measurements here. Throws InputError at a measurement
// or fiducial that gives no scale.
RmfScale scale_of_level(const YamlText& yaml, const YAML::Node& root, const std::string& level_name) {
  const auto level = level_of(root, level_name);
  const auto own = measured_scale(yaml, level);
  const std::string unmeasured = "there are no measurements; a pixel is taken as 1 m";
  const auto reference_name = reference_of(yaml, root);
  if (reference_name == level_name) return {own.value_or(1.0), false, own ? "" : unmeasured};
  const auto reference = level_of(root, reference_name);
  const auto relative = relative_scale(yaml, reference, level);
  if (!relative)
    return {own.value_or(1.0), false,
            own ? fmt::format("the level shares no two fiducials with reference level {}; its measurements count",
                              in_quotes(reference_name))
                : unmeasured};
  const auto measured = measured_scale(yaml, reference);
  const double scale = measured.value_or(1.0) / *relative;
  return {scale, true,
          fmt::format("by the fiducials that the level shares with reference level {}, a pixel has {:.5g} m{}{}",
                      in_quotes(reference_name), scale,
                      measured ? "" : " (there are no measurements on that level; a pixel of it is taken as 1 m)",
                      own ? fmt::format("; by its measurements, which do not count, {:.5g} m", *own) : "")};
}

constexpr std::size_t kLevelsListed = 50;  // levels in a sentence

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
    if (!level["lanes"].IsDefined()) refuse_choice(level);
    const auto vertices = yaml_.list(level, "vertices", "the level"), lanes = yaml_.list(level, "lanes", "the level");
    for (const auto vertex : vertices) vertices_.push_back(vertex);
    if (vertices_.empty()) yaml_.refuse(vertices, "the level is empty: it has no vertex");
    read_.is_nav_graph = !vertices_[0].IsSequence() || vertices_[0].size() < 3 || vertices_[0][2].IsMap();
    for (const auto& vertex : vertices_) names_.given.insert(given_name(vertex, read_.is_nav_graph));
    if (read_.is_nav_graph && choice_.graph_idx != 0)
      throw InputError(yaml_.source(),
                       fmt::format("is a nav graph, which is one graph alone; leave out graph {}", choice_.graph_idx));
    read_scale(level);
    for (const auto lane : lanes) join_ends(lane);
    std::size_t place = 0;
    for (const auto lane : lanes) add_lane(lane, place++);
    if (layout_.segments.empty()) refuse_choice(lanes);
    if (!told_.other_end_back.empty())
      warn(level, fmt::format("{} two-way lanes ask for an orientation ({}); AGVs drive them back with the other end "
                              "first, without a turn",
                              told_.other_end_back.size(), name_list(told_.other_end_back)));
    if (!told_.joined.empty())
      warn(level, fmt::format("{} lanes have no length; the vertices that they join are one station each ({}){}",
                              read_.lanes_of_no_length.size(), name_list(told_.joined),
                              told_.other_names.empty()
                                  ? ""
                                  : fmt::format("; {} more names of theirs are left out ({})", told_.other_names.size(),
                                                name_list(told_.other_names))));
    if (!told_.in_lifts.empty())
      warn(level, fmt::format("{} vertices lie in lifts ({}); here they are part of the floor", told_.in_lifts.size(),
                              name_list(told_.in_lifts)));
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

  [[noreturn]] void refuse_choice(const YAML::Node& at) const {
    std::vector<std::string> levels;
    for (const auto entry : root_["levels"]) levels.push_back(entry.first.Scalar());
    yaml_.refuse(
        at,
        told_.graphs.empty()
            ? fmt::format("level {} has no lane; add some, or choose another level; levels of the file: {}",
                          in_quotes(read_.name), name_list(levels, kLevelsListed))
            : fmt::format("no lane of level {} belongs to graph {}; graphs of its lanes: {}; levels of the file: {}",
                          in_quotes(read_.name), choice_.graph_idx, fmt::join(told_.graphs, ", "),
                          name_list(levels, kLevelsListed)));
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
    const auto& wanted = read_.name = choice_.level.empty() ? first_with_lanes(levels) : choice_.level;
    for (const auto entry : levels) {
      if (entry.first.Scalar() != wanted) continue;
      if (names.size() > 1)
        warn(levels, fmt::format("of {} levels, {} is read (levels: {})", names.size(), in_quotes(wanted),
                                 name_list(names, kLevelsListed)));
      layout_.name = wanted;
      for (const char* key : {"building_name", "name"}) {
        if (const auto name = root_[key]; name.IsDefined() && name.IsScalar())
          layout_.name = name.Scalar() + " " + wanted;
      }
      return entry.second;
    }
    yaml_.refuse(levels, fmt::format("there is no level {}; levels of the file: {}", in_quotes(wanted),
                                     name_list(names, kLevelsListed)));
  }

  // The first of all, if none has a lane.
  static std::string first_with_lanes(const YAML::Node& levels) {
    for (const auto entry : levels) {
      const auto lanes = entry.second["lanes"];
      if (lanes.IsDefined() && lanes.IsSequence() && lanes.size() > 0) return entry.first.Scalar();
    }
    return levels.begin()->first.Scalar();
  }

  std::size_t vertex_index(const YAML::Node& list, std::size_t at, const char* what) const {
    return yaml_.index_below(vertices_.size(), yaml_.item(list, at, what), fmt::format("{} names vertex", what));
  }

  // Whether the attribute exists and is true. One without a value is not.
  bool is_set(const YAML::Node& words, const char* word) const {
    const auto value = parameter(words, word);
    return value.IsDefined() && !value.IsNull() && yaml_.truth(value, word);
  }

  YAML::Node words_of_lane(const YAML::Node& lane) const {
    return attributes_of(yaml_, lane, 3, "a lane [FROM, TO, {ATTRIBUTES}]");
  }
  YAML::Node words_of_vertex(const YAML::Node& vertex) const {
    return read_.is_nav_graph ? attributes_of(yaml_, vertex, 3, "a vertex [X, Y, {ATTRIBUTES}]")
                              : attributes_of(yaml_, vertex, 5, "a vertex [X, Y, Z, NAME, {ATTRIBUTES}]");
  }

  void read_scale(const YAML::Node& level) {
    if (read_.is_nav_graph) return;
    const auto system = root_["coordinate_system"];
    const auto name = system.IsDefined() && system.IsScalar() ? system.Scalar() : "reference_image";
    if (name == "cartesian_meters") return;
    if (name == "wgs84" || name == "web_mercator") {
      yaml_.refuse(
          system,
          fmt::format(
              "coordinate_system is {}, which needs a map projection; generate nav graphs and import one of them",
              in_quotes(name)));
    }
    if (name != "reference_image")
      yaml_.refuse(system, fmt::format("coordinate_system is {}; here it is reference_image or cartesian_meters",
                                       in_quotes(name)));
    down_ = true;
    const auto scale = scale_of_level(yaml_, root_, read_.name);
    scale_m_ = scale.m_per_pixel;
    read_.by_fiducials = scale.by_fiducials;
    if (!scale.sentence.empty()) warn(level, scale.sentence);
  }

  Vec2 raw_position(std::size_t vertex) const {
    const auto& node = vertices_[vertex];
    return {yaml_.number(yaml_.item(node, 0, "a vertex"), "x of a vertex"),
            yaml_.number(yaml_.item(node, 1, "a vertex"), "y of a vertex")};
  }

  // A name that no vertex has.
  std::string free_name(std::size_t vertex) const {
    auto name = fmt::format("v{}", vertex);
    while (names_.taken.contains(name) || names_.given.contains(name)) name += '_';
    return name;
  }

  // Requires: the vertex is the first of those that are joined with it.
  StationId station_of(std::size_t vertex) {
    if (const auto found = stations_.find(vertex); found != stations_.end()) return found->second;
    const auto& node = vertices_[vertex];
    Station station;
    for (const std::size_t member : joined_.members_of(vertex)) {
      if (station.name.empty()) station.name = given_name(vertices_[member], read_.is_nav_graph);
    }
    if (station.name.empty()) station.name = free_name(vertex);
    if (const char* fault = fault_of_name(station.name))
      yaml_.refuse(node, fmt::format("name {}: {}", in_quotes(station.name), fault));
    if (!names_.taken.insert(station.name).second) {
      auto other = free_name(vertex);
      names_.taken.insert(other);
      warn(node, fmt::format("a second vertex is named {}; it becomes {}", in_quotes(station.name), in_quotes(other)));
      station.name = std::move(other);
    }
    const Vec2 position = raw_position(vertex) * scale_m_;
    station.position_m = {position.x(), down_ ? 0.0 - position.y() : position.y()};
    for (const std::size_t member : joined_.members_of(vertex)) {
      add_purposes(vertices_[member], station);
      const auto name = given_name(vertices_[member], read_.is_nav_graph);
      const bool is_joined = joined_.members_of(vertex).size() > 1;
      if (is_joined && !name.empty() && name != station.name) told_.other_names.push_back(name);
      read_.vertices.insert(member);
    }
    if (joined_.members_of(vertex).size() > 1) told_.joined.push_back(station.name);
    const StationId id{layout_.stations.size()};
    layout_.stations.push_back(std::move(station));
    used_.push_back(vertex);
    stations_.emplace(vertex, id);
    return id;
  }

  void add_purposes(const YAML::Node& vertex, Station& station) {
    const auto words = words_of_vertex(vertex);
    const auto give = [&](bool given, Purpose purpose) {
      if (given) station.purposes = station.purposes | purpose;
    };
    give(is_set(words, "is_charger"), Purpose::Charging);
    give(is_set(words, "is_parking_spot"), Purpose::Parking);
    give(names_something(words, "pickup_dispenser"), Purpose::Storage);
    give(names_something(words, "dropoff_ingestor"), Purpose::Storage);
    if (names_something(words, "lift_cabin") || names_something(words, "lift")) told_.in_lifts.push_back(station.name);
  }

  bool is_of_other_graph(const YAML::Node& graph) const {
    return !read_.is_nav_graph &&
           (graph.IsDefined() ? yaml_.number(graph, "graph_idx") : 0.0) != static_cast<double>(choice_.graph_idx);
  }

  // Of a lane without a length.
  void join_ends(const YAML::Node& lane) {
    const auto from = vertex_index(lane, 0, "a lane"), to = vertex_index(lane, 1, "a lane");
    if (from == to || is_of_other_graph(parameter(words_of_lane(lane), "graph_idx"))) return;
    if ((raw_position(from) - raw_position(to)).norm() * scale_m_ <= kOnTheNode_m) joined_.join(from, to);
  }

  // `place`: in the list of lanes.
  void add_lane(const YAML::Node& lane, std::size_t place) {
    const auto from = vertex_index(lane, 0, "a lane"), to = vertex_index(lane, 1, "a lane");
    const auto words = words_of_lane(lane);
    const auto graph = parameter(words, "graph_idx");
    if (is_of_other_graph(graph)) {
      ++told_.other_graphs;
      told_.graphs.insert(graph.IsDefined() ? text_of(words, "graph_idx") : "0");
      return;
    }
    if (from == to) yaml_.refuse(lane, fmt::format("a lane leads from vertex {} to itself; leave it out", from));
    Segment segment;
    segment.from = station_of(joined_.first_of(from));
    segment.to = station_of(joined_.first_of(to));
    if (segment.from == segment.to) return void(read_.lanes_of_no_length.insert(place));
    segment.bidirectional = is_set(words, "bidirectional");
    segment.name = fmt::format("lane {}", lanes_.size());
    if (const auto limit = parameter(words, "speed_limit"); limit.IsDefined()) {
      segment.speed_limit_mps = speed_limit_mps(limit);
      if (segment.bidirectional) segment.back_speed_limit_mps = segment.speed_limit_mps;
    }
    say_travel(lane, words, segment);
    say_mutex(words, segment);
    layout_.segments.push_back(std::move(segment));
    lanes_.push_back(lane);
    read_.lanes.emplace(place, layout_.segments.back().name);
  }

  double speed_limit_mps(const YAML::Node& limit) const {
    const double given_mps = yaml_.number(limit, "speed_limit");
    if (given_mps == 0.0 || given_mps == -1.0) return 0.0;  // in older files, -1 is none
    if (!(given_mps >= kSlowest && given_mps <= kFastest))
      yaml_.refuse(limit,
                   fmt::format("speed_limit is {}; expected 0 (none), or {} to {} m/s", given_mps, kSlowest, kFastest));
    return given_mps;
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

  // `lane 3 from "A" to "B"`
  std::string name_of_lane(std::size_t index) const {
    const Segment& segment = layout_.segments[index];
    return fmt::format("{} from {} to {}", segment.name, in_quotes(layout_.stations[segment.from.index()].name),
                       in_quotes(layout_.stations[segment.to.index()].name));
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
                   fmt::format("{}: {}", of_segment ? name_of_lane(index) : "vertex", problems[0].sentence));
    }
    yaml_.refuse(level, problems[0].sentence);
  }

  YamlText yaml_;
  std::vector<std::string>& warnings_;
  const RmfChoice& choice_;
  const YAML::Node root_;
  std::vector<YAML::Node> vertices_, lanes_;  // as in the file; by segment
  bool down_ = false;
  double scale_m_ = 1.0;
  Layout layout_;
  JoinedVertices joined_;
  std::map<std::size_t, StationId> stations_;  // by the first of joined vertices
  std::vector<std::size_t> used_;              // vertex, by station
  struct {
    std::set<std::string> taken, given;  // of stations; of vertices
  } names_;
  ReadLevel read_;
  struct {
    std::size_t other_graphs = 0;                  // lanes
    std::vector<std::string> joined, other_names;  // names of stations, and of vertices that are part of one
    std::set<std::string> graphs;                  // other ones, by number
    std::vector<std::string> other_end_back;       // names of segments
    std::vector<std::string> in_lifts;             // names of stations
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
