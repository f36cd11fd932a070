#pragma once

#include <string>

#include "storage/archive_writer.hpp"

namespace fleetproof {

// Checks of the place where a results file will be written. These functions change no file.

// Some names have a special meaning in SQLite (":memory:", "file:..."). An absolute path is always a path.
std::string absolute_name(const std::string& path);

// Throws InputError unless `path` is a name in an existing folder.
void require_place(const std::string& path);

// Throws InputError if a file of this name is in the way. Refuse: any file. Replace: any file that is not a campaign
// file of this program.
void require_free_name(const std::string& path, Existing existing);

// The same for the live file. Replace: an earlier live file of this program may exist, and may be empty.
void require_free_live_name(const std::string& live_path, Existing existing);

// A file that a killed program of ours may have left under this name will be replaced. Throws InputError if there is
// another one.
void require_own_rest(const std::string& path);

// A regular file that calls itself a results file, sound or damaged.
bool holds_results(const std::string& path);

// A regular file without a byte.
bool is_empty_file(const std::string& path);

// Explains, by errno, why a file could not be created. Throws InputError, with a remedy, if the place cannot be
// written; throws MachineError if the disk failed.
[[noreturn]] void throw_cannot_make(const std::string& path, int error);

}  // namespace fleetproof
