#pragma once

#include <chrono>
#include <ctime>
#include <optional>
#include <string>

namespace fleetproof {

// "90", "90s", "45m", "5h30m", "1h2m3s": a duration of at least 1 s. Throws InputError.
std::chrono::seconds duration_of(const std::string& text, const std::string& where);

// The same for a reader, rounded to seconds, and to minutes from one hour on: "42s", "5m03s", "5h30m".
std::string duration_text(double seconds);

// "06:00" or "06:00:30": the time from `now` until the clock on the wall shows this next, in local time. Throws
// InputError.
std::chrono::seconds time_until(const std::string& text, std::time_t now, const std::string& where);

}  // namespace fleetproof
