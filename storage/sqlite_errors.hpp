#pragma once

#include <string>

namespace fleetproof {

// Call this inside `catch (const SQLite::Exception&)`. It throws EngineError with a sentence that says what happened to
// the disk or the file, and what to do.
[[noreturn]] void throw_archive_error(const std::string& path);

}  // namespace fleetproof
