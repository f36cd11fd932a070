#include "campaign/run/still_camera.hpp"

#include <algorithm>

namespace fleetproof {

// Two pieces of a body share the instant at which one ends and the other begins. The body is at the same place in both,
// so the second is left out.
void StillCamera::piece_ended(const Piece& piece) {
  for (Still& still : stills_) {
    if (still.at < piece.begin || still.at > piece.end) continue;
    const bool known = std::ranges::find(still.bodies, piece.entity, &StillBody::entity) != still.bodies.end();
    if (!known) still.bodies.push_back({piece.entity, piece.body_at(still.at)});
  }
}

void StillCamera::finish(SimTime end) {
  (void)end;
  for (Still& still : stills_) std::ranges::sort(still.bodies, {}, &StillBody::entity);
}

}  // namespace fleetproof
