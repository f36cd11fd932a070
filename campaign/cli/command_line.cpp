#include "campaign/cli/command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <sstream>
#include <system_error>

#include "campaign/cli/manual.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/run/engine_identity.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof::cli {
namespace {

// Replaces the word by its number in decimal digits, or says what is wrong with it. Left alone, CLI11 turns a negative
// number into a huge one, and reads "010" as eight.
std::string take_whole_number(std::string& word) {
  const bool is_hexadecimal = word.starts_with("0x");
  const char* const begin = word.data() + (is_hexadecimal ? 2 : 0);
  const char* const end = word.data() + word.size();
  std::uint64_t number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number, is_hexadecimal ? 16 : 10);
  if (error == std::errc() && stop == end) return word = fmt::format("{}", number), std::string();
  const bool is_large = error == std::errc::result_out_of_range && stop == end;
  return fmt::format("{} is refused: expected a whole number from 0{}{}", in_quotes(word),
                     is_large ? " to 2^64 - 1" : "",
                     word == "fresh" ? "; seed = \"fresh\" stands in the campaign file" : "");
}
const CLI::Validator kWholeNumber(take_whole_number, "");

class Cli11Options final : public Options {
 public:
  explicit Cli11Options(CLI::App& app) : app_(app) {}
  void positional(const std::string& name, std::string& value, const std::string& help) override {
    app_.add_option(name, value, help)->required();
  }
  void positional(const std::string& name, std::uint64_t& value, const std::string& help) override {
    app_.add_option(name, value, help)->required()->transform(kWholeNumber);
  }
  void optional_positional(const std::string& name, std::string& value, const std::string& help) override {
    app_.add_option(name, value, help);
  }
  void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help) override {
    app_.add_option(name, values, help)->required();
  }
  void option(const std::string& names, std::string& value, const std::string& help) override {
    app_.add_option(names, value, help);
  }
  void option(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help) override {
    app_.add_option(names, value, help)->transform(kWholeNumber);
  }
  void option(const std::string& names, std::optional<double>& value, const std::string& help) override {
    app_.add_option(names, value, help);
  }
  void option(const std::string& names, std::vector<std::string>& values, const std::string& help) override {
    app_.add_option(names, values, help)->expected(1)->take_all();
  }
  void flag(const std::string& names, bool& value, const std::string& help) override {
    app_.add_flag(names, value, help);
  }

 private:
  CLI::App& app_;
};

std::string version_text() {
  const EngineIdentity self = engine_identity();
  return fmt::format(
      "fleetproof {}\ncompiler  {}\nflags     {}\nlibraries {}\nprogram   sha256 {}\nsource    commit {}", self.version,
      self.compiler, self.flags, self.libraries, self.program_sha256, self.source_commit);
}

int say(int code, std::string_view kind, std::string_view what) {
  talk("{}: {}\n", kind, what);
  return code;
}

// The system refused: a folder that is gone, a link to itself, no memory or no room for a thread.
int say_machine(const std::system_error& error) {
  std::error_code gone;
  (void)std::filesystem::current_path(gone);
  if (gone)
    return say(kBadInput, "error",
               fmt::format("the current folder cannot be found ({}); change into one that is there", gone.message()));
  const auto* of_file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (of_file == nullptr)
    return say(kEngineFault, "error",
               fmt::format("the system refused ({}); give this program more memory and processes, or use fewer workers "
                           "(--jobs)",
                           error.code().message()));
  return say(kBadInput, "error",
             fmt::format("{}: cannot be used ({}); correct the path, or look at its permissions",
                         printable(of_file->path1().string()), error.code().message()));
}

int perform(const Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    return say(kBadInput, "error", error.what());
  } catch (const OutputLost& lost) {
    return lost.reader_left() ? int{kEngineFault} : say(kEngineFault, "error", lost.what());
  } catch (const MachineError& error) {
    return say(kEngineFault, "error", error.what());
  } catch (const EngineError& error) {
    return say(kEngineFault, "engine fault", error.what());
  } catch (const InvariantViolation& error) {
    return say(kEngineFault, "engine fault (a bug of fleetproof)", error.what());
  } catch (const std::bad_alloc&) {
    return say(
        kEngineFault, "error",
        "there is not enough memory; give this program more of it, use fewer workers (--jobs), or a smaller case");
  } catch (const std::system_error& error) {
    return say_machine(error);
  } catch (const std::exception& error) {
    return say(kEngineFault, "engine fault", error.what());
  }
}

