#include "core/geometry/broad_phase.hpp"

#include <algorithm>
#include <bit>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace fleetproof {
namespace {

// Sizes of the cells: for drives of one segment, for long drives, for ways across a hall.
constexpr std::array kCell_m = {24.0, 96.0, 384.0};
// Half a cell, less what rounding can do to the middle of a box.
constexpr double kHalf = 0.49, kRounding = 0.01;
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

double half_m(const Box& box) {
  const Vec2 size_m = box.high_m - box.low_m;
  return 0.5 * std::max(size_m.x(), size_m.y());
}

std::uint32_t level_of(double half_m) {
  std::uint32_t level = 0;
  while (level < kCell_m.size() && !(half_m <= kHalf * kCell_m[level])) ++level;
  return level;
}

}  // namespace

BroadPhase::BroadPhase(std::size_t bodies, std::size_t scanned) : found_(bodies + 2) {
  if (bodies <= scanned) {
    twos_.resize((bodies + 1) / 2);
    return;
  }
  boxes_.resize(bodies);
  links_.resize(bodies);
  heads_.assign(std::bit_ceil(2 * bodies) + 1, kNobody);
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

inline std::size_t BroadPhase::chain_of(const Box& box, std::uint32_t level) const {
  if (level == kLevels) return heads_.size() - 1;
  const Vec2 middle_m = 0.5 * (box.low_m + box.high_m);
  return chain_of(level, cell(level, middle_m.x()), cell(level, middle_m.y()));
}

// The next box of a body often belongs where the one before is filed.
void BroadPhase::file(std::size_t body, const Box& box) {
  const auto id = static_cast<std::uint32_t>(body);
  const double half = half_m(box);
  const std::uint32_t level = level_of(half);
  widest_m_[level] = std::max(widest_m_[level], half);
  const std::size_t chain = chain_of(box, level);
  const bool was_placed = is_placed(body);
  boxes_[body] = box;
  if (was_placed) {
    if (links_[body].chain == chain && links_[body].level == level) return;
    unlink(id);
  }
  link(id, chain, level);
}

void BroadPhase::take_out(std::size_t body) {
  if (is_placed(body)) unlink(static_cast<std::uint32_t>(body));
  boxes_[body] = Box{};
}

void BroadPhase::link(std::uint32_t body, std::size_t chain, std::uint32_t level) {
  std::uint32_t& head = heads_[chain];
  links_[body] = {kNobody, head, static_cast<std::uint32_t>(chain), level};
  if (head != kNobody) links_[head].before = body;
  head = body;
  ++filed_[level];
}

void BroadPhase::unlink(std::uint32_t body) {
  const auto [before, after, chain, level] = links_[body];
  (before == kNobody ? heads_[chain] : links_[before].after) = after;
  if (after != kNobody) links_[after].before = before;
  --filed_[level];
}

void BroadPhase::find_filed(const Box& box) {
  count_ = 0;
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    if (filed_[level] > 0 && !look_around(level, box)) return scan_filed(box);
  }
  if (filed_[kLevels] > 0) look_into(heads_.size() - 1, box);
  const auto found = std::span(found_).first(count_);
  std::ranges::sort(found);
  count_ =
      static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());  // cells may share a bucket
}

void BroadPhase::scan_filed(const Box& box) {
  count_ = 0;
  for (std::uint32_t body = 0; body < boxes_.size(); ++body) {
    if (!box.overlaps(boxes_[body])) continue;
    if (count_ == found_.size()) found_.resize(2 * count_);
    found_[count_++] = body;
  }
}

// One comparison tests two bodies. 1: the first one, 2: the second one, 3: both.
#ifdef __SSE2__
class BroadPhase::Question {
  static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 16 && sizeof(Two) % 16 == 0, "a vector of them is aligned");

 public:
  explicit Question(const Box& box)
      : left_(_mm_set1_pd(box.low_m.x())),
        bottom_(_mm_set1_pd(box.low_m.y())),
        right_(_mm_set1_pd(box.high_m.x())),
        top_(_mm_set1_pd(box.high_m.y())) {}
  int meets(const Two& two) const {
    const __m128d across = _mm_and_pd(_mm_cmple_pd(_mm_load_pd(two.left.data()), right_),
                                      _mm_cmpge_pd(_mm_load_pd(two.right.data()), left_));
    const __m128d along = _mm_and_pd(_mm_cmple_pd(_mm_load_pd(two.bottom.data()), top_),
                                     _mm_cmpge_pd(_mm_load_pd(two.top.data()), bottom_));
    return _mm_movemask_pd(_mm_and_pd(across, along));
  }

 private:
  __m128d left_, bottom_, right_, top_;
};
#else
class BroadPhase::Question {
 public:
  explicit Question(const Box& box) : box_(box) {}
  int meets(const Two& two) const { return meets(two, 0) + 2 * meets(two, 1); }

 private:
  int meets(const Two& two, std::size_t i) const {
    return box_.overlaps({{two.left[i], two.bottom[i]}, {two.right[i], two.top[i]}}) ? 1 : 0;
  }

  Box box_;
};
#endif

void BroadPhase::scan(const Box& box) {
  const Question question(box);
  std::uint32_t* last = found_.data();
  std::uint32_t body = 0;
  for (const Two& two : twos_) {
    if (const int which = question.meets(two); which != 0) [[unlikely]] {
      *last = body;
      last += which & 1;
      *last = body + 1;
      last += which >> 1;
    }
    body += 2;
  }
  count_ = static_cast<std::size_t>(last - found_.data());
}

// Looks at the bodies that are filed with cells of this size. It looks as far beyond the box as the middle of such a
// body can be from its rim, which is at most half a cell. False if there would be too many cells.
bool BroadPhase::look_around(std::uint32_t level, const Box& box) {
  const double beyond_m = widest_m_[level] + kRounding * kCell_m[level];
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
