/* The catalogue of the reference agents. They use fleetproof/agent.h and nothing else of the project. */
#ifndef FLEETPROOF_AGENTS_H
#define FLEETPROOF_AGENTS_H

#include "core/sdk/fleetproof/agent.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const fp_agent_type* const fp_reference_agents[];
extern const uint32_t fp_reference_agent_count;
/* Those of them that are hull-lock with a planted fault. */
extern const fp_agent_type* const* const fp_faulty_agents;
extern const uint32_t fp_faulty_agent_count;

#ifdef __cplusplus
}
#endif

#endif
