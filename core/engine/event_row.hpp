#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

namespace fleetproof {

// Events that are added at the end and taken from the front, one behind the other in memory.
template <class Item>
class EventRow {
 public:
  bool empty() const { return next_ == end_; }
  std::size_t size() const { return end_ - next_; }
  // Requires, of these: it is not empty.
  const Item& front() const { return items_[next_]; }
  const Item& back() const { return items_[end_ - 1]; }
  void drop_front() {
    if (++next_ == end_) next_ = end_ = 0;
  }
  Item* begin() { return items_.get() + next_; }

  // Room for so many items behind the last; `added` says how many have been written there.
  Item* room_for(std::size_t items) {
    if (end_ + items > capacity_) [[unlikely]]
      make_room(items);
    return items_.get() + end_;
  }
  void added(std::size_t items) { end_ += items; }

 private:
  static constexpr std::size_t kFirstRoom = 256;

  // Most of a full row has been taken, or it becomes twice as long: either is seldom enough to cost nothing.
  [[gnu::noinline]] void make_room(std::size_t items) {
    const std::size_t waiting = size();
    std::unique_ptr<Item[]> longer;
    if (2 * (waiting + items) > capacity_) {
      capacity_ = std::max(kFirstRoom, 2 * (waiting + items));
      longer = std::make_unique_for_overwrite<Item[]>(capacity_);
    }
    std::copy_n(begin(), waiting, longer ? longer.get() : items_.get());
    if (longer) items_ = std::move(longer);
    end_ = waiting;
    next_ = 0;
  }

  std::unique_ptr<Item[]> items_;
  std::size_t next_ = 0, end_ = 0, capacity_ = 0;
};

}  // namespace fleetproof
