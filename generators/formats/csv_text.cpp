#include "generators/formats/csv_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "generators/formats/csv_layout.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

// A name as one of the parts.
std::string part_of(std::string_view name) {
  std::string part;
  for (const char c : name) {
    if (c == '|' || c == '\\') part += '\\';
    part += c;
  }
  return part;
}

std::string csv_field(const std::string& text) {
  // A line that begins with # would be a comment.
  if (text.find_first_of(",\"#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

template <class Item>
struct Column {
  const char* name;
  std::function<std::string(const Item&)> text;
  bool always = true;  // else only if some field in it says something
};

std::vector<Column<Station>> node_columns(const Layout&) {
  return {{"id", [](const Station& s) { return csv_field(s.name); }},
          {"x", [](const Station& s) { return fmt::format("{}", s.position_m.x()); }},
          {"y", [](const Station& s) { return fmt::format("{}", s.position_m.y()); }},
          {"purposes",
           [](const Station& s) {
             const auto purposes = purposes_text(s.purposes);
             return purposes.empty() ? std::string(kNoPurpose) : purposes;
           }},
          {"turning", [](const Station& s) { return std::string(s.turning ? "" : "false"); }, false},
          {"heading",
           [](const Station& s) {
             return s.heading ? fmt::format("{} {}", s.heading->x(), s.heading->y()) : std::string();
           },
           false}};
}

std::string points_text(const Segment& segment) {
  std::string text;
  for (const Vec2& point : segment.control_points_m)
    text += fmt::format("{}{} {}", text.empty() ? "" : " ", point.x(), point.y());
  return text;
}

std::string permissions_text(const Segment& segment) {
  std::string text;
  for (const auto& [vehicle_type, load] : segment.permissions)
    text += fmt::format("{}{}:{}", text.empty() ? "" : "|", part_of(vehicle_type), name_of(load));
  return text.empty() ? text : csv_field(text);
}

std::string number_text(double value) { return value > 0.0 ? fmt::format("{}", value) : std::string(); }
std::string travel_text(Travel travel) { return travel == Travel::Forward ? "" : name_of(travel); }

std::vector<Column<Segment>> edge_columns(const Layout& layout) {
  const auto station = [&layout](StationId id) { return csv_field(layout.stations.at(id.index()).name); };
  const auto blocks = [&layout](const Segment& segment) {
    std::string text;
    for (const std::uint32_t number : segment.blocks) {
      const SegmentBlock& block = layout.blocks.at(number);
      text += fmt::format("{}{}:{}", text.empty() ? "" : "|", part_of(block.name), name_of(block.kind));
    }
    return text.empty() ? text : csv_field(text);
  };
  return {{"from", [station](const Segment& s) { return station(s.from); }},
          {"to", [station](const Segment& s) { return station(s.to); }},
          {"bidirectional", [](const Segment& s) { return fmt::format("{}", s.bidirectional); }},
          {"name", [](const Segment& s) { return csv_field(s.name); }},
          {"control_points", points_text},
          {"speed_limit_mps", [](const Segment& s) { return number_text(s.speed_limit_mps); }, false},
          {"back_speed_limit_mps", [](const Segment& s) { return number_text(s.back_speed_limit_mps); }, false},
          {"width_m", [](const Segment& s) { return number_text(s.width_m); }, false},
          {"travel", [](const Segment& s) { return travel_text(s.travel); }, false},
          {"back_travel", [](const Segment& s) { return travel_text(s.back_travel); }, false},
          {"permissions", permissions_text, false},
          {"blocks", blocks, false}};
}

// The edges name their blocks. The table is needed for blocks that have no edge, or another order.
std::string blocks_table(const Layout& layout) {
  std::vector<std::uint32_t> named;
  for (const Segment& segment : layout.segments) {
    for (const std::uint32_t block : segment.blocks) {
      if (std::ranges::find(named, block) == named.end()) named.push_back(block);
    }
  }
  if (named.size() == layout.blocks.size() && std::ranges::is_sorted(named)) return "";
  std::string text = "block,kind\n";
  for (const auto& [name, kind] : layout.blocks) text += fmt::format("{},{}\n", csv_field(name), name_of(kind));
  return text;
}

std::string layout_table(const Layout& layout) {
  const auto name = csv_field(layout.name);
  if (has_fitted_floor(layout)) return fmt::format("layout\n{}\n", name);
  const Vec2 &low = layout.floor_low_m, &high = layout.floor_high_m;
  return fmt::format("layout,low_x,low_y,high_x,high_y\n{},{},{},{},{}\n", name, low.x(), low.y(), high.x(), high.y());
}

template <class Item>
std::string columns_text(const std::vector<Item>& items, std::vector<Column<Item>> columns) {
  std::erase_if(columns, [&](const Column<Item>& column) {
    return !column.always && std::ranges::all_of(items, [&](const Item& item) { return column.text(item).empty(); });
  });
  std::string text;
  const auto line = [&](const auto& field) {
    for (const Column<Item>& column : columns) text += (&column == &columns.front() ? "" : ",") + field(column);
    text += '\n';
  };
  line([](const Column<Item>& column) { return std::string(column.name); });
  for (const Item& item : items) line([&](const Column<Item>& column) { return column.text(item); });
  return text;
}

}  // namespace

std::string to_csv(const Layout& layout) {
  return layout_table(layout) + columns_text(layout.stations, node_columns(layout)) + blocks_table(layout) +
         columns_text(layout.segments, edge_columns(layout));
}

}  // namespace fleetproof
