#include "core/agents/agents.h"

#include <iterator>

#include "core/agents/agent_type.hpp"
#include "core/agents/faulty/faulty_agents.hpp"

namespace {
using namespace fleetproof::agents;
}

extern "C" {
const fp_agent_type* const fp_reference_agents[] = {&kScripted,           &kHullLock,
                                                    &kTimeoutGrant,       &kReckless,
                                                    &kNoTurnSweep,        &kNoHalfDiagonal,
                                                    &kNoOverhang,         &kOneSizeForAll,
                                                    &kBendsAsChords,      &kHalfMargin,
                                                    &kNamesNotShapes,     &kStaleGrant,
                                                    &kCountsMessages,     &kAgelessProof,
                                                    &kForgetsBoot,        &kWrapsAt256,
                                                    &kIgnoresParked,      &kGrantsAtBoot,
                                                    &kGrantsForGood,      &kLockExpires,
                                                    &kOvertakenGoesOn,    &kOvertakenDropsGrant,
                                                    &kOvertakenIfGranted, &kTieWithoutNumber,
                                                    &kEarlyRelease,       &kRestartForgetsLane,
                                                    &kFailureFreesLane,   &kAsksOnce,
                                                    &kBothStepBack,       &kNeverMakesWay,
                                                    &kLaneByLane};
const uint32_t fp_reference_agent_count = std::size(fp_reference_agents);
}
