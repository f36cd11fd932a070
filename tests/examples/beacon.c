/* An agent in C: it stays where it is, and tells all others once a second that it is there. */
#include <stdlib.h>

#include <fleetproof/agent.h>

typedef struct beacon {
  const fp_host* host;
  fp_controller* controller;
} beacon;

static void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  beacon* self = malloc(sizeof *self);
  (void)briefing;
  if (self == NULL) {
    if (host->abi_minor >= 4) host->cannot_start(controller, "no memory");
    return NULL;
  }
  self->host = host;
  self->controller = controller;
  return self;
}

static void on_event(void* agent, const fp_event* event) {
  beacon* self = agent;
  if (event->kind == FP_EVENT_TIMER) self->host->send_broadcast(self->controller, "here", 4);
  if (event->kind == FP_EVENT_START || event->kind == FP_EVENT_TIMER)
    self->host->set_timer(self->controller, 1, event->now_ns + 1000000000);
}

static void destroy(void* agent) { free(agent); }

#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const fp_agent_type*
fp_agent_query(uint32_t host_abi_major) {
  static const fp_agent_type type = {sizeof(fp_agent_type),
                                     FP_ABI_MAJOR,
                                     FP_ABI_MINOR,
                                     FP_DETERMINISTIC,
                                     "beacon",
                                     "stays and says so",
                                     create,
                                     on_event,
                                     destroy,
                                     NULL,
                                     NULL};
  return host_abi_major == FP_ABI_MAJOR ? &type : NULL;
}
