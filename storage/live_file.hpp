#pragma once

#include <cstdint>
#include <string>

namespace fleetproof {

// The live file of a campaign, NAME.partial: it grows while the campaign runs. These functions ask for the write lock.

// It has another name until it holds the plan and has a write-ahead log: a kill leaves no live file of which SQLite
// would have to undo a part before a reader can open it.
std::string new_live_name(const std::string& path);

// Makes an empty one. Throws what throw_cannot_make throws.
void make_live_file(const std::string& live_path);

// Removes it, with its log and journal.
void remove_live_file(const std::string& live_path);
void remove_log(const std::string& live_path);  // the log and journal alone

// Brings all of the log into the file itself. Throws MachineError if the disk fails or another process reads the file.
void fold_log(const std::string& live_path);

// Makes the live file of a campaign that goes on: the one that a killed program left, or else a copy of the published
// file at `path`. Throws MachineError if the disk fails; then both are as they were.
enum class LiveFile : std::uint8_t { Left, Copied, None };
LiveFile bring_back_live_file(const std::string& path, const std::string& live_path);

}  // namespace fleetproof
