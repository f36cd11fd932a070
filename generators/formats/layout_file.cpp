#include "generators/formats/layout_file.hpp"

#include <fmt/format.h>

#include <map>

#include "core/base/catalogue.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/json_writer.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kLayoutVersion = 1;
constexpr std::string_view kFileKeys[] = {"version", "layout"};
constexpr std::string_view kLayoutKeys[] = {"name", "floor_low_m", "floor_high_m", "stations", "segments", "blocks"};
constexpr std::string_view kStationKeys[] = {"name", "position_m", "purposes", "turning", "heading"};
constexpr std::string_view kSegmentKeys[] = {
    "name",    "from",   "to",     "bidirectional", "control_points_m", "speed_limit_mps", "back_speed_limit_mps",
    "width_m", "blocks", "travel", "back_travel",   "permissions"};
constexpr std::string_view kBlockKeys[] = {"name", "kind"};
constexpr std::string_view kPermissionKeys[] = {"vehicle_type", "load"};

using StationsByName = std::map<std::string, StationId>;

Purposes read_purposes(const JsonReader& reader) {
  Purposes purposes = Purposes::from_bits(0);
  for (const auto& item : reader.items()) {
    const auto word = item.text();
    std::uint8_t bit = 1;
    for (const auto name : kPurposeNames) {
      if (word == name) break;
      bit = static_cast<std::uint8_t>(bit << 1);
    }
    if (bit > static_cast<std::uint8_t>(Purpose::Parking))
      item.refuse("there is no such purpose" + name_hint(word, kPurposeNames));
    purposes = purposes | Purposes::from_bits(bit);
  }
  return purposes;
}

// A value that is one of a few words.
template <HasWords Enum>
Enum read_word(const JsonReader& reader) {
  const auto word = reader.text();
  const auto value = value_of<Enum>(word);
  if (!value) reader.refuse("there is no such word here" + name_hint(word, kWordsOf<Enum>));
  return *value;
}

Station read_station(const JsonReader& reader) {
  reader.expect_object(kStationKeys);
  Station station;
  station.name = reader.at("name").text();
  station.position_m = reader.at("position_m").vector();
  if (const auto purposes = reader.find("purposes")) station.purposes = read_purposes(*purposes);
  reader.read("turning", station.turning);
  if (const auto heading = reader.find("heading")) station.heading = heading->heading();
  return station;
}

StationId station_named(const JsonReader& reader, const StationsByName& stations) {
  const auto name = reader.text();
  if (const auto found = stations.find(name); found != stations.end()) return found->second;
  std::vector<std::string_view> known;
  for (const auto& [other, id] : stations) known.push_back(other);
  const auto nearest = nearest_name(name, known);
  reader.refuse(nearest ? fmt::format("there is no such station; did you mean {}?", in_quotes(*nearest))
                        : "there is no such station");
}

Segment read_segment(const JsonReader& reader, const StationsByName& stations) {
  reader.expect_object(kSegmentKeys);
  Segment segment;
  const auto from = reader.at("from"), to = reader.at("to");
  segment.from = station_named(from, stations);
  segment.to = station_named(to, stations);
  segment.name = from.text() + "-" + to.text();
  reader.read("name", segment.name);
  reader.read("bidirectional", segment.bidirectional);
  if (const auto points = reader.find("control_points_m")) {
    for (const auto& point : points->items()) segment.control_points_m.push_back(point.vector());
  }
  return segment;
}

std::uint32_t block_named(const JsonReader& reader, const std::vector<SegmentBlock>& blocks) {
  const auto name = reader.text();
  const auto found = std::ranges::find(blocks, name, &SegmentBlock::name);
  if (found == blocks.end()) reader.refuse("there is no such block in \"blocks\" of the layout");
  return static_cast<std::uint32_t>(found - blocks.begin());
}

Permission read_permission(const JsonReader& reader) {
  reader.expect_object(kPermissionKeys);
  Permission permission;
  reader.read("vehicle_type", permission.vehicle_type);
  if (const auto load = reader.find("load")) permission.load = read_word<LoadState>(*load);
  return permission;
}

void read_properties(const JsonReader& reader, const std::vector<SegmentBlock>& blocks, Segment& segment) {
  reader.read("speed_limit_mps", segment.speed_limit_mps);
  reader.read("back_speed_limit_mps", segment.back_speed_limit_mps);
  reader.read("width_m", segment.width_m);
  if (const auto travel = reader.find("travel")) segment.travel = read_word<Travel>(*travel);
  if (const auto travel = reader.find("back_travel")) segment.back_travel = read_word<Travel>(*travel);
  if (const auto permissions = reader.find("permissions")) {
    for (const auto& item : permissions->items()) segment.permissions.push_back(read_permission(item));
  }
  const auto names = reader.find("blocks");
  if (!names) return;
  for (const auto& item : names->items()) segment.blocks.push_back(block_named(item, blocks));
  std::ranges::sort(segment.blocks);
  if (std::ranges::adjacent_find(segment.blocks) != segment.blocks.end()) names->refuse("a block is named twice");
}

SegmentBlock read_block(const JsonReader& reader) {
  reader.expect_object(kBlockKeys);
  SegmentBlock block;
  block.name = reader.at("name").text();
  if (const auto kind = reader.find("kind")) block.kind = read_word<BlockKind>(*kind);
  return block;
}

