#include "core/geometry/broad_phase.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace fleetproof {
namespace {

// Sizes of the cells: for drives of one segment, for long drives, for ways across a hall.
constexpr std::array kCell_m = {12.0, 48.0, 192.0};
// Half a cell, less what rounding can do to the middle of a box.
constexpr double kHalf = 0.49;
// A question over more cells is answered by a scan.
constexpr std::int64_t kMostCells = 32;

// All places that are farther out than kFar cells share one cell. Rounding moves the middle of a box by the rest of its
// half cell only much farther out.
std::int64_t cell(std::uint32_t level, double at_m) {
  constexpr double kFar = 1e12;
  const double cells = std::min(std::max(at_m / kCell_m[level], -kFar), kFar);
  const auto towards_zero = static_cast<std::int64_t>(cells);
  return towards_zero - (cells < static_cast<double>(towards_zero));
}

std::uint32_t level_of(const Box& box) {
  const Vec2 size_m = box.high_m - box.low_m;
  const double half_m = 0.5 * std::max(size_m.x(), size_m.y());
  std::uint32_t level = 0;
  while (level < kCell_m.size() && !(half_m <= kHalf * kCell_m[level])) ++level;
  return level;
}

using Both [[gnu::vector_size(16)]] = double;

Both both(const std::array<double, 2>& of) {
  Both result;
  std::memcpy(&result, of.data(), sizeof result);
  return result;
}

}  // namespace

BroadPhase::BroadPhase(std::size_t bodies, std::size_t scanned) : boxes_(bodies), twos_((bodies + 1) / 2) {
  for (std::size_t i = 0; i < 2 * twos_.size(); ++i) set_scanned(i, Box{});
  found_.resize(bodies + 2);
  if (bodies <= scanned) return;
  heads_.assign(std::bit_ceil(2 * bodies) + 1, kNobody);
  links_.resize(bodies);
}

void BroadPhase::set_scanned(std::size_t body, const Box& box) {
  Two& two = twos_[body / 2];
  two.left[body % 2] = box.low_m.x(), two.bottom[body % 2] = box.low_m.y();
  two.right[body % 2] = box.high_m.x(), two.top[body % 2] = box.high_m.y();
}

inline void BroadPhase::look_into(std::size_t chain, const Box& box) {
  for (std::uint32_t body = heads_[chain]; body != kNobody; body = links_[body].after) {
    if (!box.overlaps(boxes_[body])) continue;
    if (count_ == found_.size()) found_.resize(2 * count_);
    found_[count_++] = body;
  }
}

inline std::size_t BroadPhase::chain_of(std::uint32_t level, std::int64_t x, std::int64_t y) const {
  const std::uint64_t mixed = (static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U) ^
                              (static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU) ^ level;
  return (mixed ^ mixed >> 32) & (heads_.size() - 2);
}

void BroadPhase::place(std::size_t body, const Box& box) {
  boxes_[body] = box;
  set_scanned(body, box);
  if (!files()) return;
  const auto id = static_cast<std::uint32_t>(body);
  const std::uint32_t level = level_of(box);
  const Vec2 middle_m = 0.5 * (box.low_m + box.high_m);
  const std::size_t chain =
      level == kLevels ? heads_.size() - 1 : chain_of(level, cell(level, middle_m.x()), cell(level, middle_m.y()));
  std::uint32_t& head = heads_[chain];
  links_[body] = {kNobody, head, static_cast<std::uint32_t>(chain), level};
  if (head != kNobody) links_[head].before = id;
  head = id;
  ++filed_[level];
}

void BroadPhase::remove(std::size_t body) {
  const bool was_placed = boxes_[body].low_m.x() <= boxes_[body].high_m.x();
  boxes_[body] = Box{};
  set_scanned(body, Box{});
  if (!files() || !was_placed) return;
  const auto [before, after, chain, level] = links_[body];
  (before == kNobody ? heads_[chain] : links_[before].after) = after;
  if (after != kNobody) links_[after].before = before;
  --filed_[level];
}

std::span<const std::uint32_t> BroadPhase::overlapping(const Box& box) {
  count_ = 0;
  bool found_all = files();
  for (std::uint32_t level = 0; found_all && level < kLevels; ++level)
    found_all = filed_[level] == 0 || look_around(level, box);
  if (found_all) {
    look_into(heads_.size() - 1, box);
    const auto found = std::span(found_).first(count_);
    std::ranges::sort(found);
    count_ =
        static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());  // cells may share a bucket
  } else {
    scan(box);
  }
  return std::span(found_).first(count_);
}

void BroadPhase::scan(const Box& box) {
  const double left_m = box.low_m.x(), bottom_m = box.low_m.y(), right_m = box.high_m.x(), top_m = box.high_m.y();
  const Both left = {left_m, left_m}, bottom = {bottom_m, bottom_m}, right = {right_m, right_m}, top = {top_m, top_m};
  // Without branches: every body is written to the list, and the end of the list moves on only if the boxes overlap.
  std::uint32_t* last = found_.data();
  std::uint32_t body = 0;
  for (const Two& two : twos_) {
    const auto meets =
        (both(two.left) <= right) & (left <= both(two.right)) & (both(two.bottom) <= top) & (bottom <= both(two.top));
    *last = body++;
    last -= meets[0];
    *last = body++;
    last -= meets[1];
  }
  count_ = static_cast<std::size_t>(last - found_.data());
}

// Looks at the bodies that are filed with cells of this size. The middle of such a body is at most half a cell from its
// rim, so it looks half a cell beyond the box. False if there would be too many cells.
bool BroadPhase::look_around(std::uint32_t level, const Box& box) {
  const double beyond_m = 0.5 * kCell_m[level];
  const std::int64_t left = cell(level, box.low_m.x() - beyond_m), right = cell(level, box.high_m.x() + beyond_m);
  const std::int64_t bottom = cell(level, box.low_m.y() - beyond_m), top = cell(level, box.high_m.y() + beyond_m);
  if (right - left >= kMostCells || top - bottom >= kMostCells || (right - left + 1) * (top - bottom + 1) > kMostCells)
    return false;
  for (std::int64_t x = left; x <= right; ++x) {
    for (std::int64_t y = bottom; y <= top; ++y) look_into(chain_of(level, x, y), box);
  }
  return true;
}

}  // namespace fleetproof
