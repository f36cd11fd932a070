// The agent of bridge_cost.cpp as straight-line code.
#include "fleetproof/blocking.hpp"

using namespace fleetproof::blocking;

static void tick(Controller& agv) {
  while (true) {
    agv.position();
    agv.sleep(std::chrono::milliseconds(50));
  }
}

extern "C" const fp_agent_type* fp_agent_query(uint32_t) {
  static const fp_agent_type kType = agent_type<tick>("ticker", "looks where it is");
  return &kType;
}
