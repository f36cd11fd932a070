#include "reports/attempts/looks.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "core/base/json_text.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {
namespace {

// By the number of runs that were there.
std::optional<std::set<std::uint64_t>> looks_in(const std::string& log) {
  std::set<std::uint64_t> looks;
  const bool is_there = for_each_log_line(log, [&](std::string_view line) {
    const auto json = read_sorted_json(line);
    if (!json.is_object() || !(json.contains("ended_utc") || json.contains("looked_utc"))) return;
    if (const auto runs = json.find("runs_stored"); runs != json.end() && runs->is_number_unsigned())
      looks.insert(runs->get<std::uint64_t>());
  });
  return is_there ? std::optional(looks) : std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> looks_at(const std::string& archive_path) {
  const auto looks = looks_in(session_log_path(archive_path));
  return looks ? std::optional<std::uint64_t>(looks->size()) : std::nullopt;
}

void note_look(const std::string& archive_path, std::uint64_t runs) {
  const std::string log = session_log_path(archive_path);
  const auto looks = looks_in(log);
  if (!looks || looks->contains(runs)) return;
  append_lines(log, fmt::format("{{\"looked_utc\":\"{}\",\"runs_stored\":{}}}\n", utc_now(), runs));
}

}  // namespace fleetproof
