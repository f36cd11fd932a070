// hull-lock as a shared object, under a name of its own. It stands for a user's control software in tests.
#include "core/agents/agent_type.hpp"

namespace {

fp_agent_type renamed() {
  fp_agent_type type = fleetproof::agents::kHullLock;
  type.name = "hull-lock-plugin";
  return type;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t host_abi_major) {
  static const fp_agent_type type = renamed();
  return host_abi_major == FP_ABI_MAJOR ? &type : nullptr;
}
