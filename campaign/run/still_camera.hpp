#pragma once

#include <vector>

#include "core/geometry/rectangle.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof {

// Where a body stood at one instant.
struct StillBody {
  EntityId entity;
  OrientedRectangle place;
};

// All bodies on the floor at one instant, in the order of their ids.
struct Still {
  SimTime at;
  std::vector<StillBody> bodies;
};

// A law that accuses nothing: it takes the places of all bodies at the instants of `stills`. Requires: `stills`
// outlives the camera, and its instants ascend.
class StillCamera : public Law {
 public:
  explicit StillCamera(std::vector<Still>& stills) : stills_(stills) {}
  void piece_ended(const Piece& piece) override;
  void finish(SimTime end) override;
  LawResults findings() const override { return {}; }

 private:
  std::vector<Still>& stills_;
};

}  // namespace fleetproof
