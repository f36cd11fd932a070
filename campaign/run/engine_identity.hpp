#pragma once

#include "storage/records.hpp"

namespace fleetproof {

// What an archive says about the program that wrote it. The first call reads and hashes the program's own file, so only
// what writes or compares an archive calls this.
EngineIdentity engine_identity();

}  // namespace fleetproof
