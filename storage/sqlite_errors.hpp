#pragma once

#include <string>

namespace fleetproof {

// Call it inside `catch (const SQLite::Exception&)`: throws EngineError with a sentence that says what the disk or the
// file did and what to do.
[[noreturn]] void throw_archive_error(const std::string& path);

}  // namespace fleetproof
