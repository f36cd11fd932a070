#include "core/agents/agent_type.hpp"

#include <cstddef>
#include <string>
#include <utility>

namespace fleetproof::agents {

bool cannot_start(const fp_host& host, fp_controller* controller, const char* why) {
  constexpr std::uint32_t kSaysWhy = 4;  // minor version
  if (host.abi_minor >= kSaysWhy) host.cannot_start(controller, why);
  return false;
}

bool has_numbers_for_all(const fp_host& host, fp_controller* controller, const fp_briefing& briefing) {
  const fp_map& map = *briefing.map;
  std::string text;
  for (const auto& [count, what] : {std::pair(map.station_count, "stations"), std::pair(map.lane_count, "drives"),
                                    std::pair(briefing.fleet_count, "AGVs")}) {
    if (count > kNumbersOnTheWire) text += (text.empty() ? "there are " : " and ") + std::to_string(count) + " " + what;
  }
  if (text.empty()) return true;
  text += ", and a message can name " + std::to_string(kNumbersOnTheWire) + " of each";
  return cannot_start(host, controller, text.c_str());
}

bool gets_own_transports(const fp_host& host, fp_controller* controller, const fp_briefing& briefing) {
  const bool tells_orders = briefing.struct_size >= offsetof(fp_briefing, orders) + sizeof(briefing.orders);
  if (!tells_orders || briefing.orders != FP_ORDERS_OPEN || briefing.computer_count > 0) return true;
  return cannot_start(
      host, controller,
      "it carries out assigned transports only; those of this run are open, and no computer distributes "
      "them");
}

}  // namespace fleetproof::agents
