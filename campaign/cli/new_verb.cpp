#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/cli/agent_starts.hpp"
#include "campaign/cli/standard_campaigns.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/run/agent_programs.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "generators/formats/importer.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRemedy = "choose another path";

struct NewWords {
  std::string what, path, language, style;
  bool is_short = false, is_central = false;
};

struct NewFile {
  std::string path, text;
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

// All of them or, if a place is taken, none.
void write_new(const std::vector<NewFile>& files) {
  std::vector<const NewFile*> missing;
  for (const NewFile& file : files) {
    if (is_missing(file.path, file.text)) missing.push_back(&file);
  }
  for (const NewFile* file : missing) write_text_file(file->path, file->text, kRemedy);
}

// ---- a campaign

int new_campaign(const NewWords& words) {
  if (!words.language.empty() || !words.style.empty())
    throw InputError(words.language.empty() ? "--style" : "--language",
                     "is for an agent; write: fleetproof new agent NAME");
  const std::string path = words.path.empty() ? "campaign.toml" : words.path;
  if (has_ending(path, ".json"))
    throw InputError(path, "ends in .json, and a campaign file is TOML; name it as in night.toml");
  const std::string layout = (fs::path(path).parent_path() / kLongHaulFile).string();
  const std::string_view usual = words.is_short ? short_standard_campaign() : standard_campaign();
  write_new(
      {{layout, std::string(long_haul_layout())}, {path, words.is_central ? central(usual) : std::string(usual)}});
  const std::string file = shell_word(path);
  put("{} and the layout {} that it names.\nName your agent and your layouts in it, then:\n", printable(path),
      printable(layout));
  put("  fleetproof plan {} --max-time 8h   # what a night gives\n  fleetproof run {}\n", file, file);
  return kDemonstrated;
}

// ---- an agent

// It becomes the name of a folder, of a CMake target and of the agent in results.
void require_name(const std::string& name) {
  constexpr std::size_t kLongest = 60;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto may_follow = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; };
  if (name.empty()) throw InputError("NAME", "is missing; write it as in: fleetproof new agent my-agent");
  if (name.size() > kLongest || !is_letter(name.front()) || !std::ranges::all_of(name, may_follow))
    throw InputError("NAME", fmt::format("{} is no name for an agent: a letter, then letters, digits, - and _; {} at "
                                         "most",
                                         in_quotes(name), kLongest));
  const AgentPrograms built_in;
  if (std::ranges::any_of(built_in.all(), [&](const AgentProgram& agent) { return agent.name == name; }))
    throw InputError("NAME", fmt::format("{} is an agent of fleetproof list agents; choose another name", name));
}

const AgentStart& start_for(const std::string& language, const std::string& style) {
  std::vector<std::string_view> languages, styles;
  for (const AgentStart& start : agent_starts()) {
    if (std::ranges::find(languages, start.language) == languages.end()) languages.push_back(start.language);
    if (start.language == language) styles.push_back(start.style);
    if (start.language == language && start.style == style) return start;
  }
  if (styles.empty())
    throw InputError("--language", fmt::format("{} has no start{}; every other language: the page lockstep.md",
                                               in_quotes(language), name_hint(language, languages)));
  throw InputError("--style", fmt::format("there is no start {} in {}; known: {}", in_quotes(style), language,
                                          fmt::join(styles, ", ")));
}

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
  std::string result;
  for (std::size_t at = 0; (at = text.find(what)) != std::string_view::npos; text.remove_prefix(at + what.size()))
    result.append(text.substr(0, at)).append(by);
  return result.append(text);
}

std::string build_file(const std::string& name, const AgentStart& start) {
  const bool is_c = start.language == "c";
  return fmt::format(
      "# {0}, against an installed fleetproof: cmake -B build && cmake --build build\n"
      "cmake_minimum_required(VERSION 3.25)\nproject({0} {1})\nset(CMAKE_{1}_STANDARD {2})\n"
      "find_package(fleetproof REQUIRED)\nfleetproof_agent({0} {3}agent.{4})\n",
      name, is_c ? "C" : "CXX", is_c ? 11 : 20, start.style == "straight" ? "BLOCKING " : "", start.language);
}

