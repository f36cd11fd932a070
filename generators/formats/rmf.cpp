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
#include "generators/map/plant_size.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
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

// How a level lies on the floor: a pixel (with the y axis up) is turned, scaled and shifted.
struct RmfFrame {
  double m_per_pixel = 1.0;
  Vec2 heading = Vec2(1.0, 0.0);  // of the x axis of the level
  Vec2 shift_m = Vec2::Zero();
  bool by_fiducials = false;
  std::vector<std::string> sentences{};  // if something else decides than measurements that agree

  Vec2 on_the_floor_m(const Vec2& pixel) const { return turned(pixel) * m_per_pixel + shift_m; }
  Vec2 turned(const Vec2& pixel) const {
    return {heading.x() * pixel.x() - heading.y() * pixel.y(), heading.y() * pixel.x() + heading.x() * pixel.y()};
  }
};

constexpr double kAgree = 0.02;       // measurements may differ by this share without a word
constexpr double kNoHeading = 1e-12;  // below this, fiducials say nothing of a turn, or there is none

// The y axis of an image points down. 0.0 - y, because -y would turn 0 into -0.
Vec2 upright(const Vec2& pixel) { return {pixel.x(), 0.0 - pixel.y()}; }

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

// The mean of the measurements of a level; none: it has none. `sentences` receives one if they disagree.
std::optional<double> measured_scale(const YamlText& yaml, const YAML::Node& level,
                                     std::vector<std::string>& sentences) {
  const auto measurements = level["measurements"];
  if (!measurements.IsDefined() || !measurements.IsSequence() || measurements.size() == 0) return std::nullopt;
  const auto vertices = yaml.list(level, "vertices", "the level");
  std::vector<double> scales;
  double sum = 0.0;
  for (const auto measurement : measurements) {
    scales.push_back(scale_of_measurement(yaml, vertices, measurement));
    sum += scales.back();
  }
  const double mean = sum / static_cast<double>(scales.size());
  const auto [low, high] = std::ranges::minmax_element(scales);
  if (*high - *low > kAgree * mean) {
    const auto line = [&](auto scale) {
      return yaml.place(measurements[static_cast<std::size_t>(scale - scales.begin())]);
    };
    sentences.push_back(fmt::format(
        "{} measurements disagree by {:.1f} %: a pixel has {:.5g} m ({}) to {:.5g} m ({}); their mean counts, {:.5g} m",
        scales.size(), (*high - *low) / mean * 100.0, *low, line(low), *high, line(high), mean));
  }
  return mean;
}

// Of the fiducials [X, Y, NAME] that two levels have: where each is on one and on the other, with the y axis up.
std::vector<std::pair<Vec2, Vec2>> shared_fiducials(const YamlText& yaml, const YAML::Node& reference,
                                                    const YAML::Node& level) {
  std::vector<std::pair<Vec2, Vec2>> shared;
  const auto there = reference["fiducials"], here = level["fiducials"];
  if (!there.IsDefined() || !here.IsDefined()) return shared;
  const auto name_of = [&](const YAML::Node& fiducial) {
    const auto name = yaml.item(fiducial, 2, "a fiducial");
    return name.IsScalar() ? name.Scalar() : "";
  };
  const auto place_of = [&](const YAML::Node& fiducial) { return upright(pixel_of(yaml, fiducial, "a fiducial")); };
  std::multimap<std::string, Vec2> named;
  for (const auto a : there) {
    if (!name_of(a).empty()) named.emplace(name_of(a), place_of(a));
  }
  for (const auto b : here) {
    const auto [begin, end] = named.equal_range(name_of(b));
    for (auto a = begin; a != end; ++a) shared.emplace_back(a->second, place_of(b));
  }
  return shared;
}

// How the pixels of a level lie on those of the reference level: the means over all pairs of fiducials.
std::optional<RmfFrame> relative_frame(const YamlText& yaml, const YAML::Node& reference, const YAML::Node& level,
                                       double reference_m_per_pixel) {
  const auto shared = shared_fiducials(yaml, reference, level);
  double sum = 0.0;
  Vec2 heading = Vec2::Zero();
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
      const Vec2 is = (shared[b].second - shared[a].second) / here, seen = (shared[b].first - shared[a].first) / there;
      heading += Vec2(is.dot(seen), cross(is, seen));
    }
  }
  if (pairs == 0) return std::nullopt;
  RmfFrame frame;
  frame.by_fiducials = true;
  frame.m_per_pixel = reference_m_per_pixel / (sum / static_cast<double>(pairs));
  if (heading.norm() > kNoHeading) frame.heading = heading.normalized();
  if (std::abs(frame.heading.y()) < kNoHeading && frame.heading.x() > 0.0) frame.heading = Vec2(1.0, 0.0);
  Vec2 shift_m = Vec2::Zero();
  for (const auto& [there, here] : shared)
    shift_m += there * reference_m_per_pixel - frame.turned(here) * frame.m_per_pixel;
  frame.shift_m = shift_m / static_cast<double>(shared.size());
  return frame;
}

