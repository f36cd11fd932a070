#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace fleetproof {

// NAME.sessions.jsonl beside the archive: where, when and with which files its runs were made.
std::string session_log_path(const std::string& archive_path);

// Appends whole lines to a log beside the archive, in one piece, so that two programs may write to one file. A new file
// is made if there is none. Throws MachineError if the file cannot be written, or is no regular file.
void append_lines(const std::string& path, const std::string& lines);

// A line of a log: its number, from 1, and its hash.
struct LogLine {
  std::uint64_t number = 0, hash = 0;
  friend bool operator==(const LogLine&, const LogLine&) = default;
};
std::uint64_t line_hash(std::string_view line);  // without its end

// Appends the line that `make` gives for the hash of the line before it (0: there is none). Nobody else appends
// meanwhile. Throws as append_lines.
LogLine append_after(const std::string& path, const std::function<std::string(std::uint64_t hash_before)>& make);

// The text of a log; empty if nothing has the name. Only a file that this program began is appended to: throws
// InputError with `sentence` if its first line does not begin with these words, and throws as read_text_file
// (core/base/regular_file.hpp) if it is no such file.
std::string read_log(const std::string& path, std::string_view first_words, std::string_view sentence);

// Calls `visit` with each line of a log, whoever began it. False if nothing has the name. Throws as read_text_file.
bool for_each_log_line(const std::string& path, const std::function<void(std::string_view line)>& visit);

// Before work whose lines belong there. Throws InputError with `remedy` if this user may neither write the file nor
// make it: it may be another user's.
void require_appendable(const std::string& path, std::string_view remedy);

// "2026-11-21T22:04:05Z".
std::string utc_now();

}  // namespace fleetproof
