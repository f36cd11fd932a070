#include "generators/formats/opentcs_shapes.hpp"

#include <fmt/format.h>
#include <pugixml.hpp>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/base/tolerances.hpp"
#include "generators/formats/rounded_way.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr double kDefaultScale_mm = 50.0;  // of a unit of the drawing, if the model gives no scale

std::string in_capitals(std::string word) {
  for (char& c : word) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return word;
}

class DrawingReader {
 public:
  DrawingReader(const XmlText& xml, const pugi::xml_node& model, std::vector<std::string>& warnings)
      : xml_(xml), model_(model), warnings_(warnings) {}

  OpenTcsDrawing read() {
    const auto layout = model_.child("visualLayout");
    read_scale(layout);
    for (const auto element : layout.children("modelLayoutElement"))
      elements_.emplace(xml_.text(element, "visualizedObjectName"), element);
    for (const auto point : model_.children("point")) add_point(point);
    if (!drawn_twice_.empty())
      warnings_.push_back(
          fmt::format("{}: {} points are drawn at positionX or Y and at xPosition or yPosition, with "
                      "different values ({}); positionX and positionY count",
                      xml_.place(model_), drawn_twice_.size(), name_list(drawn_twice_)));
    for (const auto path : model_.children("path")) add_path(path);
    if (!layout && has_control_points_) {
      warnings_.push_back(fmt::format("{}: there is no <visualLayout>; control points are taken as units of {} mm",
                                      xml_.place(model_), kDefaultScale_mm));
    }
    return std::move(drawing_);
  }

 private:
  void read_scale(const pugi::xml_node& layout) {
    if (!layout) return;
    scale_mm_ = {xml_.number(layout, "scaleX"), xml_.number(layout, "scaleY")};
    if (!(scale_mm_.minCoeff() > 0.0))
      xml_.refuse(
          layout,
          fmt::format("scale {} x {} is not positive; give the millimetres of a unit of the drawing (openTCS: {} x {})",
                      scale_mm_.x(), scale_mm_.y(), kDefaultScale_mm, kDefaultScale_mm));
  }

  // The property of the element that draws `node` in versions 0.0.2 and 0.0.3; null if there is none.
  pugi::xml_node drawn_property(const pugi::xml_node& node, const char* name) const {
    const auto element = elements_.find(node.attribute("name").value());
    if (element == elements_.end()) return {};
    return element->second.find_child_by_attribute("property", "name", name);
  }

  void add_point(const pugi::xml_node& point) {
    const auto layout = point.child("pointLayout");
    const auto name = xml_.text(point, "name");
    for (const auto& [x, y] : {std::pair{"positionX", "positionY"}, {"xPosition", "yPosition"}}) {
      if (!xml_.has(layout, x) && !xml_.has(layout, y)) continue;
      const Vec2 drawn_m = Vec2(xml_.number(layout, x), xml_.number(layout, y)) / 1000.0;
      if (drawing_.points_m.emplace(name, drawn_m).first->second != drawn_m) drawn_twice_.push_back(name);
    }
    const auto x = drawn_property(point, "POSITION_X"), y = drawn_property(point, "POSITION_Y");
    if (!x != !y)
      xml_.refuse(x ? x : y, fmt::format("point {} is drawn with one coordinate; add the other", in_quotes(name)));
    if (x && y) drawing_.points_m.emplace(name, Vec2(xml_.number(x, "value"), xml_.number(y, "value")) / 1000.0);
  }

  void add_path(const pugi::xml_node& path) {
    DrawnPath drawn;
    const auto layout = path.child("pathLayout");
    drawn.connection = in_capitals(layout.attribute("connectionType").as_string("DIRECT"));
    for (const auto point : layout.children("controlPoint"))
      drawn.control_points_m.push_back(in_metres(xml_.number(point, "x"), xml_.number(point, "y")));
    if (!layout) {
      drawn.connection = in_capitals(drawn_property(path, "CONN_TYPE").attribute("value").as_string("DIRECT"));
      if (const auto points = drawn_property(path, "CONTROL_POINTS")) add_old_points(points, drawn);
    }
    const std::size_t expected = drawn.connection == "BEZIER" ? 2 : drawn.connection == "BEZIER_3" ? 5 : 0;
    if (expected > 0 && drawn.control_points_m.size() != expected) {
      xml_.refuse(layout ? layout : path,
                  fmt::format("path {} has {} control points; {} needs {}", in_quotes(path.attribute("name").value()),
                              drawn.control_points_m.size(), drawn.connection, expected));
    }
    has_control_points_ |= !drawn.control_points_m.empty();
    drawing_.paths.emplace(xml_.text(path, "name"), std::move(drawn));
  }

