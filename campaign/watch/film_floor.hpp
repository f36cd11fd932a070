#pragma once

#include <span>

#include "core/motion/piece.hpp"
#include "core/scenario/scenario.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// The numbers of a film: rounded to the nearest microsecond and micrometre.
std::int64_t film_us(SimTime t);
std::int64_t film_us(Duration d);
std::int64_t film_um(double value_m);
std::int64_t film_urad(const Vec2& heading);

// Tracks, stations and bodies of the scenario.
void add_floor(web::Film& film, const Scenario& scenario);
// The motion of all bodies. Requires: the curves of the pieces are those of the scenario's map, and add_floor was
// called.
void add_motion(web::Film& film, const Scenario& scenario, std::span<const Piece> pieces);

}  // namespace fleetproof
