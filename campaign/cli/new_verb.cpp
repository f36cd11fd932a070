#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

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
  bool is_short = false, is_central = false;
};

// What a campaign of a central fleet says in place of a line of the usual one.
struct InPlace {
  std::string_view line, by;
};
constexpr InPlace kCentral[] = {
    {"name = \"standard\"\n", "name = \"standard-central\"\n"},
    {"name = \"standard-short\"\n", "name = \"standard-short-central\"\n"},
    {"agents = [\"hull-lock\"]\n", "agents = [{ vehicle = \"follower\", computer = \"zone-server\" }]\n"},
    {"agent = \"hull-lock\"\n", "agent = \"zone-server+follower\"\n"},
    {"[faults]\n", "[faults]\nlow_battery_share = 0.3  # these go to a charger first\n"},
    {"[world]\n",
     "# The server, whose faults are drawn as those of the AGVs are.\n[[computers]]\nname = \"server\"\n\n"
     "[computers.faults]\nrestarts_per_hour = 4\nrestart_s = 2\npower_failures_per_hour = 1\npower_back_s = 10\n"
     "freezes_per_hour = 4\ndisk_losses_per_hour = 2\ndisk_loss_s = 2\n\n[world]\n"
     "transports = \"open\"  # the server hears of them, and says who fetches which\nwithdrawn_share = 0.2\n"},
};

std::string central(std::string_view usual) {
  std::string text(usual);
  for (const InPlace& other : kCentral) {
    const std::size_t at = text.find("\n" + std::string(other.line));
    if (at != std::string::npos) text.replace(at + 1, other.line.size(), other.by);
  }
  return text;
}

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
  const std::string_view usual = words.is_short ? short_standard_campaign() : standard_campaign();
  const std::string text = words.is_central ? central(usual) : std::string(usual);
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
  options.flag("--central", words->is_central, "for fleets with a server: open transports, and faults of the server");
  return [words] { return new_file(*words); };
}

}  // namespace fleetproof::cli
