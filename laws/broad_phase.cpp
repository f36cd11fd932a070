#include "laws/broad_phase.hpp"

#include <algorithm>
#include <bit>

namespace fleetproof {
namespace {

// A drive of one segment touches two or three cells.
constexpr double kCell_m = 8.0;
// A box over more cells is cheaper looked at by every question than filed. (A wall of a warehouse, say.)
constexpr std::int64_t kMostCells = 32;

std::int64_t cell(double at_m) {
  constexpr double kFar = 1e12;
  const double cells = std::clamp(at_m / kCell_m, -kFar, kFar);
  const auto towards_zero = static_cast<std::int64_t>(cells);
  return towards_zero - (cells < static_cast<double>(towards_zero));
}

}  // namespace

BroadPhase::BroadPhase(std::size_t bodies, std::size_t scanned) : boxes_(bodies), asked_(bodies) {
  if (bodies > scanned) buckets_.resize(std::bit_ceil(4 * bodies));
}

void BroadPhase::place(std::size_t body, const Box& box) {
  boxes_[body] = box;
  if (buckets_.empty()) return;
  const auto id = static_cast<std::uint32_t>(body);
  const Cells cells = cells_of(box);
  if (cells.count() > kMostCells) {
    wide_.push_back(id);
  } else {
    for_each_bucket(cells, [id](auto& bucket) { bucket.push_back(id); });
  }
}

void BroadPhase::remove(std::size_t body) {
  const Box box = boxes_[body];
  boxes_[body] = Box{};
  if (buckets_.empty() || box.low_m.x() > box.high_m.x()) return;
  const auto strike = [id = static_cast<std::uint32_t>(body)](auto& list) {
    const auto at = std::ranges::find(list, id);
    *at = list.back();
    list.pop_back();
  };
  const Cells cells = cells_of(box);
  if (cells.count() > kMostCells) {
    strike(wide_);
  } else {
    for_each_bucket(cells, strike);
  }
}

std::span<const std::uint32_t> BroadPhase::overlapping(const Box& box) {
  found_.clear();
  if (buckets_.empty()) return scanned(box);
  const Cells cells = cells_of(box);
  if (cells.count() > kMostCells) return scanned(box);
  ++question_;
  for (const std::uint32_t body : wide_) offer(body, box);
  for_each_bucket(cells, [&](const auto& bucket) {
    for (const std::uint32_t body : bucket) offer(body, box);
  });
  std::ranges::sort(found_);
  return found_;
}

std::span<const std::uint32_t> BroadPhase::scanned(const Box& box) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (box.overlaps(boxes_[i])) found_.push_back(static_cast<std::uint32_t>(i));
  }
  return found_;
}

// Once, in however many cells the two meet.
void BroadPhase::offer(std::uint32_t body, const Box& box) {
  if (asked_[body] == question_) return;
  asked_[body] = question_;
  if (box.overlaps(boxes_[body])) found_.push_back(body);
}

BroadPhase::Cells BroadPhase::cells_of(const Box& box) {
  return {cell(box.low_m.x()), cell(box.low_m.y()), cell(box.high_m.x()), cell(box.high_m.y())};
}

template <class Visit>
void BroadPhase::for_each_bucket(const Cells& cells, Visit visit) {
  for (std::int64_t x = cells.left; x <= cells.right; ++x) {
    for (std::int64_t y = cells.bottom; y <= cells.top; ++y) visit(bucket(x, y));
  }
}

// Cells that share a bucket cost a look at a box, no more.
std::vector<std::uint32_t>& BroadPhase::bucket(std::int64_t x, std::int64_t y) {
  const std::uint64_t mixed = (static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U) ^ (static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FU);
  return buckets_[(mixed ^ mixed >> 32) & (buckets_.size() - 1)];
}

}  // namespace fleetproof
