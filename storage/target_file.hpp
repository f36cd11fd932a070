#pragma once

#include <string>

#include "storage/archive.hpp"

namespace fleetproof {

// What may stand, and what may be written, where a campaign file is to appear. None of these touches a file.

// SQLite gives some names a meaning of their own (":memory:", "file:..."); an absolute path is only ever a path.
std::string absolute_name(const std::string& path);

// Throws InputError unless `path` is a name in a folder that is there.
void require_place(const std::string& path);

// Throws InputError if a file of this name stands in the way: any with Refuse; with Replace, any but a campaign file of
// ours.
void require_free_name(const std::string& path, Existing existing);

// The same for the live file; with Replace an earlier one of ours may be there, and may be empty.
void require_free_live_name(const std::string& live_path, Existing existing);

// For a file that could not be made, by errno. Throws InputError if the place cannot be written (the remedy is named),
// EngineError if the disk refused.
[[noreturn]] void throw_cannot_make(const std::string& path, int error);

}  // namespace fleetproof
