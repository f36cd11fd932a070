#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fleetproof::agents {

// Places of a search, the nearest first to within a width: a heap that sorts them exactly costs several times as much
// as all else that a search does with a place. Of places within one width, those come first that were put last. The
// order does not change the result if the search looks at a place again whenever it finds a shorter way to it.
class NearQueue {
 public:
  // Places further away than so many widths cost more.
  explicit NearQueue(std::uint32_t buckets = 4096) : newest_(buckets, kNone) {}

  // Forgets what it holds. Requires: width > 0; no place is nearer than `nearest`, but for rounding.
  void begin(double nearest, double width) {
    std::fill_n(newest_.begin(), used_, kNone);
    count_ = 0;
    far_.clear();
    nearest_ = nearest;
    width_ = width;
    per_width_ = 1.0 / width;
    current_ = used_ = 0;
  }

  // Nearer than places that were taken already: it comes next.
  void push(double distance, std::uint32_t place) {
    const double widths = (distance - nearest_) * per_width_;
    if (!(widths < static_cast<double>(newest_.size()))) return push_far(distance, place);
    const auto bucket = static_cast<std::uint32_t>(std::max<std::int64_t>(current_, static_cast<std::int64_t>(widths)));
    if (count_ == entries_.size()) grow();
    entries_[count_] = {place, newest_[bucket]};
    newest_[bucket] = count_++;
    used_ = std::max(used_, bucket + 1);
  }

  // False: there is none.
  bool find_next() {
    while (current_ < used_ && newest_[current_] == kNone) ++current_;
    return current_ < used_ || !far_.empty();
  }
  // Requires: find_next() was true after the last change.
  std::uint32_t pop() {
    if (current_ == used_) return pop_far();
    const auto [place, before] = entries_[newest_[current_]];
    newest_[current_] = before;
    return place;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Entry {
    std::uint32_t place, before;
  };
  struct Far {
    double distance;
    std::uint32_t place;
  };
  static bool is_later(const Far& a, const Far& b) { return a.distance > b.distance; }

  // Seldom, and not inline: push() is small.
  [[gnu::noinline]] void grow() { entries_.resize(2 * entries_.size() + 64); }
  [[gnu::noinline]] void push_far(double distance, std::uint32_t place) {
    far_.push_back({distance, place});
    std::ranges::push_heap(far_, is_later);
  }
  [[gnu::noinline]] std::uint32_t pop_far() {
    std::ranges::pop_heap(far_, is_later);
    const std::uint32_t place = far_.back().place;
    far_.pop_back();
    return place;
  }

  double nearest_ = 0.0, width_ = 1.0, per_width_ = 1.0;
  std::uint32_t current_ = 0, used_ = 0;  // buckets
  std::vector<std::uint32_t> newest_;     // entry of each bucket
  std::vector<Entry> entries_;            // the first count_
  std::uint32_t count_ = 0;
  std::vector<Far> far_;  // heap of what lies beyond all buckets
};

}  // namespace fleetproof::agents
