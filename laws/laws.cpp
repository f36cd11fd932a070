#include "laws/laws.hpp"

#include "laws/exact_law.hpp"
#include "laws/global_step_law.hpp"
#include "laws/paper_law.hpp"

namespace fleetproof {
namespace {

constexpr Entry<MakeLaw> kLaws[] = {
    {"exact",
     "Finds every stretch of time in which an AGV is closer than the safety distance to another body, while either drives, turns or rests, to the "
     "nanosecond and the micrometre; it does not see dips of less than 1 micrometre, and may join stretches less than 0.1 s apart.",
     make_exact_law},
    {"paper",
     "Finds what the published rule of Figure 5 does, by axis-aligned perimeters of whole drives and, between two drives, snapshots (1 cm at the "
     "default 2.5 ms); it does not see turns, who rests for part of a drive, arrivals, or what passes between two snapshots.",
     make_paper_law},
    {"global-step",
     "Finds what the paper's baseline does, by checking every other body at every step of every drive (1 cm at the default 2.5 ms) with "
     "square-cornered perimeters; it does not see turns beside what stands, arrivals, or what passes between two steps.",
     make_global_step_law},
};

}  // namespace

std::span<const Entry<MakeLaw>> laws() { return kLaws; }

}  // namespace fleetproof
