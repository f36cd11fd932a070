#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "storage/records.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// Whether nothing of a run stands on a page by itself: it may then be counted together with others.
using MayFold = std::function<bool(const RunRecord& run)>;

// Folds the runs of a complete live file: fills the table `folded` of the canonical file `db`, and the table
// `temp.kept` with the indices of all other runs. These are the runs that may not be folded. More runs keep their rows,
// because a page may name them: the first one in which an agent meets something or is in safe mode; one whose audit
// came out differently; one with a recording. So does one with another time or fleet than its cell has. Requires: the
// live file is closed and attached to `db` as `live`. Returns how many runs have a trace that another run of their cell
// had before. Throws SQLite::Exception, and what ArchiveReader throws.
std::uint64_t fold_runs(SQLite::Database& db, const std::string& live_path, const MayFold& may_fold);

}  // namespace fleetproof