void write_station(JsonWriter& writer, const Station& station) {
  const auto& [name, position_m, purposes, turning, heading] = station;
  writer.open_object(JsonWriter::Style::Line);
  writer.key("name").value(name);
  writer.key("position_m").value(position_m);
  writer.key("purposes").open_array();
  for (std::size_t bit = 0; bit < std::size(kPurposeNames); ++bit) {
    if (purposes.has(static_cast<Purpose>(1 << bit))) writer.value(kPurposeNames[bit]);
  }
  writer.close();
  if (!turning) writer.key("turning").value(turning);
  if (heading) writer.key("heading").value(*heading);
  writer.close();
}

void write_permissions(JsonWriter& writer, const std::vector<Permission>& permissions) {
  writer.key("permissions").open_array();
  for (const auto& [vehicle_type, load] : permissions) {
    writer.open_object(JsonWriter::Style::Line);
    if (!vehicle_type.empty()) writer.key("vehicle_type").value(vehicle_type);
    if (load != LoadState::Any) writer.key("load").value(name_of(load));
    writer.close();
  }
  writer.close();
}

void write_segment(JsonWriter& writer, const Layout& layout, const Segment& segment) {
  const auto& [name, from, to, bidirectional, control_points_m, speed_limit_mps, back_speed_limit_mps, width_m, blocks,
               travel, back_travel, permissions] = segment;
  writer.open_object(JsonWriter::Style::Line);
  writer.key("name").value(name);
  writer.key("from").value(layout.stations.at(from.index()).name);
  writer.key("to").value(layout.stations.at(to.index()).name);
  writer.key("bidirectional").value(bidirectional);
  if (!control_points_m.empty()) {
    writer.key("control_points_m").open_array();
    for (const auto& point : control_points_m) writer.value(point);
    writer.close();
  }
  const auto property = [&](const char* key, double value) {
    if (value > 0.0) writer.key(key).value(value);
  };
  property("speed_limit_mps", speed_limit_mps);
  property("back_speed_limit_mps", back_speed_limit_mps);
  property("width_m", width_m);
  if (!blocks.empty()) {
    writer.key("blocks").open_array();
    for (const std::uint32_t block : blocks) writer.value(layout.blocks.at(block).name);
    writer.close();
  }
  if (travel != Travel::Forward) writer.key("travel").value(name_of(travel));
  if (back_travel != Travel::Forward) writer.key("back_travel").value(name_of(back_travel));
  if (!permissions.empty()) write_permissions(writer, permissions);
  writer.close();
}

void write_block(JsonWriter& writer, const SegmentBlock& block) {
  const auto& [name, kind] = block;
  writer.open_object(JsonWriter::Style::Line);
  writer.key("name").value(name);
  writer.key("kind").value(name_of(kind));
  writer.close();
}

}  // namespace

Layout read_layout(const std::string& path) { return parse_layout(read_text_file(path), path); }

Layout parse_layout(std::string_view text, std::string_view source) {
  const JsonValue root = parse_json(text, source);
  const JsonReader reader(root, source);
  reader.expect_object(kFileKeys);
  if (const auto version = reader.at("version"); version.integer() != kLayoutVersion)
    version.refuse("this program reads version 1");
  return read_layout(reader.at("layout"));
}

Layout read_layout_of_scenario(const std::string& path) {
  const JsonValue root = parse_json(read_text_file(path), path);
  return read_layout(JsonReader(root, path).at("layout"));
}

Layout read_layout(const JsonReader& reader) {
  reader.expect_object(kLayoutKeys);
  Layout layout;
  reader.read("name", layout.name);
  StationsByName by_name;
  for (const auto& item : reader.at("stations").items()) {
    layout.stations.push_back(read_station(item));
    by_name.emplace(layout.stations.back().name, StationId{layout.stations.size() - 1});
  }
  if (const auto blocks = reader.find("blocks")) {
    for (const auto& item : blocks->items()) layout.blocks.push_back(read_block(item));
  }
  for (const auto& item : reader.at("segments").items()) {
    layout.segments.push_back(read_segment(item, by_name));
    read_properties(item, layout.blocks, layout.segments.back());
  }
  if (reader.find("floor_low_m") || reader.find("floor_high_m")) {
    layout.floor_low_m = reader.at("floor_low_m").vector();
    layout.floor_high_m = reader.at("floor_high_m").vector();
  } else {
    fit_floor(layout, kFloorMargin_m);
  }
  const auto problems = problems_of(layout);
  if (!problems.empty()) reader.refuse_below(problems[0].pointer, problems[0].sentence);
  return layout;
}

std::string to_text(const Layout& layout) {
  JsonWriter writer;
  writer.open_object();
  writer.key("version").value(kLayoutVersion);
  writer.key("layout");
  write_layout(writer, layout);
  writer.close();
  return writer.take();
}

void write_layout(JsonWriter& writer, const Layout& layout) {
  const auto& [name, floor_low_m, floor_high_m, stations, segments, blocks] = layout;
  writer.open_object();
  writer.key("name").value(name);
  writer.key("floor_low_m").value(floor_low_m);
  writer.key("floor_high_m").value(floor_high_m);
  writer.key("stations").open_array();
  for (const auto& station : stations) write_station(writer, station);
  writer.close();
  writer.key("segments").open_array();
  for (const auto& segment : segments) write_segment(writer, layout, segment);
  writer.close();
  if (!blocks.empty()) {
    writer.key("blocks").open_array();
    for (const auto& block : blocks) write_block(writer, block);
    writer.close();
  }
  writer.close();
}

}  // namespace fleetproof
