#pragma once

#include <cstdint>
#include <string>

namespace fleetproof {

// Writes the canonical file of a campaign to `target`, which is replaced if it exists: a fresh SQLite file with the
// rows of the live file below `stop_index` in the order of their keys, then the count and the digest of the rows, and
// no journal. Equal rows give equal bytes, in whatever order and in however many commits the live file got them. The
// live file must be closed; it is left as it is. Throws EngineError if the disk refuses.
void write_canonical_file(const std::string& live_path, const std::string& target, std::uint64_t stop_index);

// Makes `from`, with all its bytes on the disk, appear as `to` at one instant.
void move_durably(const std::string& from, const std::string& to);

}  // namespace fleetproof
