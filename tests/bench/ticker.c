/* The agent of bridge_cost.cpp as a shared object. */
#include <stdlib.h>

#include "fleetproof/agent.h"

typedef struct ticker {
  const fp_host* host;
  fp_controller* controller;
} ticker;

static void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  ticker* self = malloc(sizeof *self);
  (void)briefing;
  if (self == NULL) return NULL;
  self->host = host;
  self->controller = controller;
  return self;
}

static void on_event(void* agent, const fp_event* event) {
  const ticker* self = agent;
  fp_pose pose;
  if (event->kind != FP_EVENT_START && event->kind != FP_EVENT_TIMER) return;
  self->host->get_position(self->controller, &pose);
  self->host->set_timer(self->controller, 0, event->now_ns + 50000000);
}

static void destroy(void* agent) { free(agent); }

const fp_agent_type* fp_agent_query(uint32_t host_abi_major) {
  static const fp_agent_type type = {sizeof(fp_agent_type),
                                     FP_ABI_MAJOR,
                                     FP_ABI_MINOR,
                                     FP_DETERMINISTIC,
                                     "ticker",
                                     "looks where it is",
                                     create,
                                     on_event,
                                     destroy,
                                     NULL,
                                     NULL};
  return host_abi_major == FP_ABI_MAJOR ? &type : NULL;
}
