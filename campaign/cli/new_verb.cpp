#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "campaign/cli/standard_campaigns.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/formats/importer.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRemedy = "choose another path";

struct NewWords {
  std::string what, path = "campaign.toml";
  bool is_short = false;
};

// Whether the file has to be written. A file with another content is never overwritten.
bool is_missing(const std::string& path, std::string_view text) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path, ignored))) return true;
  if (fs::is_regular_file(path, ignored) && read_text_file(path) == text) return false;
  throw InputError(path, fmt::format("is there already, with another content; it is not overwritten; {}", kRemedy));
}

int new_file(const NewWords& words) {
  if (words.what != "campaign")
    throw InputError("WHAT",
                     fmt::format("{} cannot be begun; write: fleetproof new campaign FILE", in_quotes(words.what)));
  if (has_ending(words.path, ".json"))
    throw InputError(words.path, "ends in .json, and a campaign file is TOML; name it as in night.toml");
  const std::string layout = (fs::path(words.path).parent_path() / kLongHaulFile).string();
  const std::string_view text = words.is_short ? short_standard_campaign() : standard_campaign();
  const bool campaign_missing = is_missing(words.path, text), layout_missing = is_missing(layout, long_haul_layout());
  if (layout_missing) write_text_file(layout, long_haul_layout(), kRemedy);
  if (campaign_missing) write_text_file(words.path, text, kRemedy);
  const std::string file = shell_word(words.path);
  put("{} and the layout {} that it names.\nName your agent and your layouts in it, then:\n", printable(words.path),
      printable(layout));
  put("  fleetproof plan {} --max-time 8h   # what a night gives\n  fleetproof run {}\n", file, file);
  return kDemonstrated;
}

}  // namespace

Action prepare_new(Options& options) {
  auto words = std::make_shared<NewWords>();
  options.positional("WHAT", words->what, "campaign: the standard campaign, with explanations");
  options.optional_positional("FILE", words->path, "the file to write (default: campaign.toml)");
  options.flag("--short", words->is_short, "the campaign of short runs, which finds faults and states no rates");
  return [words] { return new_file(*words); };
}

}  // namespace fleetproof::cli
