#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/broad_phase.hpp"
#include "core/motion/piece.hpp"

namespace fleetproof {

// Which pieces under way are near each other: their planned boxes are. A body searches for others when it begins a
// piece, unless the piece stays within the box of its last one. A pair that was found holds until one of its two pieces
// is over.
class Company {
 public:
  // Near are boxes that are `within_m` apart or less. Some that are a micrometre farther apart may be there, too.
  Company(std::size_t bodies, double within_m);

  // The piece takes the place of the one before of its body. Requires: it stays where it is until the next one begins.
  void begins(const Piece& piece);
  void leaves(EntityId body);

  // The other bodies near the piece of this body, in ascending order. Empty after the body has left the floor.
  std::span<const std::uint32_t> near(EntityId body) const { return near_[body.index()]; }
  // Their pieces. Valid until the next call.
  std::span<const Piece* const> pieces_near(EntityId body);

 private:
  void stay_near(std::uint32_t body, const Box& near);
  void forget(EntityId body);

  double within_m_;
  BroadPhase planned_;                            // the boxes of the pieces
  std::vector<Box> boxes_;                        // the boxes, by body
  std::vector<const Piece*> pieces_;              // by body; null: it has left
  std::vector<std::vector<std::uint32_t>> near_;  // by body
  std::vector<const Piece*> answer_;
};

}  // namespace fleetproof