// What to type next to build it. Beside this program stand either the sources or an installation.
std::string build_commands(const std::string& name, const AgentStart& start) {
  const fs::path root = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
  const fs::path sources = root.parent_path() / "core/sdk";
  std::error_code ignored;
  const bool is_installed = !fs::exists(sources / "fleetproof/agent.h", ignored);
  if (start.language == "python") {
    const fs::path package = is_installed ? root / "share/fleetproof/python" : sources / "python";
    return fmt::format("export PYTHONPATH={}", shell_word(package.string()));
  }
  const std::string boost = "  # needs Boost.Context: apt-get install libboost-context-dev";
  const bool is_blocking = start.style == "straight";
  if (is_installed) return "cmake -B build && cmake --build build" + (is_blocking ? boost : "");
  return fmt::format("mkdir -p build && {} -O2 -shared -fPIC -I {} agent.{}{} -o build/{}.so{}",
                     start.language == "c" ? "gcc" : "g++ -std=c++20", shell_word(sources.string()), start.language,
                     is_blocking ? " -lboost_context" : "", name, is_blocking ? boost : "");
}

int new_agent(const NewWords& words) {
  if (words.is_short || words.is_central)
    throw InputError(words.is_short ? "--short" : "--central",
                     "is for a campaign; the start of a central fleet is: fleetproof new agent NAME --style master");
  const std::string& name = words.path;
  require_name(name);
  const AgentStart& start =
      start_for(words.language.empty() ? "cpp" : words.language, words.style.empty() ? "callbacks" : words.style);
  const bool is_python = start.language == "python";
  const std::string program =
      is_python ? R"({ run = "python3 agent.py", way = "lockstep" })" : fmt::format("\"build/{}.so\"", name);
  const std::string folder = name + "/";
  std::vector<NewFile> files;
  files.push_back({folder + (is_python ? "agent.py" : "agent." + std::string(start.language)),
                   replaced(start.source, start.placeholder, name)});
  if (!is_python) files.push_back({folder + "CMakeLists.txt", build_file(name, start)});
  files.push_back(
      {folder + name + ".toml", replaced(replaced(start.campaign, start.placeholder, name), "@PROGRAM@", program)});
  std::error_code error;
  fs::create_directory(name, error);
  if (error) throw InputError(name, fmt::format("this folder cannot be made: {}; {}", error.message(), kRemedy));
  write_new(files);
  put("{} holds {} and the campaign {}.toml that tries it. Next:\n  cd {}\n  {}\n", folder, files.front().path, name,
      name, build_commands(name, start));
  put("  fleetproof check {0}.toml && fleetproof run {0}.toml\n  fleetproof replay {0}.db 0 --html run.html\n", name);
  return kDemonstrated;
}

int begin(const NewWords& words) {
  if (words.what == "campaign") return new_campaign(words);
  if (words.what == "agent") return new_agent(words);
  throw InputError("WHAT", fmt::format("{} cannot be begun; write: fleetproof new campaign FILE, or: fleetproof new "
                                       "agent NAME",
                                       in_quotes(words.what)));
}

}  // namespace

Action prepare_new(Options& options) {
  auto words = std::make_shared<NewWords>();
  options.positional("WHAT", words->what,
                     "campaign: the standard campaign, with explanations; agent: control software");
  options.optional_positional("NAME", words->path, "the file to write (default: campaign.toml), or the agent's name");
  options.option("--language", words->language, "of the agent: cpp (default), c, python");
  options.option("--style", words->style, "of the agent: callbacks (default), straight (not in c), master (a server)");
  options.flag("--short", words->is_short, "the campaign of short runs, which finds faults and states no rates");
  options.flag("--central", words->is_central, "for fleets with a server: open transports, and faults of the server");
  return [words] { return begin(*words); };
}

}  // namespace fleetproof::cli
