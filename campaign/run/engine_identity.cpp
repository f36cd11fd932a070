#include "campaign/run/engine_identity.hpp"

#include "campaign/run/sha256.hpp"
#include "source_commit.hpp"

namespace fleetproof {

EngineIdentity engine_identity() {
  static const EngineIdentity identity = {FLEETPROOF_VERSION,   sha256_of_file("/proc/self/exe"),
                                          FLEETPROOF_COMPILER,  FLEETPROOF_FLAGS,
                                          FLEETPROOF_LIBRARIES, FLEETPROOF_SOURCE_COMMIT};
  return identity;
}

}  // namespace fleetproof
