#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/motion/piece.hpp"
#include "core/outcome/outcome.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// The pieces of each body, in order.
using PiecesOfBodies = std::map<EntityId, std::vector<const Piece*>>;
PiecesOfBodies pieces_of_bodies(std::span<const Piece> pieces);
// None: the body is not on the floor.
const Piece* piece_at(const PiecesOfBodies& bodies, EntityId body, SimTime t);

// Clearance over time of the pairs of the first violations, around them: exact at every point, and at the instants at
// which a violation begins, is closest and ends. Without a violation: of the pair that came closest, around its closest
// instant, and film.nearest.
void add_clearances(web::Film& film, const PiecesOfBodies& bodies, const Outcome& outcome);

}  // namespace fleetproof
