#include "core/agents/central/programs.hpp"

namespace fleetproof::agents::central {

bool can_start(const fp_host& host, fp_controller* controller, const fp_briefing& briefing, fp_role role) {
  constexpr std::uint32_t kKnowsComputers = 5;  // minor version
  if (!has_numbers_for_all(host, controller, briefing)) return false;
  if (host.abi_minor < kKnowsComputers) return cannot_start(host, controller, "the host knows no computers");
  if (briefing.role != static_cast<std::uint32_t>(role)) {
    return cannot_start(host, controller,
                        role == FP_AGV ? "follower drives an AGV; a computer needs zone-server"
                                       : "zone-server runs on a computer; the AGVs need follower");
  }
  if (briefing.computer_count > 0) return true;
  return cannot_start(host, controller, "there is no computer for the zone-server that it follows");
}

constinit const fp_agent_type kFollower =
    program<FollowerOptions{}>("follower", "drives as its zone-server grants, and stops where that ends");
constinit const fp_agent_type kZoneServer =
    program<ServerOptions{}>("zone-server", "plans for a fleet of followers and grants each the floor that it may use");

}  // namespace fleetproof::agents::central
