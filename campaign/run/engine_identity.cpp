#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "campaign/run/campaign.hpp"
#include "campaign/run/sha256.hpp"

namespace fleetproof {

EngineIdentity engine_identity() {
  static const EngineIdentity identity = [] {
    EngineIdentity self;
    self.version = FLEETPROOF_VERSION;
    std::ifstream program("/proc/self/exe", std::ios::binary);
    self.program_sha256 = sha256_hex(std::string(std::istreambuf_iterator<char>(program), {}));
    self.compiler = FLEETPROOF_COMPILER;
    self.flags = FLEETPROOF_FLAGS;
    self.libraries = FLEETPROOF_LIBRARIES;
    return self;
  }();
  return identity;
}

}  // namespace fleetproof
