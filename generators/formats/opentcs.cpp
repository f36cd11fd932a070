#include "generators/formats/opentcs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/letter_case.hpp"
#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"
#include "generators/formats/heading.hpp"
#include "generators/formats/left_out.hpp"
#include "generators/formats/opentcs_left_out.hpp"
#include "generators/formats/opentcs_positions.hpp"
#include "generators/formats/opentcs_purposes.hpp"
#include "generators/formats/opentcs_shapes.hpp"
#include "generators/formats/opentcs_speeds.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr double kNewestVersion = 7.0;
constexpr double kLargestAngle_deg = 1e5;

constexpr Topic kSpelledTwice{
    "{0} points have a coordinate twice, as positionX or Y and as xPosition or yPosition, with different values ({1}); "
    "positionX and positionY count"};
constexpr Topic kReportPosition{"{0} report positions become stations at which AGVs can stop ({1})"};
constexpr Topic kLockedPath{"{0} locked paths are left out ({1})"};
constexpr Topic kWithoutVelocity{"{0} paths are left out ({1}): both of their velocities are 0"};
constexpr Topic kLockedLocation{"{0} locations are locked ({1}); points linked to them keep their purposes"};
constexpr Topic kUnlinkedLocation{"{0} locations are linked to no point ({1}); no AGV can serve them"};
constexpr Topic kUnknownOperation{
    "links of {0} locations allow no operation that is known here ({1}); their points keep their purposes"};
constexpr Topic kEmptyBlock{"{0} blocks hold no path that is read ({1}); they are left out"};

