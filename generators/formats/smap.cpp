#include "generators/formats/smap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
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
#include "core/scenario/vehicle_fields.hpp"
#include "generators/formats/heading.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/formats/nurbs.hpp"
#include "generators/formats/rounded_way.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr Topic kMapParts{"{0} parts of the map are left out ({1}); they change no curve"};
constexpr Topic kPointDetails{"{0} kinds of details of points are left out ({1})"};
constexpr Topic kCurveDetails{"{0} kinds of details of curves are left out ({1})"};
constexpr Topic kClasses{
    "{0} classes of points say nothing that is known here ({1}); AGVs only pass these points, unless you name a class "
    "(--purposes \"CLASS=storage\")"};
constexpr Topic kDirections{"{0} curves have a direction other than 0 or 1 ({1}); AGVs drive them nose first"};
constexpr Topic kStyles{"{0} curves have a movestyle other than 0 ({1}); it is left out"};
constexpr Topic kCurveClasses{
    "{0} classes of curves are unknown here ({1}); curves with two control points are taken for "
    "cubic Bezier curves, others for straight lines"};
constexpr Topic kUnfitWeights{
    "{0} curves of the class NURBS6 have weights (z) that are not all positive ({1}); they are drawn with equal ones"};
constexpr Topic kSharedCurveNames{"{0} curves have the name of another curve; they are called {1}"};
constexpr Topic kCurvesOnTheSpot{"{0} curves lead from a point to itself and are left out ({1})"};
constexpr Topic kUnknownBins{"{0} bins stand at no point of the map ({1}); they are left out"};

struct PointClass {
  std::string_view name;
  Purposes purposes;
};
constexpr PointClass kPointClasses[] = {
    {"LocationMark", Purpose::Routing},     {"LandMark", Purpose::Routing},     {"ActionPoint", Purpose::Storage},
    {"TransferLocation", Purpose::Storage}, {"ChargePoint", Purpose::Charging}, {"ParkPoint", Purpose::Parking},
    {"SwitchMap", Purpose::Routing},
};

constexpr std::string_view kMapKeysRead[] = {"header", "advancedPointList", "advancedCurveList", "binLocationsList"};
constexpr std::string_view kPointKeysRead[] = {"className", "instanceName", "pos", "dir", "ignoreDir", "property"};
constexpr std::string_view kCurveKeysRead[] = {"className",   "instanceName", "startPos",    "endPos",  "controlPos1",
                                               "controlPos2", "controlPos3",  "controlPos4", "property"};
constexpr std::string_view kCurvesRead[] = {"StraightPath", "BezierPath", "DegenerateBezier", "ArcPath", "NURBS6"};
constexpr std::string_view kControlKeys[] = {"controlPos1", "controlPos2", "controlPos3", "controlPos4"};

// Maps have whole millimetres, and hundreds of curves: pieces are as near to them as arcs are to curves.
constexpr NearCurve kNearDrawn{kBezierByArcs_m, kHeadingByArcs_rad};

constexpr double kHeaviest = 1e6;  // weight of a control point; editors write 1 or 10

bool listed_in(const auto& words, std::string_view word) { return std::ranges::find(words, word) != std::end(words); }

// The text of base64, which is how every property has its value since before it had one by its type.
std::string decoded(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6U | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xffU);
  }
  return bytes;
}

// The properties of a point or curve, by their keys.
class Properties {
 public:
  explicit Properties(const JsonReader& owner) {
    const auto list = owner.find("property");
    if (!list) return;
    for (const auto& item : list->items()) by_key_.emplace(item.at("key").text(), item);
  }

  std::optional<double> number(const std::string& key) const {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return std::nullopt;
    for (const char* typed : {"doubleValue", "floatValue", "int32Value", "uint32Value"}) {
      if (const auto value = found->second.find(typed)) return value->number();
    }
    double value = 0.0;
    const auto text = encoded(found->second);
    if (!text) return value;  // zeros are left out
    if (!read_number(*text, value)) found->second.refuse(fmt::format("{} is no number", in_quotes(*text)));
    return value;
  }

  std::optional<bool> truth(const std::string& key) const {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return std::nullopt;
    if (const auto value = found->second.find("boolValue")) return value->boolean();
    return encoded(found->second) == "true";
  }

  std::string text(const std::string& key) const {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return "";
    const auto value = found->second.find("stringValue");
    return value && value->is_text() ? value->text() : encoded(found->second).value_or("");
  }

  void note_others(std::initializer_list<std::string_view> read, const Topic& topic, LeftOutThings& things) const {
    for (const auto& [key, item] : by_key_) {
      if (!listed_in(read, key)) things.add(topic, item.place(), key);
    }
  }

