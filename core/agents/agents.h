/* The catalogue of the reference agents. They use fleetproof/agent.h and nothing else of the project. */
#ifndef FLEETPROOF_AGENTS_H
#define FLEETPROOF_AGENTS_H

#include "core/sdk/fleetproof/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The reference agents by number, from 0 on; those with a planted fault come last. Null after the last. */
const fp_agent_type* fp_reference_agent(uint32_t number);
/* Those that are hull-lock with a planted fault, from 0 on. Null after the last. */
const fp_agent_type* fp_faulty_agent(uint32_t number);

#ifdef __cplusplus
}
#endif

#endif
