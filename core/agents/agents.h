/* The catalogue of the reference agents. They use fleetproof/agent.h and nothing else of the project. */
#ifndef FLEETPROOF_AGENTS_H
#define FLEETPROOF_AGENTS_H

#include "core/sdk/fleetproof/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The reference agents by number, from 0 on; those with a planted fault come last. Null after the last. */
const fp_agent_type* fp_reference_agent(uint32_t number);
/* Those with a planted fault, from 0 on. Null after the last. */
const fp_agent_type* fp_faulty_agent(uint32_t number);
/* What a faulty agent is but for its fault: hull-lock, or a program of the central fleet. Null for agents without. */
const fp_agent_type* fp_sound_agent(const fp_agent_type* faulty);

/* With how many stations, drives (lanes) and AGVs, each, a reference agent can start at most, because its messages name
 * no more. FP_NONE: with any number. */
uint32_t fp_reference_agent_limit(const fp_agent_type* agent);

#ifdef __cplusplus
}
#endif

#endif
