#pragma once

#include <cstdint>
#include <string>

namespace fleetproof {

// Files that appear under their final name only when all of their bytes are on the disk. Functions that write throw
// MachineError if the disk fails.

// Brings all bytes of `from` to the disk and renames it to `to`, at one instant. An existing file is replaced.
void move_durably(const std::string& from, const std::string& to);

// False also if one of the files cannot be read.
bool same_bytes(const std::string& one, const std::string& other);

// First: the name was free. Again: a file with the same bytes was there. Differs: a file with other bytes was there.
enum class Publication : std::uint8_t { First, Again, Differs };

// Brings all bytes of `from` to the disk and gives them the name `to`, unless a file of this name is there already: it
// is never replaced. `from` is removed, but for Differs. Many programs on many machines may publish one name at once:
// at most one is First.
Publication publish_once(const std::string& from, const std::string& to);

}  // namespace fleetproof
