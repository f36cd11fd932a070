#include "core/geometry/broad_phase.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace fleetproof {

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