// A library ends the program if it gets no thread: then nobody is left to catch what it threw. There may be no memory
// for a text either.
[[noreturn]] void end_without_catcher() {
  static constexpr std::string_view kWithoutText = "error: the program cannot go on; give it more memory\n";
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const InvariantViolation&) {  // its place is in the stack
    std::abort();
  } catch (const std::exception& error) {
    try {
      say(kEngineFault, "error",
          fmt::format("the program cannot go on ({}); give it more memory and processes, or use fewer workers (--jobs)",
                      printable(error.what())));
    } catch (...) {
      steer_terminal(kWithoutText);
    }
    ::_exit(kEngineFault);
  }
  std::abort();
}

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

// An error for the first word that looks like an option but is no option of `app`. Empty if there is no such word.
std::string unknown_option(const CLI::App& app, std::span<const char* const> words) {
  const std::vector<std::string> known = options_of(app);
  for (std::string_view word : words) {
    word = word.substr(0, word.find('='));
    if (!word.starts_with("--") || std::ranges::find(known, word) != known.end()) continue;
    return fmt::format("{} is not an option{}", in_quotes(word),
                       name_hint(word, std::vector<std::string_view>(known.begin(), known.end())));
  }
  return {};
}

// CLI11 has an exit code for each kind of mistake; here every mistake is bad usage.
int bad_usage(const CLI::App& app, const CLI::ParseError& error, std::span<const Verb> verbs,
              std::span<const char* const> words) {
  const bool has_verb = !words.empty() && words[0][0] != '-';
  const CLI::App* asked = &app;
  if (has_verb) {
    const std::string_view verb = words[0];
    std::vector<std::string_view> names;
    for (const Verb& known : verbs) names.push_back(known.name);
    if (std::ranges::find(names, verb) == names.end()) {
      return say(kBadInput, "error",
                 fmt::format("{} is not a verb of fleetproof{}", in_quotes(verb), name_hint(verb, names)));
    }
    asked = app.get_subcommand(std::string(verb));
  }
  std::string what = error.what();
  // Without a verb, CLI11 only says that a verb is needed. With a verb, it lists all superfluous words.
  if (!has_verb || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const std::string unknown = unknown_option(*asked, words); !unknown.empty()) what = unknown;
  }
  return say(kBadInput, "error",
             fmt::format("{} (see: fleetproof {}--help)", what, has_verb ? asked->get_name() + " " : ""));
}

}  // namespace

std::string exit_codes_text() {
  return fmt::format(
      "{} demonstrated, {} violated, {} bad usage or input, {} engine fault or damaged archive, {} not demonstrated, "
      "{}, {}, {} interrupted",
      static_cast<int>(kDemonstrated), static_cast<int>(kViolated), static_cast<int>(kBadInput),
      static_cast<int>(kEngineFault), static_cast<int>(kNotDemonstrated), exit_code_of_signal(SIGHUP),
      exit_code_of_signal(SIGINT), exit_code_of_signal(SIGTERM));
}

int run_command_line(std::span<const Verb> verbs, int argc, const char* const* argv) {
  std::set_terminate(end_without_catcher);
  if (argc == 2) {  // for the package, not for people
    const std::string_view word = argv[1];
    if (word == "--man-page") return put_text(man_page(verbs, engine_identity().version)), kDemonstrated;
    if (word == "--bash-completion") return put_text(bash_completion(verbs)), kDemonstrated;
    if (word == "--zsh-completion") return put_text(zsh_completion(verbs)), kDemonstrated;
  }
  CLI::App app(
      "Test campaigns for AGV control software: how often is the 10 cm safety distance broken when messages are lost "
      "and late?",
      "fleetproof");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  app.footer("Exit codes: " + exit_codes_text() + ".");
  struct Prepared {
    CLI::App* app;
    std::unique_ptr<Cli11Options> options;
    Action action;
  };
  std::vector<Prepared> prepared;
  for (const Verb& verb : verbs) {
    CLI::App* sub = app.add_subcommand(std::string(verb.name), std::string(verb.description));
    sub->fallthrough();
    sub->footer("Example: " + std::string(verb.example));
    auto options = std::make_unique<Cli11Options>(*sub);
    Action action = verb.prepare(*options);
    prepared.push_back({sub, std::move(options), std::move(action)});
  }
  return perform([&]() -> int {
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) return bad_usage(app, error, verbs, std::span(argv, argv + argc).subspan(1));
      std::ostringstream help_or_version;
      app.exit(error, help_or_version, help_or_version);
      put_text(help_or_version.str());
      return kDemonstrated;
    }
    for (const Prepared& verb : prepared) {
      if (verb.app->parsed()) return verb.action();
    }
    return kBadInput;
  });
}

}  // namespace fleetproof::cli
