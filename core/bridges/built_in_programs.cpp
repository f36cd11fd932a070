#include "core/bridges/built_in_programs.hpp"

#include "core/agents/agent_type.hpp"
#include "core/bridges/mqtt/mqtt_broker.hpp"
#include "core/bridges/vda5050/vda5050_programs.hpp"

namespace fleetproof {

std::span<const BuiltInProgram> bridge_programs() {
  static const BuiltInProgram kPrograms[] = {{&mqtt::kMqttBroker},
                                             {&bridges::vda5050::kVehicle, nullptr, agents::kNumbersOnTheWire},
                                             {&bridges::vda5050::kMaster, nullptr, agents::kNumbersOnTheWire}};
  return kPrograms;
}

}  // namespace fleetproof
