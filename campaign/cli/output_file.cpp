#include "campaign/cli/output_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "core/base/error.hpp"
#include "generators/text/json_value.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
#include "reports/replay_page/replay_page.hpp"

namespace fleetproof::cli {
namespace {

// A file larger than that is known by its beginning.
constexpr std::size_t kMostRead = std::size_t{64} << 20, kBeginning = 4096;

// Whether `text` is a JSON object with this key. False if it is no JSON.
bool has_key(std::string_view text, std::string_view key) {
  try {
    return parse_json(text, "").find(key) != nullptr;
  } catch (const InputError&) {
    return false;
  }
}

// The same of a key that stands in the beginning of a file that the program has written.
bool begins_with_key(std::string_view text, std::string_view key) {
  if (text.size() < kMostRead) return has_key(text, key);
  return text.starts_with('{') &&
         text.substr(0, kBeginning).find(fmt::format("\"{}\":", key)) != std::string_view::npos;
}

bool is_layout(std::string_view text) { return has_key(text, "layout") && !has_key(text, "agvs"); }
bool is_lif(std::string_view text) { return has_key(text, "layouts"); }
bool is_csv(std::string_view text) {
  const auto heading = TextLines(text).next();
  return heading && (*heading == "layout" || heading->starts_with("layout,") || heading->starts_with("id,") ||
                     heading->starts_with("#"));
}
bool is_picture(std::string_view text) {
  return text.starts_with("<svg") || (text.starts_with("<?xml") && text.find("<svg") != std::string_view::npos);
}
bool is_scenario(std::string_view text) { return has_key(text, "agvs"); }
// Every format for people begins with the title.
bool is_report(std::string_view text) {
  const bool is_page =
      text.starts_with("<!DOCTYPE html>") && text.find("content=\"fleetproof report\"") != std::string_view::npos;
  return is_page || text.starts_with("fleetproof report") || text.starts_with("# fleetproof report") ||
         text.find("<testsuites name=\"fleetproof\"") != std::string_view::npos ||
         (has_key(text, "schema_version") && has_key(text, "verdict"));
}
// A line of text begins with an instant to the nanosecond.
bool is_trace(std::string_view text) {
  const std::size_t digits = text.find_first_not_of(' ');
  const std::size_t point = text.find_first_not_of("0123456789", digits);
  return text.starts_with("{\"t_ns\":") || (point != std::string_view::npos && point > digits && text[point] == '.' &&
                                            text.find_first_not_of("0123456789", point + 1) == point + 10);
}
bool is_pieces(std::string_view text) {
  return begins_with_key(text, "bodies") && begins_with_key(text, "safety_distance_m");
}
bool is_chrome_trace(std::string_view text) { return begins_with_key(text, "traceEvents"); }
bool is_poses(std::string_view text) { return text.starts_with("body,t_s,"); }
bool is_sensitivity(std::string_view text) { return has_key(text, "worlds") && has_key(text, "faults"); }

bool is_replay_page(std::string_view text) {
  return text.starts_with("<!DOCTYPE html>") && text.find(web::kReplayPageMark) != std::string_view::npos;
}
bool is_findings(std::string_view text) {
  return text.starts_with("# findings") || text.find("[[finding]]") != std::string_view::npos;
}
bool is_found_findings(std::string_view text) { return has_key(text, "findings") && has_key(text, "looked_at"); }
bool is_explanation(std::string_view text) { return text.starts_with("# F-"); }
bool is_found_explanation(std::string_view text) { return has_key(text, "sentences") && has_key(text, "branches"); }
bool is_fleet(std::string_view text) { return text.starts_with("# vehicles of "); }

struct KnownKind {
  std::string_view noun;
  bool (*is_one)(std::string_view text);
};

// In the order of OutputKind.
constexpr KnownKind kKinds[] = {{"a layout file", is_layout},
                                {"a LIF file", is_lif},
                                {"a CSV layout", is_csv},
                                {"an SVG picture", is_picture},
                                {"a scenario file", is_scenario},
                                {"a report", is_report},
                                {"a measured sensitivity", is_sensitivity},
                                {"a trace", is_trace},
                                {"a file of pieces", is_pieces},
                                {"a file of poses", is_poses},
                                {"a Chrome trace", is_chrome_trace},
                                {"a replay page", is_replay_page},
                                {"a file of vehicles", is_fleet},
                                {"a findings file", is_findings},
                                {"findings of a campaign", is_found_findings},
                                {"an explanation", is_explanation},
                                {"the explanation of a run", is_found_explanation}};

std::string remedy_of(const OutputFile& file) { return "choose another path for " + file.option; }

// A new file needs a folder in which files can be made.
void require_place(const OutputFile& file) {
  const std::string folder = std::filesystem::path(file.path).parent_path().string();
  if (::access(folder.empty() ? "." : (folder + "/.").c_str(), W_OK | X_OK) == 0) return;
  const std::string why = std::generic_category().message(errno);
  throw InputError(file.path, fmt::format("cannot be written ({}); {}", why, remedy_of(file)));
}

}  // namespace

void require_writable(const OutputFile& file) {
  const KnownKind& kind = kKinds[static_cast<std::size_t>(file.kind)];
  std::error_code ignored;
  if (!std::filesystem::exists(file.path, ignored)) return require_place(file);
  if (!std::filesystem::is_regular_file(file.path, ignored)) return;
  const std::string before = read_beginning(file.path, kMostRead);
  if (before.empty() || kind.is_one(before)) return;
  throw InputError(
      file.path, fmt::format("is there already and is not {}; it is not overwritten; {}", kind.noun, remedy_of(file)));
}

void write_whole(const OutputFile& file, std::string_view text) {
  require_writable(file);
  write_text_file(file.path, text, remedy_of(file));
}

}  // namespace fleetproof::cli
