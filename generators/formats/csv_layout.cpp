#include "generators/formats/csv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <map>

#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/csv_fields.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kNodeColumns[] = {"id", "x", "y", "purposes"};
constexpr std::string_view kEdgeColumns[] = {
    "from", "to", "bidirectional", "name", "control_points", "speed_limit_mps", "back_speed_limit_mps", "width_m"};

constexpr std::string_view kNoPurpose = "none";

struct Property {
  const char* column;
  double Segment::*value;
};
constexpr Property kProperties[] = {{"speed_limit_mps", &Segment::speed_limit_mps},
                                    {"back_speed_limit_mps", &Segment::back_speed_limit_mps},
                                    {"width_m", &Segment::width_m}};

class TableReader {
 public:
  TableReader(std::string_view text, std::string_view source) : lines_(text), source_(source) {}

  Layout read() {
    layout_.name = std::filesystem::path(source_).stem().string();
    if (!is_plain_utf8(layout_.name)) layout_.name = "layout";
    while (const auto line = lines_.next()) {
      if (is_csv_remark(*line)) continue;
      const auto fields = csv_fields(*line, source_, lines_.number());
      if (is_heading(fields)) {
        take_heading(fields);
      } else if (columns_.empty()) {
        refuse("expected a line with the names of the columns first: id,x,y,purposes");
      } else {
        of_edges_ ? add_edge(fields) : add_node(fields);
      }
    }
    if (layout_.stations.empty())
      throw InputError(source_, "has no nodes; expected a line id,x,y,purposes and one line for each node");
    if (layout_.segments.empty())
      throw InputError(source_, "has no edges; expected a line from,to,bidirectional and one line for each edge");
    fit_floor(layout_, 3.0);
    refuse_problems();
    return std::move(layout_);
  }

 private:
  [[noreturn]] void refuse(std::string_view sentence) const {
    throw InputError(at_line(source_, lines_.number()), sentence);
  }

  // Each table has its header at its top. In the rows below, stations may have the names "from" and "to".
  bool is_heading(const std::vector<std::string>& fields) const {
    const auto has = [&](std::string_view name) { return std::ranges::find(fields, name) != fields.end(); };
    if (columns_.empty() && has("id") && has("x") && has("y")) return true;
    return !of_edges_ && has("from") && has("to");
  }

  void take_heading(const std::vector<std::string>& fields) {
    of_edges_ = std::ranges::find(fields, "from") != fields.end();
    const std::span<const std::string_view> known =
        of_edges_ ? std::span<const std::string_view>(kEdgeColumns) : kNodeColumns;
    columns_.clear();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (std::ranges::find(known, fields[i]) == known.end()) {
        refuse(fmt::format("{} is not a column of {}{}", in_quotes(fields[i]), of_edges_ ? "edges" : "nodes",
                           name_hint(fields[i], known)));
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
    if (!read_number(word, value)) refuse(fmt::format("{} is {}; expected a finite number", column, in_quotes(word)));
    return value;
  }

  void check_width(const std::vector<std::string>& fields) const {
    if (fields.size() > columns_.size())
      refuse(fmt::format("the line has {} fields, its table {} columns", fields.size(), columns_.size()));
  }

  void add_node(const std::vector<std::string>& fields) {
    check_width(fields);
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
    check_width(fields);
    Segment segment;
    const auto from = field(fields, "from"), to = field(fields, "to"), both = field(fields, "bidirectional");
    segment.from = station_in(from, "from");
    segment.to = station_in(to, "to");
    segment.name = field(fields, "name");
    if (segment.name.empty()) segment.name = from + "-" + to;
    segment.bidirectional = both == "true" || both == "1";
    if (!segment.bidirectional && !both.empty() && both != "false" && both != "0") {
      refuse(fmt::format("bidirectional is {}; expected true or false", in_quotes(both)));
    }
    std::vector<double> numbers;
    const auto points = field(fields, "control_points");
    for (std::string_view rest = points; !rest.empty();) {
      const auto word = rest.substr(0, rest.find(' '));
      if (!word.empty()) numbers.push_back(number(word, "a number of control_points"));
      rest.remove_prefix(std::min(word.size() + 1, rest.size()));
    }
    if (numbers.size() % 2 != 0)
      refuse(fmt::format("control_points are {} numbers; expected x y x y ...", numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      segment.control_points_m.emplace_back(numbers[i], numbers[i + 1]);
    for (const auto& [column, property] : kProperties) {
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
  bool of_edges_ = false;
  std::map<std::string, std::size_t, std::less<>> columns_;
  std::map<std::string, StationId> stations_;
  std::vector<std::size_t> station_lines_, segment_lines_;
  Layout layout_;
};

std::string quoted(const std::string& text) {
  // A line that begins with # would be a comment.
  if (text.find_first_of(",\"#") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

}  // namespace

Layout read_csv_layout(const std::string& path, std::vector<std::string>& warnings, TwinPaths twins) {
  return parse_csv_layout(read_text_file(path), path, warnings, twins);
}

Layout parse_csv_layout(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                        TwinPaths twins) {
  Layout layout = TableReader(text, source).read();
  settle_twins(layout, twins, source, warnings);
  return layout;
}

std::string to_csv(const Layout& layout) {
  std::string text = "id,x,y,purposes\n";
  for (const auto& s : layout.stations) {
    const auto purposes = purposes_text(s.purposes);
    text += fmt::format("{},{},{},{}\n", quoted(s.name), s.position_m.x(), s.position_m.y(),
                        purposes.empty() ? kNoPurpose : purposes);
  }
  text += "from,to,bidirectional,name,control_points";
  std::vector<Property> shown;
  std::ranges::copy_if(kProperties, std::back_inserter(shown), [&](const Property& property) {
    return std::ranges::any_of(layout.segments, [&](const Segment& s) { return s.*property.value > 0.0; });
  });
  for (const Property& property : shown) text += fmt::format(",{}", property.column);
  text += '\n';
  for (const auto& s : layout.segments) {
    text += fmt::format("{},{},{},{},", quoted(layout.stations.at(s.from.index()).name),
                        quoted(layout.stations.at(s.to.index()).name), s.bidirectional, quoted(s.name));
    for (std::size_t i = 0; i < s.control_points_m.size(); ++i) {
      text += fmt::format("{}{} {}", i > 0 ? " " : "", s.control_points_m[i].x(), s.control_points_m[i].y());
    }
    for (const Property& property : shown)
      text += s.*property.value > 0.0 ? fmt::format(",{}", s.*property.value) : std::string(",");
    text += '\n';
  }
  return text;
}

}  // namespace fleetproof
