#include "core/bridges/built_in_programs.hpp"

#include "core/bridges/mqtt/mqtt_broker.hpp"

namespace fleetproof {

std::span<const BuiltInProgram> bridge_programs() {
  static const BuiltInProgram kPrograms[] = {{&mqtt::kMqttBroker}};
  return kPrograms;
}

}  // namespace fleetproof
