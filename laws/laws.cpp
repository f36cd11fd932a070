#include "laws/laws.hpp"

#include "laws/exact_law.hpp"
#include "laws/global_step_law.hpp"
#include "laws/paper_law.hpp"

namespace fleetproof {
namespace {

constexpr Entry<MakeLaw> kLaws[] = {
    {"exact",
     "Every stretch of time in which an AGV is closer than the safety distance to another body, driving, turning or at rest, to the nanosecond and "
     "the micrometre; it does not see dips of less than 1 micrometre below the safety distance, nor tell apart what is too close again within 0.1 s.",
     make_exact_law},
    {"paper",
     "The published rule of Fig. 5: drive activities against standing bodies by axis-aligned perimeters, and against each other by snapshots 2.5 ms "
     "apart (1 cm at 2 m/s); it does not see turns, bodies that rest for part of a drive, arrivals, or what passes between two snapshots.",
     make_paper_law},
    {"global-step",
     "The paper's baseline: every other body at every step of 2.5 ms of every drive (1 cm at 2 m/s), by boxes with square corners; it does not see "
     "turns while nobody else of the pair drives, arrivals, or what passes between two steps.",
     make_global_step_law},
};

}  // namespace

std::span<const Entry<MakeLaw>> laws() { return kLaws; }

}  // namespace fleetproof
