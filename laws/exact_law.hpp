#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The default law: no snapshots. Every pair of bodies is followed over the whole run, whether they drive, turn or rest,
// and a violation is dated to the nanosecond.
//
// Two pieces of two bodies are settled when the first of them ends: both trajectories over their common interval are
// final then, so nothing that was found can turn out untrue. Bodies whose swept boxes lie farther apart than the
// smallest clearance met so far (at first 0.5 m), and than the threshold, are passed over: they change neither finding.
// Two obstacles are no concern of the law.
//
// The closest instant of a contact is the touch, with the speed at which it happened; how deep bodies that nothing
// stops drive into each other is not measured.
//
// One violation per uninterrupted stretch of a pair, over seams between pieces. A rise above the threshold that lasts
// 0.1 s or longer ends a stretch; a shorter one within one pair of pieces may go unnoticed. Each violation is confirmed
// by FCL at its closest instant, or InvariantViolation is thrown from `finish`. A perimeter check is one distance
// evaluation.
std::unique_ptr<Law> make_exact_law(const Scenario& scenario);

}  // namespace fleetproof