class ModelReader {
 public:
  ModelReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
              const ReadChoice& choice)
      : xml_(text, source), source_(source), warnings_(warnings), choice_(choice) {}

  Layout read() {
    pugi::xml_document document;
    xml_.load(document);
    const auto model = only_model(document);
    layout_.name = model.attribute("name").as_string("openTCS model");
    check_version(model);
    if (model.child("element")) {
      xml_.refuse(model.child("element"),
                  "this is a drawing of openTCS 3.0 to 4.7 (.opentcs); open it in the plant overview of openTCS 4.8 to "
                  "4.14, which still read it, and save it as a plant model");
    }
    drawing_ = read_drawing(xml_, model, warnings_);
    for (const auto point : model.children("point")) add_point(point);
    if (layout_.stations.empty()) xml_.refuse(model, "the model is empty: it has no <point>");
    for (const auto path : model.children("path")) add_path(path);
    if (layout_.segments.empty()) xml_.refuse(model, "the model has no <path> that may be driven; add or unlock some");
    note_shapes(model);
    for (const auto type : model.children("locationType")) add_location_type(type);
    for (const auto location : model.children("location")) add_location(location);
    note_operations(model);
    for (const auto block : model.children("block")) add_block(block);
    changed_.tell(warnings_);
    shift_far_plant(layout_, source_, warnings_);
    fit_floor(layout_, kFloorMargin_m);
    refuse_problems(model);
    compare_lengths(model);
    for (const auto& sentence : speeds_.sentences(layout_)) warn(model, sentence);
    note_headings(model);
    note_left_out(xml_, model, choice_.takes_vehicles, warnings_);
    settle_twins(layout_, choice_.twins, source_, warnings_);
    return std::move(layout_);
  }

 private:
  void warn(const pugi::xml_node& node, std::string_view sentence) {
    warnings_.push_back(fmt::format("{}: {}", xml_.place(node), sentence));
  }

  pugi::xml_node only_model(const pugi::xml_document& document) const {
    const auto model = document.child("model");
    if (!model) throw InputError(std::string(source_), "has no <model>; expected an openTCS plant model");
    for (const auto other : document.children()) {
      if (other.type() == pugi::node_element && other != model)
        xml_.refuse(other, fmt::format("{} is a second element at the top of the file; XML has one there: remove it",
                                       in_quotes(other.name())));
    }
    return model;
  }

  void check_version(const pugi::xml_node& model) {
    const std::string version = model.attribute("version").as_string();
    double major = 0.0;
    if (!read_number(version.substr(0, version.find('.')), major)) {
      warn(model, fmt::format("version {} is read as version 7", in_quotes(version)));
    } else if (major > kNewestVersion) {
      warn(model, fmt::format("version {} is newer than 7; it is read as version 7", in_quotes(version)));
    }
  }

  // A name that becomes one of the layout.
  std::string name_of_new(const pugi::xml_node& node) {
    auto name = text_of_new(node);
    if (const char* fault = fault_of_name(name)) xml_.refuse(node, fmt::format("name {}: {}", in_quotes(name), fault));
    return name;
  }

  std::string text_of_new(const pugi::xml_node& node) {
    auto name = xml_.text(node, "name");
    if (!taken_[node.name()].insert(name).second)
      xml_.refuse(node, fmt::format("a second <{}> is named {}; rename one", node.name(), in_quotes(name)));
    return name;
  }

  double coordinate_mm(const pugi::xml_node& point, const char* name, const char* old_name) {
    const bool has_old = xml_.has(point, old_name), has_new = xml_.has(point, name);
    const double value_mm = xml_.number(point, has_old && !has_new ? old_name : name);
    if (has_old && has_new && xml_.number(point, old_name) != value_mm)
      changed_.add(kSpelledTwice, xml_.place(point), xml_.text(point, "name"));
    return value_mm;
  }

  void add_point(const pugi::xml_node& point) {
    Station station;
    station.name = name_of_new(point);
    const double x_mm = coordinate_mm(point, "positionX", "xPosition"),
                 y_mm = coordinate_mm(point, "positionY", "yPosition");
    station.position_m = Vec2(x_mm, y_mm) / 1000.0;
    const std::string_view type = point.attribute("type").value();
    station.heading = heading_of(point);
    if (station.heading) headed_.push_back(station.name);
    if (type == "PARK_POSITION") station.purposes = station.purposes | Purpose::Parking;
    if (!type.empty() && type != "PARK_POSITION" && type != "HALT_POSITION" && type != "REPORT_POSITION")
      warn(point, fmt::format("type {} of point {} is unknown here; it is taken as HALT_POSITION", in_quotes(type),
                              in_quotes(station.name)));
    if (type == "REPORT_POSITION") changed_.add(kReportPosition, xml_.place(point), station.name);
    stations_.emplace(station.name, StationId{layout_.stations.size()});
    layout_.stations.push_back(std::move(station));
    nodes_.points.push_back(point);
  }

  // In degrees, counterclockwise from the x axis; NaN: none.
  std::optional<Vec2> heading_of(const pugi::xml_node& point) const {
    const std::string_view angle = point.attribute("vehicleOrientationAngle").as_string("NaN");
    if (same_letters(angle, "NaN") || angle.find_first_not_of(" \t\r\n") == std::string_view::npos) return std::nullopt;
    double angle_deg = 0.0;
    if (!read_number(angle, angle_deg) || !(std::abs(angle_deg) <= kLargestAngle_deg))
      xml_.refuse(point, fmt::format("vehicleOrientationAngle is {}; expected degrees or NaN", in_quotes(angle)));
    return heading_at(angle_deg / 180.0 * kPi);
  }

  void note_headings(const pugi::xml_node& model) {
    const auto torn = settle_headings(layout_);
    if (!torn.empty())
      warn(model, fmt::format("{} points give an orientation with which no path arrives ({}); it is left out, because "
                              "an AGV stands there as it arrives",
                              torn.size(), name_list(torn)));
    std::erase_if(headed_, [&](const std::string& name) { return std::ranges::find(torn, name) != torn.end(); });
    if (headed_.empty()) return;
    warn(model, fmt::format("{} points give the orientation of a vehicle ({}); here AGVs pick, drop, park and charge "
                            "there with this heading alone",
                            headed_.size(), name_list(headed_)));
  }

  StationId station_in(const pugi::xml_node& node, const char* attribute) {
    const auto name = xml_.text(node, attribute);
    if (const auto found = stations_.find(name); found != stations_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& station : layout_.stations) known.push_back(station.name);
    xml_.refuse(node, fmt::format("{} of <{}> is {}, but there is no such point{}", attribute, node.name(),
                                  in_quotes(name), remedy(name, known)));
  }

  static std::string remedy(const std::string& name, const std::vector<std::string_view>& known) {
    const auto nearest = nearest_name(name, known);
    return nearest ? "; did you mean " + in_quotes(*nearest) + "?" : "; add it or correct the name";
  }

  void add_path(const pugi::xml_node& path) {
    Segment segment;
    segment.name = name_of_new(path);
    segment.from = station_in(path, "sourcePoint");
    segment.to = station_in(path, "destinationPoint");
    if (xml_.truth(path, "locked")) return changed_.add(kLockedPath, xml_.place(path), segment.name);
    if (segment.from == segment.to)
      xml_.refuse(path, fmt::format("path {} leads from a point to itself; leave it out", in_quotes(segment.name)));
    shapes_.bend(drawing_.paths.at(segment.name), layout_, segment);
    if (!speeds_.say_travel(path, segment)) return changed_.add(kWithoutVelocity, xml_.place(path), segment.name);
    layout_.segments.push_back(std::move(segment));
    nodes_.paths.push_back(path);
  }

  void note_shapes(const pugi::xml_node& model) {
    const auto moved = settle_positions(layout_, drawing_.points_m, stored_m(), choice_.positions);
    if (!moved.empty()) warn(model, moved);
    join_points(model);
    shapes_.redraw(layout_);
    auto sentences = shapes_.sentences(layout_);
    sentences.push_back(detours_of(layout_));
    for (const auto& sentence : sentences) {
      if (!sentence.empty()) warn(model, sentence);
    }
  }

  StoredLengths stored_m() const {
    StoredLengths lengths_m;
    for (const auto& path : nodes_.paths) {
      double stored_mm = 0.0;
      const bool is_read = read_number(path.attribute("length").value(), stored_mm);
      lengths_m.push_back(is_read ? std::optional(stored_mm / 1000.0) : std::nullopt);
    }
    return lengths_m;
  }

  // No AGV can drive a path between two points on one spot.
  void join_points(const pugi::xml_node& model) {
    const auto lengths_m = stored_m();
    if (const auto bad = spot_with_length(layout_, lengths_m)) {
      const auto& [path, segment] = std::pair(nodes_.paths[*bad], layout_.segments[*bad]);
      const auto name = [&](StationId end) { return in_quotes(layout_.stations[end.index()].name); };
      xml_.refuse(path, fmt::format("<path> {}: it has no length, because its points {} and {} are on one spot{}; move "
                                    "them apart, or leave the path out",
                                    in_quotes(segment.name), name(segment.from), name(segment.to),
                                    lengths_m[*bad] ? fmt::format(" (stored: {:.3f} m)", *lengths_m[*bad]) : ""));
    }
    const auto joined = join_spots(layout_, lengths_m);
    if (joined.sentence.empty()) return;
    warn(model, joined.sentence);
    for (auto& [name, id] : stations_) id = joined.station[id.index()];
    const auto keep = [](std::vector<pugi::xml_node>& nodes, const std::vector<std::size_t>& left) {
      for (std::size_t i = 0; i < left.size(); ++i) nodes[i] = nodes[left[i]];
      nodes.resize(left.size());
    };
    keep(nodes_.points, joined.stations);
    keep(nodes_.paths, joined.segments);
    std::erase_if(headed_, [&](const auto& name) { return !layout_.stations[stations_.at(name).index()].heading; });
  }

  static LocationWords words_of(const pugi::xml_node& type, const pugi::xml_node& operations_in) {
    const auto old_symbol = type.find_child_by_attribute("property", "name", "tcs:defaultLocationTypeSymbol");
    LocationWords words;
    words.name = type.attribute("name").value();
    words.symbol = type.child("locationTypeLayout")
                       .attribute("locationRepresentation")
                       .as_string(old_symbol.attribute("value").as_string());
    for (const auto operation : operations_in.children("allowedOperation"))
      words.operations.emplace_back(operation.attribute("name").value());
    return words;
  }

  void note_operations(const pugi::xml_node& model) {
    std::set<std::string> seen;
    std::vector<std::string> unknown;
    for (const auto& found : model.select_nodes("//allowedOperation")) {
      const std::string name = found.node().attribute("name").value();
      if (seen.insert(name).second && !says_purpose(name, choice_.purposes)) unknown.push_back(name);
    }
    if (!unknown.empty())
      warn(model, fmt::format("{} operations say nothing that is known here ({})", unknown.size(), name_list(unknown)));
  }

  void add_location_type(const pugi::xml_node& type) {
    const auto name = text_of_new(type);
    const auto [purposes, source, overruled] = purpose_of(words_of(type, type), choice_.purposes);
    const std::string_view by = source == nullptr ? "nothing" : source;
    if (by == "nothing")
      warn(type,
           fmt::format("location type \"{0}\" says nothing that is known here; its points keep their purposes, unless "
                       "you name one (--purposes \"{0}=storage\")",
                       printable(name)));
    if (by == "name" || by == "symbol")
      warn(type, fmt::format("the operations of location type {} say nothing that is known here; by its {} it is taken "
                             "to be for {}",
                             in_quotes(name), by, purposes_text(purposes).substr(std::string_view("routing ").size())));
    if (overruled != nullptr)
      warn(type, fmt::format("the {} of location type {} says something else than its operations, which count",
                             overruled, in_quotes(name)));
    location_types_.emplace(name, type);
  }

  void add_location(const pugi::xml_node& location) {
    const auto name = text_of_new(location), type = xml_.text(location, "type");
    const auto found = location_types_.find(type);
    if (found == location_types_.end()) {
      std::vector<std::string_view> known;
      for (const auto& entry : location_types_) known.push_back(entry.first);
      xml_.refuse(location, fmt::format("type of location {} is {}, but there is no such location type{}",
                                        in_quotes(name), in_quotes(type), remedy(type, known)));
    }
    const bool locked = xml_.truth(location, "locked");
    if (locked) changed_.add(kLockedLocation, xml_.place(location), name);
    if (!location.child("link")) changed_.add(kUnlinkedLocation, xml_.place(location), name);
    for (const auto link : location.children("link")) {
      auto& purposes = layout_.stations[station_in(link, "point").index()].purposes;
      const auto words = words_of(found->second, link.child("allowedOperation") ? link : found->second);
      const auto allowed = purpose_of_link(words_of(found->second, found->second), words, choice_.purposes);
      if (!locked) purposes = purposes | allowed.purposes;
      if (allowed.source == kNothingAllowed) changed_.add(kUnknownOperation, xml_.place(link), name);
    }
  }

  // Of the paths that are read. Points and locations in it are told as left out.
  void add_block(const pugi::xml_node& block) {
    SegmentBlock made{name_of_new(block), BlockKind::OneVehicle};
    const std::string_view type = block.attribute("type").as_string("SINGLE_VEHICLE_ONLY");
    if (type == "SAME_DIRECTION_ONLY") made.kind = BlockKind::SameDirection;
    if (type != "SAME_DIRECTION_ONLY" && type != "SINGLE_VEHICLE_ONLY")
      warn(block, fmt::format("type {} of block {} is unknown here; it is taken for one vehicle at a time",
                              in_quotes(type), in_quotes(made.name)));
    const auto number = static_cast<std::uint32_t>(layout_.blocks.size());
    bool holds_one = false;
    for (const auto member : block.children("member")) {
      require_member(member);
      const auto found = std::ranges::find(layout_.segments, member.attribute("name").value(), &Segment::name);
      if (found == layout_.segments.end() || std::ranges::count(found->blocks, number) > 0) continue;
      found->blocks.push_back(number);
      holds_one = true;
    }
    if (holds_one) return layout_.blocks.push_back(std::move(made));
    changed_.add(kEmptyBlock, xml_.place(block), made.name);
  }

  void require_member(const pugi::xml_node& member) {
    if (members_.empty()) {
      for (const char* kind : {"path", "point", "location"}) {
        for (const auto node : member.root().child("model").children(kind))
          members_.insert(node.attribute("name").value());
      }
    }
    const std::string name = member.attribute("name").value();
    if (members_.contains(name)) return;
    xml_.refuse(member, fmt::format("a member of a block is {}, but there is no such path, point or location{}",
                                    in_quotes(name), remedy(name, {members_.begin(), members_.end()})));
  }

  // The place in the file that caused a fault of the finished layout.
  pugi::xml_node origin(std::string_view pointer, const pugi::xml_node& model) const {
    const bool of_segment = pointer.starts_with("/segments/");
    double index = 0.0;
    const auto digits = pointer.substr(std::min(pointer.size(), pointer.find('/', 1) + 1));
    if (!read_number(digits.substr(0, digits.find('/')), index)) return model;
    if (of_segment) return nodes_.paths[static_cast<std::size_t>(index)];
    return pointer.starts_with("/stations/") ? nodes_.points[static_cast<std::size_t>(index)] : model;
  }

  void refuse_problems(const pugi::xml_node& model) {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const auto node = origin(problems[0].pointer, model);
    xml_.refuse(
        node, fmt::format("<{}> {}: {}", node.name(), in_quotes(node.attribute("name").value()), problems[0].sentence));
  }

  void compare_lengths(const pugi::xml_node& model) {
    std::vector<std::string> unreadable, wrong;
    std::string example;
    const auto lengths_m = stored_m();
    for (std::size_t i = 0; i < nodes_.paths.size(); ++i) {
      const auto& name = layout_.segments[i].name;
      const double length_m = segment_curve(layout_, layout_.segments[i]).length_m();
      if (!lengths_m[i]) {
        unreadable.push_back(name);
      } else if (!fits(*lengths_m[i], length_m)) {
        if (wrong.empty()) example = fmt::format("{:.3f} m instead of {:.3f} m", *lengths_m[i], length_m);
        wrong.push_back(name);
      }
    }
    if (!unreadable.empty())
      warn(model, fmt::format("{} paths have no length that can be read ({}); their geometry counts", unreadable.size(),
                              name_list(unreadable)));
    if (!wrong.empty())
      warn(model,
           fmt::format("{} of {} paths are stored with another length than their geometry has, which counts ({}; "
                       "the first with {})",
                       wrong.size(), nodes_.paths.size(), name_list(wrong), example));
  }

  XmlText xml_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  const ReadChoice& choice_;
  OpenTcsDrawing drawing_;
  LeftOutThings changed_;
  OpenTcsShapes shapes_;
  OpenTcsSpeeds speeds_{xml_};
  Layout layout_;
  struct {
    std::vector<pugi::xml_node> points, paths;  // by station, and by segment as long as no two of them are merged
  } nodes_;
  std::vector<std::string> headed_;                     // names of points
  std::map<std::string, std::set<std::string>> taken_;  // names, by element
  std::set<std::string_view> members_;                  // names of all that a block may hold
  std::map<std::string, StationId> stations_;
  std::map<std::string, pugi::xml_node> location_types_;
};

}  // namespace

Layout read_opentcs(const std::string& path, std::vector<std::string>& warnings, const ReadChoice& choice) {
  return parse_opentcs(read_text_file(path), path, warnings, choice);
}

Layout parse_opentcs(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     const ReadChoice& choice) {
  return ModelReader(text, source, warnings, choice).read();
}

}  // namespace fleetproof
