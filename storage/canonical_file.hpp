#pragma once

#include <cstdint>
#include <string>

namespace fleetproof {

// Writes the canonical file of a campaign to `target`, and replaces an existing file. It is a fresh SQLite file without
// a journal. It contains the rows of the live file below `stop_index`, in the order of their keys. Then come the count
// and the digest of the rows. Equal rows give equal bytes: the order and the commits of the live file do not matter.
// Requires: the live file is closed. It is not changed. Throws MachineError if the disk fails.
void write_canonical_file(const std::string& live_path, const std::string& target, std::uint64_t stop_index);

}  // namespace fleetproof
