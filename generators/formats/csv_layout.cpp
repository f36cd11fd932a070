#include "generators/formats/csv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/map/plant_size.hpp"
#include "generators/text/csv_fields.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kNodeColumns[] = {"id", "x", "y", "purposes", "turning", "heading"};
constexpr std::string_view kEdgeColumns[] = {
    "from",    "to",     "bidirectional", "name",        "control_points", "speed_limit_mps", "back_speed_limit_mps",
    "width_m", "travel", "back_travel",   "permissions", "blocks"};

constexpr std::string_view kBlockColumns[] = {"block", "kind"};
constexpr std::string_view kLayoutColumns[] = {"layout", "low_x", "low_y", "high_x", "high_y"};
constexpr auto kFloorColumns = std::span(kLayoutColumns).subspan(1);

enum class Table : std::uint8_t { None, Layout, Nodes, Blocks, Edges };

struct TableColumns {
  const char* rows;
  std::span<const std::string_view> columns;
};
TableColumns columns_of(Table table) {
  if (table == Table::Layout) return {"layouts", kLayoutColumns};
  if (table == Table::Blocks) return {"blocks", kBlockColumns};
  if (table == Table::Edges) return {"edges", kEdgeColumns};
  return {"nodes", kNodeColumns};
}

struct Property {
  const char* column;
  double Segment::*value;
};
constexpr Property kColumnsOfProperties[] = {{"speed_limit_mps", &Segment::speed_limit_mps},
                                             {"back_speed_limit_mps", &Segment::back_speed_limit_mps},
                                             {"width_m", &Segment::width_m}};

// The parts of a text between bars, without empty ones. A bar or backslash after a backslash belongs to a part.
std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '|') {
      parts.emplace_back();
      continue;
    }
    if (text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '|' || text[i + 1] == '\\')) ++i;
    parts.back() += text[i];
  }
  std::erase(parts, "");
  return parts;
}

// The parts of a text between separators, without empty ones.
std::vector<std::string_view> words_of(std::string_view text, char separator) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const auto word = text.substr(0, text.find(separator));
    if (!word.empty()) words.push_back(word);
    text.remove_prefix(std::min(word.size() + 1, text.size()));
  }
  return words;
}

