#pragma once

#include "core/sdk/fleetproof/agent.h"

// hull-lock with one planted fault each. The fault stands in the first line of its file.
namespace fleetproof::agents {

extern const fp_agent_type kAgelessProof;
extern const fp_agent_type kArrivalOrder;
extern const fp_agent_type kAsksOnce;
extern const fp_agent_type kBackwardAsForward;
extern const fp_agent_type kBendsAsChords;
extern const fp_agent_type kBothStepBack;
extern const fp_agent_type kCountsMessages;
extern const fp_agent_type kEarlyRelease;
extern const fp_agent_type kFailureFreesLane;
extern const fp_agent_type kForgetsBoot;
extern const fp_agent_type kGrantsAtBoot;
extern const fp_agent_type kGrantsForGood;
extern const fp_agent_type kHalfMargin;
extern const fp_agent_type kIgnoresParked;
extern const fp_agent_type kKindsBySize;
extern const fp_agent_type kLaneByLane;
extern const fp_agent_type kLockExpires;
extern const fp_agent_type kNamesNotShapes;
extern const fp_agent_type kNeverMakesWay;
extern const fp_agent_type kNoHalfDiagonal;
extern const fp_agent_type kNoOverhang;
extern const fp_agent_type kNoTurnSweep;
extern const fp_agent_type kOneSizeForAll;
extern const fp_agent_type kOvertakenDropsGrant;
extern const fp_agent_type kOvertakenGoesOn;
extern const fp_agent_type kOvertakenIfGranted;
extern const fp_agent_type kRestartForgetsLane;
extern const fp_agent_type kRestartForgetsTurn;
extern const fp_agent_type kStaleGrant;
extern const fp_agent_type kStraightOn;
extern const fp_agent_type kTieWithoutNumber;
extern const fp_agent_type kTimeoutGrant;
extern const fp_agent_type kUnheardWay;
extern const fp_agent_type kWrapsAt256;

}  // namespace fleetproof::agents
