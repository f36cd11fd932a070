#pragma once

#include <string>

namespace fleetproof {

// Call this inside `catch (const SQLite::Exception&)`. It throws an error with a sentence that says what happened to
// the disk or the file, and what to do: MachineError if the machine failed, EngineError if the file is damaged.
[[noreturn]] void throw_archive_error(const std::string& path);

}  // namespace fleetproof
