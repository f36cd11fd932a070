#include "generators/formats/geojson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
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
#include "core/geometry/rectangle.hpp"
#include "core/geometry/rotation.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/formats/nurbs.hpp"
#include "generators/formats/opentcs_purposes.hpp"
#include "generators/formats/rounded_way.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr Topic kGraphParts{"{0} parts of the file are left out ({1}); they change no line"};
constexpr Topic kOtherShapes{"{0} features are no points and no lines ({1}); they are left out"};
constexpr Topic kNoShapes{"{0} features have no geometry (null) and are left out ({1})"};
constexpr Topic kUnusedPoints{"{0} vertices lie on no lane that is read and are left out ({1})"};
constexpr Topic kOtherGraphs{"lanes of {0} other graphs are left out ({1})"};
constexpr Topic kOtherLevels{"features of {0} other levels are left out ({1})"};
constexpr Topic kSharedNames{"{0} names stand at several points ({1}); these points are called by their ids"};
constexpr Topic kSharedIds{"{0} lines have an id that another line has ({1}); they are called so"};
constexpr Topic kLinesOnTheSpot{"{0} lines lead from a point to itself and are left out ({1})"};
constexpr Topic kLineCosts{
    "{0} kinds of costs of lines are left out ({1}); control software chooses its ways by itself"};
constexpr Topic kShares{
    "{0} lines have a speed_limit ({1}), which is a share of an AGV's speed in Nav2; it is left out "
    "(abs_speed_limit, in m/s, is read)"};
constexpr Topic kOperations{"{0} kinds of operations are left out ({1})"};
constexpr Topic kFrames{"points lie in {0} frames ({1}); here they are one"};
constexpr Topic kGraphDetails{"{0} kinds of details are left out ({1})"};
constexpr Topic kTypes{
    "{0} types of points say nothing that is known here ({1}); AGVs only pass these points, unless you name a type "
    "(--purposes \"TYPE=storage\")"};

// What a line calls the points at its ends.
constexpr const char* kEnds[][2] = {{"startid", "endid"},     {"start_id", "end_id"}, {"start_node", "end_node"},
                                    {"startNode", "endNode"}, {"from", "to"},         {"source", "target"}};
constexpr const char* kTypeKeys[] = {"type", "class", "class_type", "category", "purpose", "node_type"};
constexpr std::string_view kCostKeys[] = {"cost", "overridable", "weight", "penalty", "abs_time_taken", "length"};
constexpr std::string_view kReadKeys[] = {"id",
                                          "edge_id",
                                          "node_id",
                                          "name",
                                          "frame",
                                          "metadata",
                                          "operations",
                                          "level_idx",
                                          "graph_idx",
                                          "bidirectional",
                                          "is_charger",
                                          "is_parking_spot",
                                          "pickup_dispenser",
                                          "dropoff_ingestor",
                                          "speed_limit",
                                          "abs_speed_limit",
                                          "feature_type"};
constexpr std::string_view kGraphKeysRead[] = {"type", "name", "site_name", "crs", "features", "preferred_crs"};

// A graph that is so small in its numbers has them in degrees: no plant is 5 cm large, and none 5 km.
constexpr double kSmallInDegrees = 0.05;
// A graph that is so large in its numbers has them in metres, and a smaller one has them not: no plant is 50 km large,
// and none half a metre.
constexpr double kLargeInDegrees = 0.5;

// Radii of the ellipsoid WGS 84; the largest coordinate of Web Mercator.
constexpr double kEquator_m = 6378137.0, kFlatness = 0.00669437999014, kMercatorEdge_m = 20037508.35;

bool found_in(const auto& words, std::string_view word) { return std::ranges::find(words, word) != std::end(words); }

bool is_null(const JsonReader& value) {
  return value.value().shape == JsonValue::Shape::Scalar &&
         std::holds_alternative<std::nullptr_t>(value.value().scalar);
}

// Geographic programs write null where they have no value.
std::optional<JsonReader> said(const std::optional<JsonReader>& object, std::string_view key) {
  if (!object) return std::nullopt;
  auto found = object->find(key);
  return found && !is_null(*found) ? found : std::nullopt;
}

