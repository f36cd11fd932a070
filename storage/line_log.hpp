#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// NAME.sessions.jsonl beside the archive: where, when and with which files its runs were made.
std::string session_log_path(const std::string& archive_path);

// Appends whole lines to a log beside the archive, in one piece, so that two programs may write to one file. A new file
// is made if there is none. Throws MachineError if the file cannot be written, or is no regular file.
void append_lines(const std::string& path, const std::string& lines);

// Only a file that this program began is appended to. Throws InputError with `sentence` if the file is there, and its
// first line does not begin with these words.
void require_log(const std::string& path, std::string_view first_words, std::string_view sentence);

// Before work whose lines belong there. Throws InputError with `remedy` if this user may neither write the file nor
// make it: it may be another user's.
void require_appendable(const std::string& path, std::string_view remedy);

// "2026-11-21T22:04:05Z".
std::string utc_now();

}  // namespace fleetproof
