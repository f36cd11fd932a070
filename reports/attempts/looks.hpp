#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fleetproof {

// How often somebody looked at a campaign while it grew. The end of each session shows its results, and so does a
// report on a campaign that is not complete; looking twice at the same runs counts once. The session log beside the
// results file has the record; absent without it.
std::optional<std::uint64_t> looks_at(const std::string& archive_path);

// A report shows the first `runs` runs of a campaign that is not complete. Only an existing session log takes the
// record. Throws MachineError if it cannot be written.
void note_look(const std::string& archive_path, std::uint64_t runs);

}  // namespace fleetproof
