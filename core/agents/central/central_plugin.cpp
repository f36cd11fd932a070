// The two programs of a central fleet in one shared object, under a name of their own: the role in the briefing says
// which of them an agent is. They stand for a user's control software in tests.
#include "core/agents/central/programs.hpp"

namespace {
using namespace fleetproof::agents::central;

// What the C table holds as an agent.
struct Participant {
  const fp_agent_type* type;
  void* agent;
};

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  const fp_agent_type& type = briefing->role == FP_COMPUTER ? kZoneServer : kFollower;
  void* agent = type.create(host, controller, briefing);
  return agent == nullptr ? nullptr : new Participant{&type, agent};
}

void on_event(void* agent, const fp_event* event) {
  const auto* self = static_cast<Participant*>(agent);
  self->type->on_event(self->agent, event);
}

void destroy(void* agent) {
  const auto* self = static_cast<Participant*>(agent);
  self->type->destroy(self->agent);
  delete self;
}

constinit const fp_agent_type kBoth{sizeof(fp_agent_type),
                                    FP_ABI_MAJOR,
                                    FP_ABI_MINOR,
                                    FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
                                    "central-plugin",
                                    "zone-server on the computer, follower on board",
                                    create,
                                    on_event,
                                    destroy,
                                    nullptr,
                                    nullptr};
}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t host_abi_major) {
  return host_abi_major == FP_ABI_MAJOR ? &kBoth : nullptr;
}
