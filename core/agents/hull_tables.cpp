#include "core/agents/hull_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/fleet.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kGridRounding_m = 1e-3;

}  // namespace

Box Box::around(const Shape& shape) {
  const Vec along = shape.axis * shape.half_length_m, across = left_of(shape.axis) * shape.half_width_m;
  const Vec half{std::abs(along.x) + std::abs(across.x) + shape.radius_m,
                 std::abs(along.y) + std::abs(across.y) + shape.radius_m};
  return {shape.centre_m - half, shape.centre_m + half};
}

PartsNear::PartsNear(std::vector<Box> boxes, double distance_m) : own_boxes_(std::move(boxes)), boxes_(own_boxes_) {
  grid_.distance_m = distance_m + kGridRounding_m;
  choose_cells();
  own_begin_.assign(std::size_t{grid_.columns} * grid_.rows + 1, 0);
  for (std::uint32_t part = 0; part < boxes_.size(); ++part)
    for_cells_of(part, [&](std::uint32_t cell) { ++own_begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < own_begin_.size(); ++cell) own_begin_[cell] += own_begin_[cell - 1];
  own_parts_.resize(own_begin_.back());
  std::vector<std::uint32_t> next(own_begin_.begin(), own_begin_.end() - 1);
  for (std::uint32_t part = 0; part < boxes_.size(); ++part)
    for_cells_of(part, [&](std::uint32_t cell) { own_parts_[next[cell]++] = part; });
  begin_ = own_begin_;
  parts_ = own_parts_;
}

PartsNear::PartsNear(std::span<const std::byte> bytes) {
  TableReader tables(bytes);
  grid_ = tables.next<Grid>().front();
  boxes_ = tables.next<Box>();
  begin_ = tables.next<std::uint32_t>();
  parts_ = tables.next<std::uint32_t>();
}

std::vector<std::byte> PartsNear::bytes() const {
  TableWriter tables;
  tables.add(std::vector{grid_}), tables.add(own_boxes_), tables.add(own_begin_), tables.add(own_parts_);
  return tables.bytes();
}

std::vector<std::uint32_t> PartsNear::around(std::uint32_t part) const {
  std::vector<std::uint32_t> found;
  for_cells_of(part, [&](std::uint32_t cell) {
    for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      if (boxes_[parts_[i]].comes_within(grid_.distance_m, boxes_[part])) found.push_back(parts_[i]);
    }
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Not many more cells than parts, however wide the map is.
void PartsNear::choose_cells() {
  if (boxes_.empty()) return;
  Box whole = boxes_[0];
  for (const Box& box : boxes_) whole.extend(box);
  grid_.low_m = whole.low_m;
  const Vec size_m = whole.high_m - whole.low_m;
  const double most_cells = static_cast<double>(boxes_.size()) + 16.0;
  while ((size_m.x / grid_.cell_m + 1.0) * (size_m.y / grid_.cell_m + 1.0) > most_cells) grid_.cell_m *= 2.0;
  grid_.columns = static_cast<std::uint32_t>(size_m.x / grid_.cell_m) + 1;
  grid_.rows = static_cast<std::uint32_t>(size_m.y / grid_.cell_m) + 1;
}

PartsNear::Cells PartsNear::cells_of(const Box& box) const {
  const double around_m = grid_.distance_m / 2.0;
  return {index_of(box.low_m.x - around_m - grid_.low_m.x, grid_.columns),
          index_of(box.high_m.x + around_m - grid_.low_m.x, grid_.columns),
          index_of(box.low_m.y - around_m - grid_.low_m.y, grid_.rows),
          index_of(box.high_m.y + around_m - grid_.low_m.y, grid_.rows)};
}

std::uint32_t PartsNear::index_of(double offset_m, std::uint32_t count) const {
  return static_cast<std::uint32_t>(std::clamp(std::floor(offset_m / grid_.cell_m), 0.0, count - 1.0));
}

template <class F>
void PartsNear::for_cells_of(std::uint32_t part, F f) const {
  const Cells cells = cells_of(boxes_[part]);
  for (std::uint32_t row = cells.first_row; row <= cells.last_row; ++row) {
    for (std::uint32_t column = cells.first_column; column <= cells.last_column; ++column)
      f(row * grid_.columns + column);
  }
}

namespace {

// Where a question names them.
constexpr unsigned kSelfBit = 32, kOptionsBit = 52;

constexpr std::array kOptions{&HullOptions::loads_count, &HullOptions::sizes_differ,    &HullOptions::centres_differ,
                              &HullOptions::turns_count, &HullOptions::corners_count,   &HullOptions::directions_count,
                              &HullOptions::bends_count, &HullOptions::margin_is_whole, &HullOptions::shapes_decide};
static_assert(kOptionsBit + kOptions.size() <= 64);

HullOptions options_of(std::uint64_t bits) {
  HullOptions options;
  for (std::size_t i = 0; i < kOptions.size(); ++i) options.*kOptions[i] = (bits >> i & 1U) != 0;
  return options;
}

// Always with a load: an AGV does not know whether another AGV is loaded.
Body body_of(const fp_facts& facts, std::uint32_t id, const HullOptions& options) {
  const fp_agv& agv = agv_of(facts, id);
  const double length_m = options.loads_count ? std::max(agv.length_m, agv.loaded_length_m) : agv.length_m,
               width_m = options.loads_count ? std::max(agv.width_m, agv.loaded_width_m) : agv.width_m;
  return {length_m, width_m, tells_minor_2(facts) ? agv.centre_ahead_m : 0.0};
}

// Works the tables out.
class Sweeps {
 public:
  Sweeps(const fp_facts& facts, const HullKey& key) : map_(facts), sectors_(map_), options_(key.options) {
    for (std::uint32_t id = 0; id < facts.fleet_count; ++id) {
      const Body body = body_of(facts, key.self == HullKey::kNobody ? id : key.self, options_);
      const auto known = std::ranges::find_if(kinds_, [&](const Body& kind) { return is_same_kind(kind, body); });
      kind_of_.push_back(static_cast<std::uint32_t>(known - kinds_.begin()));
      if (known == kinds_.end()) kinds_.push_back(body);
    }
    double reach_m = 0.0;
    for (const Body& kind : kinds_) reach_m = std::max(reach_m, kind.reach_m());
    clearance_m_ = (options_.margin_is_whole ? 1.0 : 0.5) * facts.safety_distance_m +
                   std::max(kHullTolerance_m, 2.0 * kArcHeading_rad * reach_m);
    for (const Body& kind : kinds_) sweep(kind);
  }

  std::vector<std::byte> tables() const {
    TableWriter tables;
    tables.add(std::vector{clearance_m_});
    tables.add(kinds_), tables.add(kind_of_);
    sectors_.add_to(tables);
    tables.add(parts_), tables.add(shapes_);
    tables.add(PartsNear(boxes(), clearance_m_).bytes());
    return tables.bytes();
  }

 private:
  bool is_same_kind(const Body& a, const Body& b) const {
    return options_.centres_differ ? a == b : a.length_m == b.length_m && a.width_m == b.width_m;
  }

  void sweep(const Body& kind) {
    for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) sweep_lane(kind, lane);
    for (std::uint32_t station = 0; station < map_.station_count(); ++station) {
      const Vec at = map_.position_m(station);
      parts_.push_back({static_cast<std::uint32_t>(shapes_.size()), 1, at, kind.reach_m()});
      shapes_.push_back(disc_at(at, turning_body(kind, options_).reach_m()));
    }
  }

  // No point of a lane is further from the middle between its ends than half the length of the lane.
  void sweep_lane(const Body& kind, std::uint32_t id) {
    const fp_lane& lane = map_.lane(id);
    const fp_pose& start = map_.arc(lane, 0).start;
    const fp_pose end = end_of(map_.arc(lane, lane.arc_count - 1));
    HullPart part{static_cast<std::uint32_t>(shapes_.size()), 0, Vec{start.x_m + end.x_m, start.y_m + end.y_m} * 0.5,
                  0.0};
    const bool tail_first = map_.is_backward(id) && options_.directions_count;
    if (!options_.bends_count) append_sweep(chord_of(map_, id), tail_first, kind, shapes_);
    double length_m = 0.0;
    for (std::uint32_t i = 0; i < lane.arc_count; ++i) {
      length_m += map_.arc(lane, i).length_m;
      if (options_.bends_count) append_sweep(map_.arc(lane, i), tail_first, kind, shapes_);
    }
    part.count = static_cast<std::uint32_t>(shapes_.size()) - part.first;
    part.reach_m = length_m / 2.0 + kind.reach_m();
    parts_.push_back(part);
  }

  std::vector<Box> boxes() const {
    std::vector<Box> boxes;
    boxes.reserve(parts_.size());
    for (const HullPart& part : parts_) {
      Box& box = boxes.emplace_back(Box::around(shapes_[part.first]));
      for (std::uint32_t i = 1; i < part.count; ++i) box.extend(Box::around(shapes_[part.first + i]));
    }
    return boxes;
  }

  MapView map_;
  Sectors sectors_;
  HullOptions options_;
  double clearance_m_ = 0.0;
  std::vector<Body> kinds_;
  std::vector<std::uint32_t> kind_of_;
  std::vector<HullPart> parts_;
  std::vector<Shape> shapes_;
};

std::span<const std::byte> tables_of(const fp_facts& facts, const HullKey& key) {
  return ask<std::byte>(
      facts,
      [](const fp_facts* from, std::uint64_t question, fp_answer* to) {
        answer(*from, to, Sweeps(*from, HullKey(question)).tables());
      },
      key.question(0));
}

}  // namespace

Body turning_body(const Body& kind, const HullOptions& options) {
  return options.corners_count ? kind : Body{kind.length_m, 0.0, 0.0};
}

HullKey::HullKey(std::uint64_t question)
    : options(options_of(question >> kOptionsBit)), self(static_cast<std::uint32_t>(question >> kSelfBit) & kNobody) {}

std::uint64_t HullKey::question(std::uint64_t item) const {
  std::uint64_t number = item | std::uint64_t{self} << kSelfBit;
  for (std::size_t i = 0; i < kOptions.size(); ++i) number |= std::uint64_t{options.*kOptions[i]} << (kOptionsBit + i);
  return number;
}

HullTables::HullTables(const fp_facts& facts, const HullKey& key) : HullTables(TableReader(tables_of(facts, key))) {}

HullTables::HullTables(TableReader tables)
    : clearance_m_(tables.next<double>().front()),
      kinds_(tables.next<Body>()),
      kind_of_(tables.next<std::uint32_t>()),
      sectors_(tables),
      parts_(tables.next<HullPart>()),
      shapes_(tables.next<Shape>()),
      near_(tables.next<std::byte>()) {}

}  // namespace fleetproof::agents