class TableReader {
 public:
  TableReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings)
      : lines_(text), source_(source), warnings_(warnings) {}

  Layout read() {
    layout_.name = std::filesystem::path(source_).stem().string();
    if (!is_plain_utf8(layout_.name)) layout_.name = "layout";
    while (const auto line = lines_.next()) {
      if (is_csv_remark(*line)) continue;
      const auto fields = csv_fields(*line, source_, lines_.number());
      const Table begun = table_begun_by(fields);
      if (begun != Table::None) {
        take_heading(begun, fields);
      } else {
        add_row(fields);
      }
    }
    if (layout_.stations.empty())
      throw InputError(source_, "has no nodes; expected a line id,x,y,purposes and one line for each node");
    if (layout_.segments.empty())
      throw InputError(source_, "has no edges; expected a line from,to,bidirectional and one line for each edge");
    if (!has_floor_) {
      shift_far_plant(layout_, source_, warnings_);
      fit_floor(layout_, kFloorMargin_m);
    }
    refuse_problems();
    return std::move(layout_);
  }

 private:
  [[noreturn]] void refuse(std::string_view sentence) const {
    throw InputError(at_line(source_, lines_.number()), sentence);
  }

  // What is missing, or that the line is no heading at all.
  static std::string headings_hint(const std::vector<std::string>& fields) {
    std::vector<std::string> missing;
    for (const char* name : {"id", "x", "y"}) {
      if (std::ranges::find(fields, name) == fields.end()) missing.emplace_back(name);
    }
    return "missing here: " + name_list(missing);
  }

  // Spreadsheets of many countries write other separators.
  [[noreturn]] void refuse_first_line(const std::vector<std::string>& fields) const {
    const bool other = fields.size() == 1 && fields[0].find_first_of(";\t") != std::string::npos;
    const std::string line = fmt::format("{}", fmt::join(fields, ","));
    refuse(
        fmt::format("the first line is {}; expected the names of the columns first, as in \"id,x,y,purposes\" (id, "
                    "x and y are needed; {}){}",
                    in_quotes(line), headings_hint(fields),
                    other ? "; the separator is a comma, no semicolon and no tabulator" : ""));
  }

  // In their order in the file.
  std::string columns_text() const {
    std::vector<std::string> names(columns_.size());
    for (const auto& [name, place] : columns_) names[place] = name;
    return fmt::format("{}", fmt::join(names, ","));
  }

  // Each table has its header at its top. In the rows below, stations may have the names "from" and "to".
  Table table_begun_by(const std::vector<std::string>& fields) const {
    const auto has = [&](std::string_view name) { return std::ranges::find(fields, name) != fields.end(); };
    if (table_ == Table::None && has("layout")) return Table::Layout;
    const bool has_no_rows = table_ == Table::None || table_ == Table::Layout;
    if (has_no_rows && has("id") && has("x") && has("y")) return Table::Nodes;
    if (table_ != Table::Edges && has("from") && has("to")) return Table::Edges;
    return table_ != Table::Edges && has("block") && has("kind") ? Table::Blocks : Table::None;
  }

  void add_row(const std::vector<std::string>& fields) {
    if (table_ == Table::None) refuse_first_line(fields);
    if (fields.size() > columns_.size())
      refuse(fmt::format(
          "the line {} has {} fields, its table {} columns ({}); a field with a comma stands in double quotes",
          in_quotes(fmt::format("{}", fmt::join(fields, ","))), fields.size(), columns_.size(), columns_text()));
    if (table_ == Table::Layout) return take_layout(fields);
    if (table_ == Table::Nodes) return add_node(fields);
    return table_ == Table::Blocks ? add_block(fields) : add_edge(fields);
  }

  void take_heading(Table table, const std::vector<std::string>& fields) {
    table_ = table;
    const auto& [rows, known] = columns_of(table);
    columns_.clear();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (std::ranges::find(known, fields[i]) == known.end()) {
        refuse(fmt::format("{} is not a column of {}{}", in_quotes(fields[i]), rows, name_hint(fields[i], known)));
      }
      if (!columns_.emplace(fields[i], i).second)
        refuse(fmt::format("column {} occurs twice; keep one", in_quotes(fields[i])));
    }
  }

  // Empty if the column or the field does not exist.
  std::string field(const std::vector<std::string>& fields, std::string_view column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() || found->second >= fields.size() ? "" : fields[found->second];
  }

  double number(std::string_view word, std::string_view column) const {
    double value = 0.0;
    if (!read_number(word, value))
      refuse(fmt::format("{} is {}; expected a finite number{}", column, in_quotes(word),
                         word.find(',') == word.npos ? "" : ", with a point before its decimals"));
    return value;
  }

  std::vector<double> numbers(std::string_view text, std::string_view column) const {
    std::vector<double> found;
    for (const auto word : words_of(text, ' ')) found.push_back(number(word, column));
    return found;
  }

  bool truth(const std::string& word, std::string_view column, bool if_empty) const {
    if (word.empty()) return if_empty;
    if (word == "true" || word == "TRUE" || word == "1") return true;
    if (word == "false" || word == "FALSE" || word == "0") return false;
    refuse(fmt::format("{} is {}; expected true or false", column, in_quotes(word)));
  }

  template <HasWords Enum>
  Enum word(std::string_view text, std::string_view column) const {
    const auto value = value_of<Enum>(text);
    if (!value) refuse(fmt::format("{} is {}{}", column, in_quotes(text), name_hint(text, kWordsOf<Enum>)));
    return *value;
  }

  // "tugger:loaded|:empty": for tuggers with a load, and for every type without one.
  std::vector<Permission> permissions(std::string_view text) const {
    std::vector<Permission> found;
    for (const std::string_view one : parts_of(text)) {
      const auto colon = one.rfind(':');
      if (colon == std::string_view::npos)
        refuse(fmt::format("permission {}; expected TYPE:any, TYPE:empty or TYPE:loaded, with | between them",
                           in_quotes(one)));
      found.push_back({std::string(one.substr(0, colon)), word<LoadState>(one.substr(colon + 1), "a load state")});
    }
    return found;
  }

  // "dock:one-vehicle".
  std::uint32_t block(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos)
      refuse(fmt::format("block {}; expected NAME:one-vehicle or NAME:same-direction, with | between them",
                         in_quotes(text)));
    const SegmentBlock one{std::string(text.substr(0, colon)),
                           word<BlockKind>(text.substr(colon + 1), "a block's kind")};
    const auto known = std::ranges::find(layout_.blocks, one.name, &SegmentBlock::name);
    const auto number = static_cast<std::uint32_t>(known - layout_.blocks.begin());
    if (known == layout_.blocks.end()) {
      layout_.blocks.push_back(one);
    } else if (known->kind != one.kind) {
      refuse(fmt::format("block {} is {} above; a block has one kind", in_quotes(one.name), name_of(known->kind)));
    }
    return number;
  }

  void take_layout(const std::vector<std::string>& fields) {
    if (std::exchange(is_named_, true)) refuse("the table of the layout has a second line; one file holds one layout");
    if (auto name = field(fields, "layout"); !name.empty()) layout_.name = std::move(name);
    has_floor_ =
        std::ranges::any_of(kFloorColumns, [&](std::string_view column) { return !field(fields, column).empty(); });
    if (!has_floor_) return;
    const auto of = [&](std::string_view column) { return number(field(fields, column), column); };
    layout_.floor_low_m = {of("low_x"), of("low_y")};
    layout_.floor_high_m = {of("high_x"), of("high_y")};
  }

  void add_block(const std::vector<std::string>& fields) {
    const SegmentBlock block{field(fields, "block"), word<BlockKind>(field(fields, "kind"), "kind")};
    if (std::ranges::find(layout_.blocks, block.name, &SegmentBlock::name) != layout_.blocks.end())
      refuse(fmt::format("block {} stands above; rename one", in_quotes(block.name)));
    if (const char* fault = fault_of_name(block.name))
      refuse(fmt::format("block {}: {}", in_quotes(block.name), fault));
    layout_.blocks.push_back(block);
  }

  void add_node(const std::vector<std::string>& fields) {
    Station station;
    station.name = field(fields, "id");
    station.position_m = {number(field(fields, "x"), "x"), number(field(fields, "y"), "y")};
    if (const auto words = field(fields, "purposes"); words == kNoPurpose) {
      station.purposes = Purposes::from_bits(0);
    } else if (words.find_first_not_of(' ') != std::string::npos) {
      const auto purposes = purposes_of_text(words);
      if (!purposes)
        refuse(fmt::format("purposes are {}; expected routing, storage, charging or parking, with blanks between them",
                           in_quotes(words)));
      station.purposes = *purposes;
    }
    station.turning = truth(field(fields, "turning"), "turning", true);
    if (const auto heading = numbers(field(fields, "heading"), "heading"); heading.size() == 2) {
      const Vec2 direction(heading[0], heading[1]);
      const double norm = direction.norm();
      if (!(norm > kShortestHeading && norm < 1e9)) refuse("a heading is a direction x y other than 0 0");
      const bool is_unit = std::abs(direction.squaredNorm() - 1.0) <= kUnitVectorToTheLastDigits;
      station.heading = is_unit ? direction : Vec2(direction / norm);
    } else if (!heading.empty()) {
      refuse(fmt::format("heading is {} numbers; expected a direction x y", heading.size()));
    }
    stations_.emplace(station.name, StationId{layout_.stations.size()});
    layout_.stations.push_back(std::move(station));
    station_lines_.push_back(lines_.number());
  }

  StationId station_in(const std::string& name, std::string_view column) const {
    if (const auto found = stations_.find(name); found != stations_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& station : layout_.stations) known.push_back(station.name);
    const auto nearest = nearest_name(name, known);
    refuse(fmt::format("{} is {}, but there is no such node above{}", column, in_quotes(name),
                       nearest ? "; did you mean " + in_quotes(*nearest) + "?" : "; add it or correct the name"));
  }

  void add_edge(const std::vector<std::string>& fields) {
    Segment segment;
    const auto from = field(fields, "from"), to = field(fields, "to"), both = field(fields, "bidirectional");
    segment.from = station_in(from, "from");
    segment.to = station_in(to, "to");
    segment.name = field(fields, "name");
    if (segment.name.empty()) segment.name = from + "-" + to;
    segment.bidirectional = truth(both, "bidirectional", false);
    const auto points = numbers(field(fields, "control_points"), "a number of control_points");
    if (points.size() % 2 != 0)
      refuse(fmt::format("control_points are {} numbers; expected x y x y ...", points.size()));
    for (std::size_t i = 0; i < points.size(); i += 2) segment.control_points_m.emplace_back(points[i], points[i + 1]);
    if (const auto travel = field(fields, "travel"); !travel.empty()) segment.travel = word<Travel>(travel, "travel");
    if (const auto travel = field(fields, "back_travel"); !travel.empty())
      segment.back_travel = word<Travel>(travel, "back_travel");
    segment.permissions = permissions(field(fields, "permissions"));
    const auto blocks = field(fields, "blocks");
    for (const auto& one : parts_of(blocks)) segment.blocks.push_back(block(one));
    std::ranges::sort(segment.blocks);
    if (std::ranges::adjacent_find(segment.blocks) != segment.blocks.end()) refuse("a block is named twice");
    for (const auto& [column, property] : kColumnsOfProperties) {
      if (const auto value = field(fields, column); !value.empty()) segment.*property = number(value, column);
    }
    layout_.segments.push_back(std::move(segment));
    segment_lines_.push_back(lines_.number());
  }

  void refuse_problems() const {
    const auto problems = problems_of(layout_);
    if (problems.empty()) return;
    const auto& [kind, pointer, sentence] = problems[0];
    const bool of_segment = pointer.starts_with("/segments/");
    if (!of_segment && !pointer.starts_with("/stations/")) throw InputError(source_, sentence);
    std::size_t index = 0;
    std::from_chars(pointer.data() + 10, pointer.data() + pointer.size(), index);
    const auto& name = of_segment ? layout_.segments[index].name : layout_.stations[index].name;
    throw InputError(at_line(source_, of_segment ? segment_lines_[index] : station_lines_[index]),
                     fmt::format("{} {}: {}", of_segment ? "edge" : "node", in_quotes(name), sentence));
  }

  TextLines lines_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  Table table_ = Table::None;
  bool is_named_ = false, has_floor_ = false;
  std::map<std::string, std::size_t, std::less<>> columns_;
  std::map<std::string, StationId> stations_;
  std::vector<std::size_t> station_lines_, segment_lines_;
  Layout layout_;
};

}  // namespace

Layout read_csv_layout(const std::string& path, std::vector<std::string>& warnings, TwinPaths twins) {
  return parse_csv_layout(read_text_file(path), path, warnings, twins);
}

Layout parse_csv_layout(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                        TwinPaths twins) {
  require_utf8(text, source);
  Layout layout = TableReader(text, source, warnings).read();
  settle_twins(layout, twins, source, warnings);
  return layout;
}

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
