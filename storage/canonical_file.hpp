#pragma once

#include <cstdint>
#include <string>

#include "storage/fold.hpp"

namespace fleetproof {

// Writes the canonical file of a campaign to `target`, and replaces an existing file. It is a fresh SQLite file without
// a journal. It contains the rows of the live file below `stop_index`, in the order of their keys, the digests of their
// blocks, their count and the seal. Equal rows give equal bytes: the order and the commits of the live file do not
// matter. With `may_fold`, runs are folded. Requires: the live file is closed; if runs are folded, the campaign is
// complete. The live file is not changed. Throws MachineError if the disk fails.
void write_canonical_file(const std::string& live_path, const std::string& target, std::uint64_t stop_index,
                          const MayFold& may_fold = {});

}  // namespace fleetproof
