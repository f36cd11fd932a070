#include "generators/formats/grid_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "core/base/error.hpp"
#include "generators/map/layout_check.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kFree = ".GSE", kBlocked = "@OTW", kService = "SE";
constexpr std::size_t kLongestSide = 10'000;
constexpr std::ptrdiff_t kMostFree =
    1 << 20;  // stations take a kilobyte each; the largest published maps have 2^20 cells, blocked ones among them

class MapReader {
 public:
  MapReader(std::string_view text, std::string_view source, std::vector<std::string>& warnings, double pitch_m)
      : text_(text), lines_(text), source_(source), warnings_(warnings), pitch_m_(pitch_m) {}

  Layout read() {
    if (!(pitch_m_ >= 0.1 && pitch_m_ <= 100.0))
      throw InputError(source_, fmt::format("a cell pitch of {} m is not between 0.1 m and 100 m", pitch_m_));
    read_header();
    // The few letters of the header count too.
    if (std::ranges::count_if(text_, [](char c) { return kFree.find(c) != std::string_view::npos; }) > kMostFree) {
      throw InputError(source_, fmt::format("the map has more than {} free cells; cut out a part", kMostFree));
    }
    layout_.name = std::filesystem::path(source_).stem().string();
    if (!is_plain_utf8(layout_.name)) layout_.name = "grid map";
    std::vector<StationId> above(width_), row(width_);  // not valid where blocked
    for (std::size_t r = 0; r < height_; ++r) {
      const auto line = expect_line(fmt::format("row {} of {}", r + 1, height_));
      if (line.size() != width_)
        refuse(fmt::format("row {} has {} cells; the header says width {}", r + 1, line.size(), width_));
      for (std::size_t c = 0; c < width_; ++c) {
        row[c] = cell(line[c], r, c);
        if (!row[c].valid()) continue;
        if (c > 0) join(row[c - 1], row[c]);
        join(above[c], row[c]);
      }
      std::swap(above, row);
    }
    while (const auto line = lines_.next()) {
      if (!line->empty()) refuse(fmt::format("the map has more than the {} rows that its header says", height_));
    }
    if (layout_.segments.empty())
      throw InputError(source_, "no two free cells of the map are neighbours; expected cells with . between @");
    warnings_.push_back(fmt::format("{}: cells are taken to be {} m apart; the map names no charging and no parking{}",
                                    source_, pitch_m_, has_service_ ? "" : ", and no storage (S or E)"));
    if (has_service_)
      warnings_.push_back(
          fmt::format("{}: cells S and E are taken for storage, as in maps of the League of Robot "
                      "Runners; in maps of terrain, S is swamp",
                      source_));
    fit_floor(layout_, kFloorMargin_m);
    if (const auto problems = problems_of(layout_); !problems.empty()) throw InputError(source_, problems[0].sentence);
    return std::move(layout_);
  }

 private:
  [[noreturn]] void refuse(std::string_view sentence) const {
    throw InputError(at_line(source_, lines_.number()), sentence);
  }

  std::string_view expect_line(std::string_view what) {
    const auto line = lines_.next();
    if (!line)
      throw InputError(at_line(source_, lines_.number() + 1),
                       fmt::format("the file ends before {}; is it complete?", what));
    return *line;
  }

  // "type octile", "height H", "width W" in any order, then "map".
  void read_header() {
    while (true) {
      const auto line = expect_line("the line \"map\" of the header");
      if (line == "map") break;
      const auto word = line.substr(0, line.find(' '));
      const auto value = line.substr(std::min(line.size(), word.size() + 1));
      if (word == "type") {
        warnings_.push_back(fmt::format("{}: type {} is left out; here cells are joined on their four sides",
                                        at_line(source_, lines_.number()), in_quotes(value)));
        continue;
      }
      if (word != "height" && word != "width")
        refuse(fmt::format("{} is not a line of a map's header; expected type, height, width or map", in_quotes(line)));
      std::size_t side = 0;
      const auto read = std::from_chars(value.data(), value.data() + value.size(), side);
      if (read.ec != std::errc() || read.ptr != value.data() + value.size() || side == 0 || side > kLongestSide) {
        refuse(fmt::format("{} is {}; expected a whole number from 1 to {}", word, in_quotes(value), kLongestSide));
      }
      (word == "height" ? height_ : width_) = side;
    }
    if (height_ == 0 || width_ == 0) refuse("the header lacks height or width; add both before \"map\"");
  }

  StationId cell(char symbol, std::size_t r, std::size_t c) {
    if (kBlocked.find(symbol) != std::string_view::npos) return {};
    if (kFree.find(symbol) == std::string_view::npos) {
      throw InputError(
          fmt::format("{}:{}:{}", source_, lines_.number(), c + 1),
          fmt::format("cell {} is unknown; free cells are . G S E, blocked ones @ O T W", in_quotes({&symbol, 1})));
    }
    Station station;
    station.name = fmt::format("r{}c{}", r, c);
    station.position_m = Vec2(static_cast<double>(c), static_cast<double>(height_ - 1 - r)) * pitch_m_;
    if (kService.find(symbol) != std::string_view::npos) {
      station.purposes = station.purposes | Purpose::Storage;
      has_service_ = true;
    }
    layout_.stations.push_back(std::move(station));
    return StationId{layout_.stations.size() - 1};
  }

  void join(StationId from, StationId to) {
    if (!from.valid()) return;
    Segment segment;
    segment.name = layout_.stations[from.index()].name + "-" + layout_.stations[to.index()].name;
    segment.from = from;
    segment.to = to;
    segment.bidirectional = true;
    layout_.segments.push_back(std::move(segment));
  }

  std::string_view text_;
  TextLines lines_;
  std::string_view source_;
  std::vector<std::string>& warnings_;
  double pitch_m_;
  std::size_t height_ = 0, width_ = 0;
  bool has_service_ = false;
  Layout layout_;
};

}  // namespace

Layout read_grid_map(const std::string& path, std::vector<std::string>& warnings, double pitch_m) {
  return parse_grid_map(read_text_file(path), path, warnings, pitch_m);
}

Layout parse_grid_map(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                      double pitch_m) {
  require_utf8(text, source);
  return MapReader(text, source, warnings, pitch_m).read();
}

}  // namespace fleetproof
