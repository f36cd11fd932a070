#include "core/engine/company.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

constexpr double kBoxRounding_m = 1e-6;  // whichever of two boxes is grown
constexpr std::size_t kFirst = 8;        // seldom more

}  // namespace

Company::Company(std::size_t bodies, double within_m)
    : within_m_(within_m + kBoxRounding_m), planned_(bodies), boxes_(bodies), pieces_(bodies), near_(bodies) {}

// Of two bodies that come near each other, one began its piece later, and finds the other here.
void Company::begins(const Piece& piece) {
  const auto body = static_cast<std::uint32_t>(piece.entity.index());
  const Box box = piece.planned_box;
  // Often a body rests where its last piece ended: then nobody else can be near.
  const bool stays_inside = pieces_[body] != nullptr && boxes_[body].contains(box);
  pieces_[body] = &piece;
  boxes_[body] = box;
  planned_.place(body, box);
  if (stays_inside) return stay_near(body, box.grown(within_m_));
  forget(piece.entity);
  for (const std::uint32_t other : planned_.overlapping(box.grown(within_m_))) {
    if (other == body) continue;
    std::vector<std::uint32_t>&mine = near_[body], &its = near_[other];
    if (mine.empty()) mine.reserve(kFirst);
    if (its.empty()) its.reserve(kFirst);
    mine.push_back(other);
    its.insert(std::ranges::lower_bound(its, body), body);
  }
}

// Of those that are near already, the ones that still are.
void Company::stay_near(std::uint32_t body, const Box& near) {
  std::erase_if(near_[body], [&](std::uint32_t other) {
    if (near.overlaps(boxes_[other])) return false;
    std::erase(near_[other], body);
    return true;
  });
}

void Company::leaves(EntityId body) {
  forget(body);
  planned_.remove(body.index());
  pieces_[body.index()] = nullptr;
}

void Company::forget(EntityId body) {
  std::vector<std::uint32_t>& mine = near_[body.index()];
  for (const std::uint32_t other : mine) std::erase(near_[other], static_cast<std::uint32_t>(body.index()));
  mine.clear();
}

std::span<const Piece* const> Company::pieces_near(EntityId body) {
  answer_.clear();
  for (const std::uint32_t other : near(body)) answer_.push_back(pieces_[other]);
  return answer_;
}

}  // namespace fleetproof