 private:
  static std::optional<std::string> encoded(const JsonReader& item) {
    const auto value = item.find("value");
    return value ? std::optional(decoded(value->text())) : std::nullopt;
  }

  std::map<std::string, JsonReader> by_key_;
};

std::string text_at(const JsonReader& object, std::string_view key) {
  const auto found = object.find(key);
  return found ? found->text() : "";
}

double number_at(const JsonReader& object, std::string_view key) {
  const auto found = object.find(key);
  return found ? found->number() : 0.0;
}

// What an error is about: the name of a point or curve, or all of it if it has none.
JsonReader named(const JsonReader& item) { return item.find("instanceName").value_or(item); }

Vec2 pos_of(const JsonReader& pos) {
  if (pos.value().shape != JsonValue::Shape::Object) pos.refuse("expected a place {\"x\": ..., \"y\": ...}");
  return {number_at(pos, "x"), number_at(pos, "y")};
}

class SmapReader {
 public:
  SmapReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
             const ReadChoice& choice)
      : root_(parse_json(text, source)), source_(source), warnings_(warnings), choice_(choice) {}

  Layout read() {
    const JsonReader root(root_, source_);
    if (!root.find("advancedPointList"))
      root.refuse("has no \"advancedPointList\"; expected a map of SEER robots (.smap)");
    layout_.name = std::filesystem::path(source_).stem().string();
    if (const auto header = root.find("header"); header && !text_at(*header, "mapName").empty())
      layout_.name = text_at(*header, "mapName");
    if (!is_plain_utf8(layout_.name)) layout_.name = "map";
    for (const auto& point : root.at("advancedPointList").items()) add_point(point);
    if (const auto groups = root.find("binLocationsList")) add_bins(*groups);
    for (std::size_t i = 0; i < points_.size(); ++i) set_heading(i);
    if (const auto curves = root.find("advancedCurveList")) {
      for (const auto& curve : curves->items()) add_curve(curve);
    }
    if (layout_.segments.empty()) root.refuse("the map has no curve that an AGV can drive; draw some between points");
    for (const auto& key : root.value().keys) {
      if (!listed_in(kMapKeysRead, key)) things_.add(kMapParts, root.at(key).place(), key);
    }
    things_.tell(warnings_);
    if (!beside_.names.empty())
      warn(root.at("advancedCurveList"),
           fmt::format(
               "{} curves begin or end beside their points ({}), by up to {:.3f} m; they are drawn to the points",
               beside_.names.size(), name_list(beside_.names), beside_.most_m));
    shift_far_plant(layout_, source_, warnings_);
    fit_floor(layout_, kFloorMargin_m);
    refuse_problems(root);
    note_headings(root);
    settle_twins(layout_, choice_.twins, source_, warnings_);
    return std::move(layout_);
  }

 private:
  void warn(const JsonReader& at, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", at.place(), sentence));
  }

  void add_point(const JsonReader& point) {
    Station station;
    const auto name = point.at("instanceName");
    station.name = name.text();
    if (const char* fault = fault_of_name(station.name)) name.refuse(fault);
    if (!stations_.emplace(station.name, StationId{layout_.stations.size()}).second)
      name.refuse("this name is taken already; rename one of the points");
    station.position_m = pos_of(point.at("pos"));
    const Properties properties(point);
    station.purposes = purposes_of(point, properties);
    station.turning = properties.truth("allowrotate").value_or(true);
    properties.note_others({"allowrotate", "label"}, kPointDetails, things_);
    for (const auto& key : point.value().keys) {
      if (!listed_in(kPointKeysRead, key)) things_.add(kPointDetails, point.at(key).place(), key);
    }
    layout_.stations.push_back(std::move(station));
    points_.push_back(point);
  }

  Purposes purposes_of(const JsonReader& point, const Properties& properties) {
    const auto kind = text_at(point, "className");
    auto said = choice_.purposes.said_of(kind);
    for (const auto& word : {point.at("instanceName").text(), properties.text("label")}) {
      if (const auto own = choice_.purposes.said_of(word)) said = said.value_or(Purpose::Routing) | *own;
    }
    if (said) return *said;
    const auto known = std::ranges::find(kPointClasses, kind, &PointClass::name);
    if (known != std::end(kPointClasses)) return known->purposes | Purpose::Routing;
    things_.add(kClasses, point.place(), kind);
    return Purpose::Routing;
  }

  void add_bins(const JsonReader& groups) {
    for (const auto& group : groups.items()) {
      const auto bins = group.find("binLocationList");
      if (!bins) continue;
      for (const auto& bin : bins->items()) {
        const auto found = stations_.find(text_at(bin, "pointName"));
        if (found == stations_.end()) {
          things_.add(kUnknownBins, bin.place(), text_at(bin, "instanceName"));
          continue;
        }
        auto& purposes = layout_.stations[found->second.index()].purposes;
        purposes = purposes | Purpose::Storage;
      }
    }
  }

  // Where AGVs only pass, the heading at which they stand decides nothing.
  void set_heading(std::size_t i) {
    const JsonReader& point = points_[i];
    const auto ignored = point.find("ignoreDir");
    if ((ignored && ignored->boolean()) || layout_.stations[i].purposes == Purposes(Purpose::Routing)) return;
    const double angle_rad = number_at(point, "dir");
    if (!(std::abs(angle_rad) <= kLargestHeading_rad)) point.at("dir").refuse("expected an angle in radians");
    layout_.stations[i].heading = heading_at(angle_rad);
  }

  StationId station_in(const JsonReader& end) {
    const auto id = end.at("instanceName");
    const auto name = id.text();
    if (const auto found = stations_.find(name); found != stations_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& station : layout_.stations) known.push_back(station.name);
    const auto nearest = nearest_name(name, known);
    id.refuse(nearest ? fmt::format("there is no such point; did you mean {}?", in_quotes(*nearest))
                      : "there is no such point; add it to advancedPointList, or correct the name");
  }

  // A track that is drawn once for both ways has one name for two curves.
  std::string free_name(const JsonReader& curve, const Segment& segment) {
    const auto ends = layout_.stations[segment.from.index()].name + "-" + layout_.stations[segment.to.index()].name;
    const auto given = text_at(curve, "instanceName");
    if (const char* fault = given.empty() ? nullptr : fault_of_name(given)) curve.at("instanceName").refuse(fault);
    auto name = given.empty() ? ends : given;
    if (names_.insert(name).second) return name;
    name = ends;
    while (!names_.insert(name).second) name += '_';
    things_.add(kSharedCurveNames, curve.place(), name);
    return name;
  }

  void add_curve(const JsonReader& curve) {
    Segment segment;
    segment.from = station_in(curve.at("startPos"));
    segment.to = station_in(curve.at("endPos"));
    if (segment.from == segment.to) return things_.add(kCurvesOnTheSpot, curve.place(), text_at(curve, "instanceName"));
    segment.name = free_name(curve, segment);
    compare_ends(curve, segment);
    bend(curve, segment);
    const Properties properties(curve);
    const double direction = properties.number("direction").value_or(0.0);
    if (direction == 1.0) segment.travel = Travel::Backward;
    if (direction != 0.0 && direction != 1.0) things_.add(kDirections, curve.place(), segment.name);
    if (properties.number("movestyle").value_or(0.0) != 0.0) things_.add(kStyles, curve.place(), segment.name);
    if (const double limit_mps = properties.number("maxspeed").value_or(0.0); limit_mps > 0.0) {
      if (limit_mps < kSlowest)
        named(curve).refuse(fmt::format("maxspeed is {}; expected {} m/s or more", limit_mps, kSlowest));
      if (limit_mps <= kFastest) segment.speed_limit_mps = limit_mps;
    }
    properties.note_others({"direction", "movestyle", "maxspeed"}, kCurveDetails, things_);
    for (const auto& key : curve.value().keys) {
      if (!listed_in(kCurveKeysRead, key)) things_.add(kCurveDetails, curve.at(key).place(), key);
    }
    layout_.segments.push_back(std::move(segment));
    curves_.push_back(curve);
  }

  // The file says twice where a curve begins and ends.
  void compare_ends(const JsonReader& curve, const Segment& segment) {
    const auto place_of = [&](std::string_view key, const Vec2& point_m) {
      const auto place = curve.at(key).find("pos");
      return place ? pos_of(*place) : point_m;
    };
    const Vec2 from_m = layout_.stations[segment.from.index()].position_m,
               to_m = layout_.stations[segment.to.index()].position_m;
    const Vec2 begin_m = place_of("startPos", from_m), end_m = place_of("endPos", to_m);
    if (const auto fault = fault_of_ends(begin_m, end_m, from_m, to_m, "point"); !fault.empty())
      named(curve).refuse(fault);
    const double most_m = std::max((begin_m - from_m).norm(), (end_m - to_m).norm());
    if (most_m <= kOnTheNode_m) return;
    beside_.names.push_back(segment.name);
    beside_.most_m = std::max(beside_.most_m, most_m);
  }

  void bend(const JsonReader& curve, Segment& segment) {
    const auto kind = text_at(curve, "className");
    if (kind == "StraightPath") return;
    std::vector<JsonReader> controls;
    for (const auto key : kControlKeys) {
      if (const auto point = curve.find(key)) controls.push_back(*point);
    }
    const std::size_t needed = kind == "NURBS6" ? 4 : kind == "ArcPath" ? 1 : 2;
    const bool is_known = listed_in(kCurvesRead, kind);
    if (!is_known) things_.add(kCurveClasses, curve.place(), kind);
    if (is_known ? controls.size() < needed : controls.size() != needed) {
      if (is_known)
        named(curve).refuse(
            fmt::format("a curve of the class {} needs {} control points; add {}", kind, needed,
                        needed == 1 ? "controlPos1" : fmt::format("controlPos1 to controlPos{}", needed)));
      return;
    }
    std::vector<Vec2> points_m{layout_.stations[segment.from.index()].position_m};
    for (std::size_t i = 0; i < needed; ++i) points_m.push_back(pos_of(controls[i]));
    points_m.push_back(layout_.stations[segment.to.index()].position_m);
    if (is_straight(points_m)) return;
    if (kind == "ArcPath") {
      segment.control_points_m = arc_through(points_m[0], points_m[1], points_m[2]);
    } else if (kind == "DegenerateBezier") {
      segment.control_points_m = cubic_pieces(with_doubled_controls(points_m), kNearDrawn).control_points_m;
    } else if (kind == "NURBS6") {
      segment.control_points_m = cubic_pieces(nurbs_of(curve, points_m, segment.name), kNearDrawn).control_points_m;
    } else {
      segment.control_points_m = {points_m[1], points_m[2]};
    }
  }

  // A Bezier curve of degree 5 in which each of two control points counts twice.
  static Nurbs with_doubled_controls(const std::vector<Vec2>& p) {
    return {5, {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}, {p[0], p[1], p[1], p[2], p[2], p[3]}, std::vector<double>(6, 1.0)};
  }

  // Of degree 3, with the weights in z. The inner knots are as far apart as three legs each of the control polygon are
  // long.
  Nurbs nurbs_of(const JsonReader& curve, const std::vector<Vec2>& p, const std::string& name) {
    Nurbs nurbs{3, {0, 0, 0, 0}, p, {}};
    std::vector<double> spans;
    for (std::size_t i = 0; i < 3; ++i)
      spans.push_back((p[i + 1] - p[i]).norm() + (p[i + 2] - p[i + 1]).norm() + (p[i + 3] - p[i + 2]).norm());
    const double all = spans[0] + spans[1] + spans[2];
    for (const double knot : {spans[0] / all, (spans[0] + spans[1]) / all, 1.0, 1.0, 1.0, 1.0})
      nurbs.knots.push_back(knot);
    const auto weight = [](const std::optional<JsonReader>& at) { return at ? number_at(*at, "z") : 0.0; };
    nurbs.weights.push_back(weight(curve.at("startPos").find("pos")));
    for (const auto key : kControlKeys) nurbs.weights.push_back(weight(curve.find(key)));
    nurbs.weights.push_back(weight(curve.at("endPos").find("pos")));
    if (std::ranges::all_of(nurbs.weights, [](double w) { return w > 0.0 && w < kHeaviest; })) return nurbs;
    things_.add(kUnfitWeights, curve.place(), name);
    nurbs.weights.assign(6, 1.0);
    return nurbs;
  }

  void note_headings(const JsonReader& root) {
    const auto torn = settle_headings(layout_);
    if (!torn.empty())
      warn(root.at("advancedPointList"),
           fmt::format("{} points ask for a heading with which no curve arrives ({}); it is left out, because an AGV "
                       "stands there as it arrives",
                       torn.size(), name_list(torn)));
  }

  // Refuses the first fault of the finished layout, at the place in the file that caused it.
  void refuse_problems(const JsonReader& root) const {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const std::string_view pointer = problems[0].pointer;
    const bool of_segment = pointer.starts_with("/segments/"), of_station = pointer.starts_with("/stations/");
    if (!of_segment && !of_station) root.refuse(problems[0].sentence);
    double index = 0.0;
    const auto digits = pointer.substr(10);
    read_number(digits.substr(0, digits.find('/')), index);
    const auto& item = (of_segment ? curves_ : points_)[static_cast<std::size_t>(index)];
    named(item).refuse(problems[0].sentence);
  }

  const JsonValue root_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  const ReadChoice& choice_;
  Layout layout_;
  std::vector<JsonReader> points_, curves_;  // by station and by segment, as long as no two segments are merged
  std::map<std::string, StationId> stations_;
  std::set<std::string> names_;  // of segments
  LeftOutThings things_;
  struct {
    std::vector<std::string> names;
    double most_m = 0.0;
  } beside_;
};

}  // namespace

Layout read_smap(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice) {
  return parse_smap(read_text_file(path), path, warnings, choice);
}

Layout parse_smap(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                  const ReadChoice& choice) {
  return SmapReader(text, source, warnings, choice).read();
}

}  // namespace fleetproof
