#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetproof::agents {

// Places of a search, the nearest first to within a width: a heap that sorts them exactly costs several times as much
// as all else that a search does with a place. Of places within one width, those come first that were put first. A
// search that looks at a place again when it finds it nearer ends with the same figures for any such order.
class NearQueue {
 public:
  // Forgets what it holds. Requires: width > 0; no place is nearer than `nearest`, but for rounding.
  void begin(double nearest, double width) {
    std::fill_n(buckets_.begin(), used_, Bucket{});
    entries_.clear();
    far_.clear();
    nearest_ = nearest;
    width_ = width;
    current_ = used_ = 0;
  }

  // Nearer than places that were taken already: it comes next.
  void push(double distance, std::uint32_t place) {
    const double widths = (distance - nearest_) / width_;
    if (!(widths < static_cast<double>(kBuckets))) return push_far(distance, place);
    const auto number = std::max(current_, static_cast<std::uint32_t>(std::max(widths, 0.0)));
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back({place, kNone});
    Bucket& bucket = buckets_[number];
    (bucket.first == kNone ? bucket.first : entries_[bucket.last].next) = entry;
    bucket.last = entry;
    used_ = std::max(used_, number + 1);
  }

  // False: there is none. The next place is at least so far.
  bool find_next() {
    while (current_ < used_ && buckets_[current_].first == kNone) ++current_;
    return current_ < used_ || !far_.empty();
  }
  // Requires: find_next() was true after the last change.
  double next_distance() const {
    return current_ < used_ ? nearest_ + static_cast<double>(current_) * width_ : far_.front().distance;
  }
  std::uint32_t pop() {
    if (current_ == used_) return pop_far();
    Bucket& bucket = buckets_[current_];
    const auto [place, next] = entries_[bucket.first];
    bucket.first = next;
    return place;
  }

 private:
  static constexpr std::uint32_t kBuckets = 4096, kNone = ~std::uint32_t{0};
  struct Entry {
    std::uint32_t place, next;
  };
  struct Bucket {
    std::uint32_t first = kNone, last = kNone;
  };
  struct Far {
    double distance;
    std::uint32_t place;
  };
  static bool is_later(const Far& a, const Far& b) { return a.distance > b.distance; }

  void push_far(double distance, std::uint32_t place) {
    far_.push_back({distance, place});
    std::ranges::push_heap(far_, is_later);
  }
  std::uint32_t pop_far() {
    std::ranges::pop_heap(far_, is_later);
    const std::uint32_t place = far_.back().place;
    far_.pop_back();
    return place;
  }

  double nearest_ = 0.0, width_ = 1.0;
  std::uint32_t current_ = 0, used_ = 0;  // buckets
  std::vector<Bucket> buckets_ = std::vector<Bucket>(kBuckets);
  std::vector<Entry> entries_;
  std::vector<Far> far_;  // heap of what lies beyond all buckets
};

}  // namespace fleetproof::agents
