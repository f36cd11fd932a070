#include "core/agents/agents.h"

#include <iterator>

#include "core/agents/agent_type.hpp"
#include "core/agents/faulty/faulty_agents.hpp"

namespace {
using namespace fleetproof::agents;

constexpr uint32_t kWithoutFault = 3;  // at the beginning of the table
}  // namespace

extern "C" {
const fp_agent_type* const fp_reference_agents[] = {&kScripted,           &kHullLock,           &kReckless,
                                                    &kTimeoutGrant,       &kNoTurnSweep,        &kNoHalfDiagonal,
                                                    &kNoOverhang,         &kOneSizeForAll,      &kKindsBySize,
                                                    &kBackwardAsForward,  &kBendsAsChords,      &kHalfMargin,
                                                    &kNamesNotShapes,     &kArrivalOrder,       &kStaleGrant,
                                                    &kCountsMessages,     &kAgelessProof,       &kStraightOn,
                                                    &kUnheardWay,         &kForgetsBoot,        &kWrapsAt256,
                                                    &kIgnoresParked,      &kGrantsAtBoot,       &kGrantsForGood,
                                                    &kLockExpires,        &kOvertakenGoesOn,    &kOvertakenDropsGrant,
                                                    &kOvertakenIfGranted, &kTieWithoutNumber,   &kEarlyRelease,
                                                    &kRestartForgetsLane, &kRestartForgetsTurn, &kFailureFreesLane,
                                                    &kAsksOnce,           &kBothStepBack,       &kNeverMakesWay,
                                                    &kLaneByLane};
const uint32_t fp_reference_agent_count = std::size(fp_reference_agents);
const fp_agent_type* const* const fp_faulty_agents = fp_reference_agents + kWithoutFault;
const uint32_t fp_faulty_agent_count = std::size(fp_reference_agents) - kWithoutFault;
}
