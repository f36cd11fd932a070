#include "core/geometry/broad_phase.hpp"

#include <algorithm>
#include <bit>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace fleetproof {
namespace {

constexpr double kCell_m = 24.0;  // longer than most drives of one segment

// Numbers are above zero, where a conversion rounds down. All places that are farther out than kFar cells share one.
std::int32_t cell(double at_m) {
  constexpr double kFar = 1e9;
  return static_cast<std::int32_t>(std::min(std::max(at_m * (1.0 / kCell_m), -kFar), kFar) + kFar);
}

}  // namespace

BoxGrid::BoxGrid(std::size_t bodies)
    : boxes_(bodies),
      filed_(bodies),
      links_(kMostCells * bodies),
      heads_(std::bit_ceil(2 * std::max<std::size_t>(bodies, 1)) + 1, kNobody) {}

BoxGrid::Cells BoxGrid::cells_of(const Box& box) {
  return {cell(box.low_m.x()), cell(box.high_m.x()), cell(box.low_m.y()), cell(box.high_m.y())};
}

inline std::size_t BoxGrid::chain_of(std::int32_t x, std::int32_t y) const {
  const std::uint64_t mixed =
      static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU;
  return (mixed ^ mixed >> 32) & (heads_.size() - 2);
}

// The next box of a body often touches the cells of the one before.
void BoxGrid::place(std::size_t body, const Box& box) {
  const Cells cells = cells_of(box);
  boxes_[body] = box;
  Filed& filed = filed_[body];
  if (filed.times > 0 && filed.cells == cells) return;
  take_out(body);
  filed.cells = cells;
  const auto first = static_cast<std::uint32_t>(kMostCells * body);
  if (cells.count() > kMostCells) {
    link(first + filed.times++, heads_.size() - 1);
    return;
  }
  for (std::int32_t x = cells.left; x <= cells.right; ++x) {
    for (std::int32_t y = cells.bottom; y <= cells.top; ++y) link(first + filed.times++, chain_of(x, y));
  }
}

void BoxGrid::remove(std::size_t body) {
  take_out(body);
  boxes_[body] = Box{};
}

void BoxGrid::take_out(std::size_t body) {
  std::uint32_t& times = filed_[body].times;
  for (; times > 0; --times) {
    const auto [before, after, chain] = links_[kMostCells * body + times - 1];
    (before == kNobody ? heads_[chain] : links_[before].after) = after;
    if (after != kNobody) links_[after].before = before;
  }
}

void BoxGrid::link(std::uint32_t link, std::size_t chain) {
  std::uint32_t& head = heads_[chain];
  links_[link] = {kNobody, head, static_cast<std::uint32_t>(chain)};
  if (head != kNobody) links_[head].before = link;
  head = link;
}

[[gnu::always_inline]] inline void BoxGrid::look_into(std::size_t chain, const Box& box,
                                                      std::vector<std::uint32_t>& found) const {
  for (std::uint32_t link = heads_[chain]; link != kNobody; link = links_[link].after) {
    const std::uint32_t body = link / kMostCells;
    if (box.overlaps(boxes_[body])) found.push_back(body);
  }
}

// A question over many cells looks at all boxes. Else a body may be found in several of its cells, and in another one
// that shares their bucket.
void BoxGrid::find(const Box& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  const Cells cells = cells_of(box);
  if (cells.count() > kMostCells) {
    for (std::uint32_t body = 0; body < boxes_.size(); ++body) {
      if (box.overlaps(boxes_[body])) found.push_back(body);
    }
    return;
  }
  for (std::int32_t x = cells.left; x <= cells.right; ++x) {
    for (std::int32_t y = cells.bottom; y <= cells.top; ++y) look_into(chain_of(x, y), box, found);
  }
  look_into(heads_.size() - 1, box, found);
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

BroadPhase::BroadPhase(std::size_t bodies, std::size_t scanned) : found_(bodies + 2) {
  if (bodies <= scanned) {
    twos_.resize((bodies + 1) / 2);
  } else {
    grid_.emplace(bodies);
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

std::size_t BroadPhase::scan(const Box& box) {
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
  return static_cast<std::size_t>(last - found_.data());
}

}  // namespace fleetproof