// A number or text, as a name.
std::string name_or_number(const std::optional<JsonReader>& value) {
  if (!value) return "";
  if (value->is_text()) return value->text();
  const double number = value->number();
  return number == std::round(number) && std::abs(number) < 1e15 ? fmt::format("{:.0f}", number)
                                                                 : fmt::format("{}", number);
}

bool is_set(const std::optional<JsonReader>& value) {
  if (!value) return false;
  if (const auto* truth = std::get_if<bool>(&value->value().scalar)) return *truth;
  const auto word = name_or_number(value);
  return !word.empty() && word != "0" && word != "false" && word != "False";
}

Vec2 position_of(const JsonReader& position) {
  const auto numbers = position.items();
  if (numbers.size() < 2) position.refuse("expected a position [x, y]");
  return {numbers[0].number(), numbers[1].number()};
}

// A point or a line of the file.
struct Feature {
  JsonReader whole;
  std::optional<JsonReader> properties;
  std::vector<Vec2> places{};  // as in the file

  std::optional<JsonReader> property(std::string_view key) const { return said(properties, key); }
  // Nav2 keeps what is not its own under "metadata".
  std::optional<JsonReader> detail(std::string_view key) const {
    auto found = property(key);
    if (found) return found;
    const auto metadata = property("metadata");
    return metadata && metadata->value().shape == JsonValue::Shape::Object ? said(metadata, key) : std::nullopt;
  }
  std::string id() const {
    for (const char* key : {"id", "edge_id", "node_id"}) {
      if (const auto found = property(key)) return name_or_number(found);
    }
    return name_or_number(said(whole, "id"));
  }
  std::string type() const {
    for (const char* where : {"feature_type"}) {
      if (const auto found = said(whole, where)) return name_or_number(found);
    }
    return name_or_number(property("feature_type"));
  }
};

// Metres of a degree at a latitude (its cosine and sine), to the east and to the north.
Vec2 metres_of_degree(const Vec2& latitude) {
  const double w2 = 1.0 - kFlatness * latitude.y() * latitude.y();
  const double east_m = kEquator_m / std::sqrt(w2) * latitude.x(),
               north_m = kEquator_m * (1.0 - kFlatness) / (w2 * std::sqrt(w2));
  return Vec2(east_m, north_m) * (kPi / 180.0);
}

// The cosine and sine of the latitude at a height of Web Mercator, which are 1 / cosh and tanh of the height in radii.
// By the series of cosh, whose terms become small soon: the map ends at pi radii.
Vec2 latitude_in_mercator(double y_m) {
  const double y = y_m / kEquator_m;
  double term = 1.0, cosh = 1.0;
  for (int k = 1; k <= 20; ++k) {
    term *= y * y / static_cast<double>(2 * k * (2 * k - 1));
    cosh += term;
  }
  const double cosine = 1.0 / cosh;
  return {cosine, std::copysign(std::sqrt(1.0 - cosine * cosine), y)};
}

bool ends_in(std::string_view name, std::initializer_list<std::string_view> endings) {
  return std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); });
}