  // "552,-183;550,-180"
  void add_old_points(const pugi::xml_node& property, DrawnPath& drawn) const {
    const auto whole = xml_.text(property, "value");
    std::string_view rest = whole;
    while (!rest.empty()) {
      const auto pair = rest.substr(0, rest.find(';'));
      const auto comma = pair.find(',');
      double x = 0.0, y = 0.0;
      if (comma == std::string_view::npos || !read_number(pair.substr(0, comma), x) ||
          !read_number(pair.substr(comma + 1), y)) {
        xml_.refuse(property,
                    fmt::format("CONTROL_POINTS is {}; expected pairs of numbers, as in \"552,-183;550,-180\"",
                                in_quotes(whole)));
      }
      drawn.control_points_m.push_back(in_metres(x, y));
      rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    }
  }

  // 0.0 - y, because -y would turn 0 into -0.
  Vec2 in_metres(double x, double y) const { return {x * scale_mm_.x() / 1000.0, 0.0 - y * scale_mm_.y() / 1000.0}; }

  const XmlText& xml_;
  const pugi::xml_node model_;
  std::vector<std::string>& warnings_;
  Vec2 scale_mm_ = Vec2::Constant(kDefaultScale_mm);
  std::map<std::string, pugi::xml_node> elements_;  // by the name of what they draw
  bool has_control_points_ = false;
  std::vector<std::string> drawn_twice_;  // names of points
  OpenTcsDrawing drawing_;
};

}  // namespace

OpenTcsDrawing read_drawing(const XmlText& xml, const pugi::xml_node& model, std::vector<std::string>& warnings) {
  return DrawingReader(xml, model, warnings).read();
}

namespace {

RoundedWay rounded(const Layout& layout, const Segment& segment, std::vector<Vec2> via_m) {
  via_m.insert(via_m.begin(), layout.stations[segment.from.index()].position_m);
  via_m.push_back(layout.stations[segment.to.index()].position_m);
  return round_corners(via_m);
}

std::vector<Vec2> turned_round(std::vector<Vec2> points_m) {
  std::ranges::reverse(points_m);
  return points_m;
}

}  // namespace

void OpenTcsShapes::bend(const DrawnPath& drawn, const Layout& layout, Segment& segment) {
  if (drawn.connection == "BEZIER" || drawn.connection == "BEZIER_3") {
    segment.control_points_m = drawn.control_points_m;
    const double kink_rad = largest_kink_rad(segment);
    if (kink_rad <= kKink_rad || kink_rad > kSmoothedKink_rad) return;
    smooth_joints(segment);
    aligned_.push_back(segment.name);
    largest_kink_rad_ = std::max(largest_kink_rad_, kink_rad);
  } else if (drawn.connection == "POLYPATH" && !drawn.control_points_m.empty()) {
    segment.control_points_m = rounded(layout, segment, drawn.control_points_m).control_points_m;
    polylines_.emplace(segment.name, Polyline{segment.from, drawn.control_points_m});
  } else if (drawn.connection == "DIRECT") {
    if (!drawn.control_points_m.empty()) straightened_["DIRECT with control points"].push_back(segment.name);
  } else {
    straightened_[drawn.connection].push_back(segment.name);
  }
}

void OpenTcsShapes::redraw(Layout& layout) const {
  for (Segment& segment : layout.segments) {
    const auto found = polylines_.find(segment.name);
    if (found == polylines_.end()) continue;
    const auto& [from, via_m] = found->second;
    segment.control_points_m =
        rounded(layout, segment, segment.from == from ? via_m : turned_round(via_m)).control_points_m;
  }
}

std::vector<std::string> OpenTcsShapes::sentences(const Layout& layout) const {
  std::vector<std::string> sentences, names;
  for (const auto& [connection, paths] : straightened_)
    sentences.push_back(fmt::format("{} paths are drawn as {}; here they are straight ({})", paths.size(), connection,
                                    name_list(paths)));
  double off_m = 0.0;
  for (const Segment& segment : layout.segments) {
    const auto found = polylines_.find(segment.name);
    if (found == polylines_.end()) continue;
    names.push_back(segment.name);
    off_m = std::max(off_m, rounded(layout, segment, found->second.via_m).off_m);
  }
  if (!names.empty())
    sentences.push_back(
        fmt::format("{} paths are drawn as POLYPATH ({}); here an arc leads round each corner, and passes by it at "
                    "{:.3f} m at most",
                    names.size(), name_list(names), off_m));
  if (!aligned_.empty())
    sentences.push_back(
        fmt::format("the curves of {} paths meet at an angle ({}) of up to {:.3f} rad; their control "
                    "points were aligned",
                    aligned_.size(), name_list(aligned_), largest_kink_rad_));
  return sentences;
}

}  // namespace fleetproof