std::string reference_of(const YamlText& yaml, const YAML::Node& root) {
  const auto named = root["reference_level_name"];
  if (!named.IsDefined() || named.IsNull() || !named.IsScalar()) return root["levels"].begin()->first.Scalar();
  if (!level_of(root, named.Scalar()).IsDefined())
    yaml.refuse(named,
                fmt::format("reference_level_name is {}, but there is no such level", in_quotes(named.Scalar())));
  return named.Scalar();
}

// How a level that is drawn on an image lies on the floor, as Open-RMF computes it. The measurements of the reference
// level decide (reference_level_name, or the first level), and for another level the fiducials that both have: they
// scale, turn and shift it. A level that shares less than two fiducials has its own measurements here. Throws
// InputError at a measurement or fiducial that gives no scale.
RmfFrame frame_of_level(const YamlText& yaml, const YAML::Node& root, const std::string& level_name) {
  const auto level = level_of(root, level_name);
  std::vector<std::string> sentences;
  const auto own = measured_scale(yaml, level, sentences);
  const std::string unmeasured = "there are no measurements; a pixel is taken as 1 m";
  const auto reference_name = reference_of(yaml, root);
  const auto by_own = [&](const std::string& sentence) {
    RmfFrame frame;
    frame.m_per_pixel = own.value_or(1.0);
    frame.sentences = std::move(sentences);
    if (!sentence.empty()) frame.sentences.push_back(sentence);
    return frame;
  };
  if (reference_name == level_name) return by_own(own ? "" : unmeasured);
  const auto reference = level_of(root, reference_name);
  std::vector<std::string> of_reference;
  const auto measured = measured_scale(yaml, reference, of_reference);
  auto frame = relative_frame(yaml, reference, level, measured.value_or(1.0));
  if (!frame)
    return by_own(own ? fmt::format("the level shares no two fiducials with reference level {}; its measurements count",
                                    in_quotes(reference_name))
                      : unmeasured);
  frame->sentences = std::move(of_reference);
  frame->sentences.push_back(
      fmt::format("by the fiducials that the level shares with reference level {}, a pixel has {:.5g} m{}{}; they "
                  "shift the level by "
                  "({:.3f}, {:.3f}) m{}",
                  in_quotes(reference_name), frame->m_per_pixel,
                  measured ? "" : " (there are no measurements on that level; a pixel of it is taken as 1 m)",
                  own ? fmt::format("; by its measurements, which do not count, {:.5g} m", *own) : "",
                  frame->shift_m.x(), frame->shift_m.y(),
                  frame->heading.y() == 0.0 && frame->heading.x() > 0.0
                      ? ""
                      : fmt::format(", and turn it: its x axis then points to ({:.4f}, {:.4f})", frame->heading.x(),
                                    frame->heading.y())));
  return *frame;
}

// The line at which a second document of the file begins; 0: it has one. Its parser reads the first.
std::size_t second_document(std::string_view text) {
  TextLines lines(text);
  bool has_first = false;
  std::size_t marker = 0;
  while (const auto line = lines.next()) {
    const bool marks = line->starts_with("---") && (line->size() == 3 || line->substr(3).starts_with(' '));
    if (marks && has_first && marker == 0) marker = lines.number();
    const auto rest = marks ? line->substr(3) : *line;
    const auto first = rest.find_first_not_of(" \t");
    const bool says =
        first != std::string_view::npos && rest[first] != '#' && !rest.starts_with("...") && !rest.starts_with('%');
    if (says && marker > 0) return marker;
    has_first = has_first || says;
  }
  return 0;
}

constexpr std::size_t kLevelsListed = 50;  // levels in a sentence

class LevelReader {
 public:
  LevelReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
              const RmfChoice& choice)
      : yaml_(source), warnings_(warnings), choice_(choice), root_(YAML::Load(std::string(text))) {
    if (const std::size_t line = second_document(text); line > 0)
      warnings.push_back(at_line(source, line) + ": a second document of this file begins; the first alone is read");
  }

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
    shift_far_plant(layout_, yaml_.source(), warnings_);
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
    frame_ = frame_of_level(yaml_, root_, read_.name);
    read_.by_fiducials = frame_.by_fiducials;
    for (const auto& sentence : frame_.sentences) warn(level, sentence);
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
    station.position_m = down_ ? frame_.on_the_floor_m(upright(raw_position(vertex))) : raw_position(vertex);
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
    if ((raw_position(from) - raw_position(to)).norm() * frame_.m_per_pixel <= kOnTheNode_m) joined_.join(from, to);
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
    segment.bidirectional = is_set(words, "bidirectional") || is_set(words, "is_bidirectional");
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
  RmfFrame frame_;
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
  // yaml-cpp reads UTF-16, too, but takes every byte for UTF-8 otherwise.
  if (!text.starts_with("\xff\xfe") && !text.starts_with("\xfe\xff")) require_utf8(text, source);
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