class GraphReader {
 public:
  GraphReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
              const GeojsonChoice& choice)
      : tree_(parse_json(text, source)), root_(tree_, source), source_(source), warnings_(warnings), choice_(choice) {}

  Layout read() {
    const auto type = root_.find("type");
    if (!type || !type->is_text() || type->text() != "FeatureCollection" || !root_.find("features"))
      root_.refuse("is no \"FeatureCollection\" with \"features\"; expected a route graph in GeoJSON");
    layout_.name = std::filesystem::path(source_).stem().string();
    for (const char* key : {"site_name", "name"}) {
      if (const auto name = said(root_, key); name && name->is_text() && !name->text().empty())
        layout_.name = name->text();
    }
    if (!is_plain_utf8(layout_.name)) layout_.name = "route graph";
    sort_features();
    choose_level();
    to_metres();
    name_points();
    for (const auto& point : points_) add_point(point);
    for (const auto& line : lines_) add_line(line);
    if (layout_.segments.empty()) refuse_without_lines();
    drop_unused();
    for (const auto& key : root_.value().keys) {
      if (!found_in(kGraphKeysRead, key)) things_.add(kGraphParts, root_.at(key).place(), key);
    }
    things_.tell(warnings_);
    tell_shapes();
    shift_far_plant(layout_, source_, warnings_);
    fit_floor(layout_, kFloorMargin_m);
    refuse_problems();
    settle_twins(layout_, choice_.twins, source_, warnings_);
    return std::move(layout_);
  }

 private:
  void sort_features() {
    std::size_t number = 0;
    for (const auto& item : root_.at("features").items()) {
      ++number;
      const auto geometry = said(item, "geometry");
      const auto shape = geometry ? name_or_number(said(geometry, "type")) : "";
      Feature feature{item, said(item, "properties")};
      is_rmf_ = is_rmf_ || feature.type().starts_with("rmf_");
      if (!geometry) {
        const auto id = feature.id();
        things_.add(kNoShapes, item.place(), id.empty() ? fmt::format("feature {}", number) : id);
        continue;
      }
      const bool is_other =
          is_rmf_ && !feature.type().empty() && feature.type() != "rmf_vertex" && feature.type() != "rmf_lane";
      if (is_other || (shape != "Point" && shape != "LineString" && shape != "MultiLineString")) {
        things_.add(kOtherShapes, item.place(), feature.type().empty() ? shape : feature.type());
        continue;
      }
      const auto coordinates = geometry->at("coordinates");
      if (shape == "Point") {
        feature.places.push_back(position_of(coordinates));
        points_.push_back(std::move(feature));
        continue;
      }
      const auto items = coordinates.items();
      // Some files write a LineString as they write the parts of a MultiLineString.
      const bool in_parts = !items.empty() && !items[0].value().items.empty() &&
                            items[0].value().items[0].shape == JsonValue::Shape::Array;
      const std::vector<JsonReader> parts = in_parts ? items : std::vector<JsonReader>{coordinates};
      for (const auto& part : parts) {
        for (const auto& position : part.items()) feature.places.push_back(position_of(position));
      }
      lines_.push_back(std::move(feature));
    }
    if (points_.empty()) root_.refuse("the graph is empty: it has no feature with a geometry of the type \"Point\"");
  }

  static std::string level_of(const Feature& feature) { return name_or_number(feature.property("level_idx")); }

  // Only sites of Open-RMF have levels.
  void choose_level() {
    auto wanted = choice_.level;
    std::set<std::string> levels;
    for (const auto& line : lines_) levels.insert(level_of(line));
    levels.erase("");
    if (wanted.empty() && levels.size() > 1) wanted = *levels.begin();
    if (wanted.empty()) return;
    if (!levels.contains(wanted))
      root_.refuse(fmt::format("no line lies on level {}; levels of the lines (level_idx): {}", in_quotes(wanted),
                               name_list({levels.begin(), levels.end()}, 50)));
    const auto is_elsewhere = [&](const Feature& feature) {
      const bool elsewhere = level_of(feature) != wanted;
      if (elsewhere) things_.add(kOtherLevels, feature.whole.place(), level_of(feature));
      return elsewhere;
    };
    std::erase_if(points_, is_elsewhere);
    std::erase_if(lines_, is_elsewhere);
  }

  // What a reference system is called; empty if the file names none.
  std::string crs() const {
    const auto crs = said(root_, "crs");
    return crs ? name_or_number(said(said(crs, "properties"), "name")) : "";
  }

  void to_metres() {
    Box box;
    for (const auto* features : {&points_, &lines_}) {
      for (const auto& feature : *features) {
        for (const Vec2& place : feature.places) box.add(place);
      }
    }
    const Vec2 extent = box.high_m - box.low_m;
    const std::string name = crs();
    const double farthest_x = std::max(std::abs(box.low_m.x()), std::abs(box.high_m.x())),
                 farthest_y = std::max(std::abs(box.low_m.y()), std::abs(box.high_m.y()));
    if (ends_in(name, {":3857", ":900913"})) {
      // Route servers give this system to plants of their own, which begin near its origin.
      const bool on_the_globe = std::max(farthest_x, farthest_y) > kLargestCoordinate_m;
      if (on_the_globe && std::max(farthest_x, farthest_y) <= kMercatorEdge_m) return leave_mercator(box);
    }
    const bool geographic = ends_in(name, {"CRS84", ":4326"}) || is_rmf_;
    const bool in_range = farthest_x <= 180.0 && farthest_y <= 90.0;
    if (geographic && (!in_range || extent.maxCoeff() > kLargeInDegrees)) {
      warnings_.push_back(
          fmt::format("{}: the coordinates are no degrees of a plant, although {}; they are taken for "
                      "metres",
                      source_, is_rmf_ ? "sites of Open-RMF have such" : "the crs is " + name));
      return;
    }
    const bool looks_so = name.empty() && extent.maxCoeff() < kSmallInDegrees && box.low_m.cwiseAbs().maxCoeff() > 1.0;
    if (geographic || looks_so) return leave_degrees(box);
    if (in_range && extent.maxCoeff() > 0.0 && extent.maxCoeff() < kLargeInDegrees)
      root_.at("features")
          .refuse(fmt::format("all points are within {:g} x {:g} m: are these degrees of longitude and latitude? Then "
                              "say so (\"crs\": {{\"type\": \"name\", \"properties\": {{\"name\": "
                              "\"urn:ogc:def:crs:OGC:1.3:CRS84\"}}}}), or else write metres",
                              extent.x(), extent.y()));
  }

  // Coordinates become metres from the corner of the plant.
  void scale(const Box& box, const Vec2& scale_m) {
    for (auto* features : {&points_, &lines_}) {
      for (auto& feature : *features) {
        for (Vec2& place : feature.places) place = (place - box.low_m).cwiseProduct(scale_m);
      }
    }
  }

  void leave_degrees(const Box& box) {
    const double middle = (box.low_m.y() + box.high_m.y()) / 2.0;
    scale(box, metres_of_degree(unit_vector(middle / 180.0 * kPi)));
    warnings_.push_back(
        fmt::format("{}: coordinates are taken for degrees of longitude and latitude (WGS 84); here they are metres "
                    "from ({:.7f}, {:.7f})",
                    source_, box.low_m.x(), box.low_m.y()));
  }

  void leave_mercator(const Box& box) {
    const Vec2 latitude = latitude_in_mercator((box.low_m.y() + box.high_m.y()) / 2.0);
    const Vec2 metres = metres_of_degree(latitude) / (kEquator_m * kPi / 180.0);
    scale(box, {metres.x(), metres.y() * latitude.x()});
    warnings_.push_back(
        fmt::format("{}: coordinates are those of Web Mercator (EPSG:3857), which draws everything {:.3f} times too "
                    "large there; here they are metres from ({:.2f}, {:.2f})",
                    source_, 1.0 / metres.x(), box.low_m.x(), box.low_m.y()));
  }

  void name_points() {
    for (const auto& point : points_) {
      const auto name = name_or_number(point.detail("name"));
      if (!name.empty() && !names_.points.insert(name).second) names_.repeated.insert(name);
    }
    for (const auto& point : points_) {
      const auto name = name_or_number(point.detail("name"));
      if (names_.repeated.contains(name)) things_.add(kSharedNames, point.whole.place(), name);
    }
  }

  // Its name, if no other point has it as a name or id; else its id.
  std::string name_of(const Feature& point, std::size_t index) {
    const auto name = name_or_number(point.detail("name")), id = point.id();
    if (!name.empty() && !names_.repeated.contains(name)) return name;
    auto free = id.empty() ? fmt::format("v{}", index) : id;
    while (names_.points.contains(free)) free += '_';
    names_.points.insert(free);
    return free;
  }

  void add_point(const Feature& point) {
    Station station;
    const auto id = point.id();
    if (id.empty() && !is_rmf_) point.whole.refuse("the point has no id; add \"id\" to its properties");
    station.name = name_of(point, layout_.stations.size());
    if (const char* fault = fault_of_name(station.name)) point.whole.refuse(fault);
    if (!id.empty() && !stations_.emplace(id, StationId{layout_.stations.size()}).second)
      point.whole.refuse(fmt::format("the id {} is taken already; give the point another one", in_quotes(id)));
    station.position_m = point.places[0];
    station.purposes = purposes_of(point, station.name);
    note_left_out(point);
    layout_.stations.push_back(std::move(station));
  }

  Purposes purposes_of(const Feature& point, const std::string& name) {
    auto purposes = Purposes(Purpose::Routing);
    const auto give = [&](const char* key, Purpose purpose) {
      if (is_set(point.detail(key))) purposes = purposes | purpose;
    };
    give("is_charger", Purpose::Charging);
    give("is_parking_spot", Purpose::Parking);
    give("pickup_dispenser", Purpose::Storage);
    give("dropoff_ingestor", Purpose::Storage);
    for (const std::string& word : {name, point.id()}) {
      if (const auto own = choice_.purposes.said_of(word)) return *own;
    }
    for (const char* key : kTypeKeys) {
      const auto type = point.detail(key);
      if (!type || !type->is_text()) continue;
      const auto by_type = purpose_of({.name = type->text(), .operations = {}, .symbol = {}}, choice_.purposes);
      purposes = purposes | by_type.purposes;
      if (by_type.source == nullptr) things_.add(kTypes, point.whole.place(), type->text());
    }
    return purposes;
  }

  // By the ids that the line gives, or by the places of its ends.
  StationId end_of(const Feature& line, std::size_t end) {
    for (const auto& keys : kEnds) {
      const auto id = line.property(keys[end]);
      if (!id || !line.property(keys[1 - end])) continue;
      const auto word = name_or_number(id);
      if (const auto found = stations_.find(word); found != stations_.end()) return found->second;
      std::vector<std::string_view> known;
      for (const auto& [other, station] : stations_) known.push_back(other);
      const auto nearest = nearest_name(word, known);
      id->refuse(nearest ? fmt::format("there is no point with this id; did you mean {}?", in_quotes(*nearest))
                         : "there is no point with this id; add it, or correct the id");
    }
    if (line.places.size() < 2)
      line.whole.refuse("the line names no points and has no coordinates; add startid and endid to its properties");
    const Vec2& place_m = end == 0 ? line.places.front() : line.places.back();
    const auto off_m = [&](const Station& station) { return (station.position_m - place_m).squaredNorm(); };
    const auto nearest = std::ranges::min_element(layout_.stations, {}, off_m);
    if (off_m(*nearest) > kAtStation_m * kAtStation_m)
      line.whole.refuse(
          fmt::format("the line {} {:.2f} m beside the nearest point, {}; add startid and endid, or move its end",
                      end == 0 ? "begins" : "ends", std::sqrt(off_m(*nearest)), in_quotes(nearest->name)));
    return StationId{static_cast<std::size_t>(nearest - layout_.stations.begin())};
  }

  void add_line(const Feature& line) {
    if (const auto graph = line.property("graph_idx");
        graph && graph->number() != static_cast<double>(choice_.graph_idx))
      return things_.add(kOtherGraphs, line.whole.place(), name_or_number(graph));
    Segment segment;
    segment.from = end_of(line, 0);
    segment.to = end_of(line, 1);
    const auto id = line.id();
    segment.name = id.empty() ? fmt::format("lane {}", layout_.segments.size()) : id;
    if (segment.from == segment.to) return things_.add(kLinesOnTheSpot, line.whole.place(), segment.name);
    const bool is_second = !names_.lines.insert(segment.name).second;
    while (is_second && !names_.lines.insert(segment.name += '_').second) continue;
    if (is_second) things_.add(kSharedIds, line.whole.place(), segment.name);
    if (const char* fault = fault_of_name(segment.name)) line.whole.refuse(fault);
    segment.bidirectional = is_set(line.detail("bidirectional"));
    bend(line, segment);
    limit_speed(line, segment);
    note_left_out(line);
    layout_.segments.push_back(std::move(segment));
    read_lines_.push_back(line.whole);
  }

  void bend(const Feature& line, Segment& segment) {
    const Vec2 from_m = layout_.stations[segment.from.index()].position_m,
               to_m = layout_.stations[segment.to.index()].position_m;
    auto way_m = line.places;
    if (way_m.size() < 2) return;
    const auto miss_m = [&](const Vec2& begin_m, const Vec2& end_m) {
      return std::max((begin_m - from_m).norm(), (end_m - to_m).norm());
    };
    if (miss_m(way_m.back(), way_m.front()) < std::min(kAtStation_m, miss_m(way_m.front(), way_m.back()))) {
      std::ranges::reverse(way_m);
      told_.turned.push_back(segment.name);
    }
    if (const double beside_m = miss_m(way_m.front(), way_m.back()); beside_m > kOnTheNode_m) {
      told_.beside.push_back(segment.name);
      told_.most_beside_m = std::max(told_.most_beside_m, beside_m);
    }
    // Nav2 itself drives straight, wherever the line is drawn.
    if (way_m.size() > 2 && miss_m(way_m.front(), way_m.back()) > kFarBeside_m) {
      told_.straightened.push_back(segment.name);
      return;
    }
    way_m.front() = from_m;
    way_m.back() = to_m;
    auto [control_points_m, off_m] = round_corners(way_m);
    if (off_m > 0.0) told_.rounded.push_back(segment.name);
    told_.most_off_m = std::max(told_.most_off_m, off_m);
    segment.control_points_m = std::move(control_points_m);
  }

  void limit_speed(const Feature& line, Segment& segment) {
    const auto relative = line.detail("speed_limit");
    const auto limit = is_rmf_ ? relative : line.detail("abs_speed_limit");
    if (relative && !is_rmf_) things_.add(kShares, line.whole.place(), segment.name);
    if (!limit) return;
    const double limit_mps = limit->number();
    if (limit_mps == 0.0 || limit_mps == -1.0) return;
    if (!(limit_mps >= kSlowest && limit_mps <= kFastest))
      limit->refuse(fmt::format("expected 0 (none), or {} to {} m/s", kSlowest, kFastest));
    segment.speed_limit_mps = limit_mps;
    if (segment.bidirectional) segment.back_speed_limit_mps = limit_mps;
  }

  void note_left_out(const Feature& feature) {
    if (const auto frame = feature.property("frame")) frames_.emplace(name_or_number(frame), feature.whole.place());
    if (const auto operations = feature.property("operations")) {
      for (const auto& item : operations->value().shape == JsonValue::Shape::Object
                                  ? operations->value().keys
                                  : std::vector<std::string>{"operations"})
        things_.add(kOperations, operations->place(), item);
    }
    for (const auto& part : {feature.properties, feature.property("metadata")}) {
      if (!part || part->value().shape != JsonValue::Shape::Object) continue;
      for (const auto& key : part->value().keys) note_key(*part, key);
    }
  }

  void note_key(const JsonReader& part, const std::string& key) {
    if (!said(part, key) || found_in(kReadKeys, key) || found_in(kTypeKeys, key)) return;
    for (const auto& keys : kEnds) {
      if (key == keys[0] || key == keys[1]) return;
    }
    things_.add(found_in(kCostKeys, key) ? kLineCosts : kGraphDetails, part.at(key).place(), key);
  }

  [[noreturn]] void refuse_without_lines() const {
    std::set<std::string> graphs;
    for (const auto& line : lines_) graphs.insert(name_or_number(line.property("graph_idx")));
    graphs.erase("");
    root_.at("features")
        .refuse(graphs.empty() ? "the graph has no line between two points; add features with a geometry of the type "
                                 "\"LineString\""
                               : fmt::format("no line belongs to graph {}; graphs of the lines: {}", choice_.graph_idx,
                                             fmt::join(graphs, ", ")));
  }

  // Sites of Open-RMF have the corners of walls among their vertices.
  void drop_unused() {
    if (!is_rmf_) return;
    std::vector<bool> used(layout_.stations.size(), false);
    for (const auto& segment : layout_.segments) used[segment.from.index()] = used[segment.to.index()] = true;
    std::vector<std::size_t> place(used.size(), 0);
    std::vector<Station> kept;
    std::vector<Feature> kept_points;
    for (std::size_t i = 0; i < used.size(); ++i) {
      place[i] = kept.size();
      if (!used[i]) {
        things_.add(kUnusedPoints, points_[i].whole.place(), layout_.stations[i].name);
        continue;
      }
      kept.push_back(std::move(layout_.stations[i]));
      kept_points.push_back(std::move(points_[i]));
    }
    layout_.stations = std::move(kept);
    points_ = std::move(kept_points);
    for (auto& segment : layout_.segments) {
      segment.from = StationId{place[segment.from.index()]};
      segment.to = StationId{place[segment.to.index()]};
    }
  }

  void tell_shapes() {
    const auto tell = [&](const std::vector<std::string>& names, std::string_view sentence, double most_m) {
      const std::size_t count = names.size();
      const auto list = name_list(names);
      if (count > 0)
        warnings_.push_back(
            fmt::format("{}: {}", source_, fmt::vformat(sentence, fmt::make_format_args(count, list, most_m))));
    };
    tell(told_.turned, "{0} lines are drawn from their end to their start ({1}); they are turned round", 0.0);
    tell(told_.beside,
         "{0} lines begin or end beside their points ({1}), by up to {2:.3f} m; they are drawn to the points",
         told_.most_beside_m);
    tell(told_.straightened,
         "{0} lines with corners are drawn elsewhere than their points ({1}); here they lead straight from point to "
         "point",
         0.0);
    tell(
        told_.rounded,
        "{0} lines are drawn with corners ({1}); here an arc leads round each corner, and passes by it at {2:.3f} m at "
        "most (Nav2 itself drives straight from point to point)",
        told_.most_off_m);
    if (frames_.size() < 2) return;
    LeftOutThings frames;
    for (const auto& [frame, place] : frames_) frames.add(kFrames, place, frame);
    frames.tell(warnings_);
  }

  // Refuses the first fault of the finished layout, at the feature that caused it.
  void refuse_problems() const {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const std::string_view pointer = problems[0].pointer;
    const bool of_segment = pointer.starts_with("/segments/"), of_station = pointer.starts_with("/stations/");
    if (!of_segment && !of_station) root_.refuse(problems[0].sentence);
    double index = 0.0;
    const auto digits = pointer.substr(10);
    read_number(digits.substr(0, digits.find('/')), index);
    const auto place = static_cast<std::size_t>(index);
    const JsonReader& whole = of_segment ? read_lines_[place] : points_[place].whole;
    const auto id = said(said(whole, "properties"), "id");
    id.value_or(whole).refuse(problems[0].sentence);
  }

  const JsonValue tree_;
  const JsonReader root_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  const GeojsonChoice& choice_;
  bool is_rmf_ = false;
  Layout layout_;
  std::vector<Feature> points_, lines_;        // points by station
  std::vector<JsonReader> read_lines_;         // by segment, as long as no two segments are merged
  std::map<std::string, StationId> stations_;  // by id
  struct {
    std::set<std::string> points, repeated, lines;  // repeated: of several points
  } names_;
  std::map<std::string, std::string> frames_;  // with the place of their first feature
  struct {
    std::vector<std::string> turned, beside, straightened, rounded;  // names of segments
    double most_beside_m = 0.0, most_off_m = 0.0;
  } told_;
  LeftOutThings things_;
};

}  // namespace

Layout read_geojson(const std::string& path, std::vector<std::string>& warnings, const GeojsonChoice& choice) {
  return parse_geojson(read_text_file(path), path, warnings, choice);
}

Layout parse_geojson(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     const GeojsonChoice& choice) {
  return GraphReader(text, source, warnings, choice).read();
}

}  // namespace fleetproof
