// An agent that stands still, under the name that the environment gives it: shared objects come with any name.
#include <cstdlib>
#include <cstring>

#include "core/sdk/fleetproof/agent.h"

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = std::getenv("FLEETPROOF_TEST_AGENT");  // null if there is none
  type.description = "stands still";
  type.create = [](const fp_host*, fp_controller* controller, const fp_briefing*) -> void* { return controller; };
  type.on_event = [](void*, const fp_event*) {};
  type.destroy = [](void*) {};
  return &type;
}
