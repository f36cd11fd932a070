#include "campaign/cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "campaign/run/engine_identity.hpp"
#include "core/base/catalogue.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {
namespace {

class Cli11Options final : public Options {
 public:
  explicit Cli11Options(CLI::App& app) : app_(app) {}
  void positional(const std::string& name, std::string& value, const std::string& help) override {
    app_.add_option(name, value, help)->required();
  }
  void positional(const std::string& name, std::uint64_t& value, const std::string& help) override {
    app_.add_option(name, value, help)->required()->check(CLI::NonNegativeNumber);
  }
  void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help) override {
    app_.add_option(name, values, help)->required();
  }
  void option(const std::string& names, std::string& value, const std::string& help) override {
    app_.add_option(names, value, help);
  }
  // CLI11 wraps a negative number round to a huge one where the target is unsigned.
  void option(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help) override {
    app_.add_option(names, value, help)->check(CLI::NonNegativeNumber);
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
  return fmt::format("fleetproof {}\ncompiler  {}\nflags     {}\nlibraries {}\nprogram   sha256 {}", self.version,
                     self.compiler, self.flags, self.libraries, self.program_sha256);
}

int say(int code, std::string_view kind, std::string_view what) {
  fmt::print(stderr, "{}: {}\n", kind, what);
  return code;
}

int perform(const Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    return say(kBadInput, "error", error.what());
  } catch (const EngineError& error) {
    return say(kEngineFault, "engine fault", error.what());
  } catch (const InvariantViolation& error) {
    return say(kEngineFault, "engine fault (a bug of fleetproof)", error.what());
  } catch (const std::exception& error) {
    return say(kEngineFault, "engine fault", error.what());
  }
}

// CLI11 has codes of its own for each kind of slip; to us they are all bad usage.
int bad_words(const CLI::App& app, const CLI::ParseError& error, std::span<const Verb> verbs, int argc,
              const char* const* argv) {
  if (error.get_exit_code() == 0) return app.exit(error);
  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string_view> names;
    for (const Verb& verb : verbs) names.push_back(verb.name);
    if (std::ranges::find(names, argv[1]) == names.end()) {
      return say(kBadInput, "error",
                 fmt::format("\"{}\" is not a verb of fleetproof{}", argv[1], name_hint(argv[1], names)));
    }
    return say(kBadInput, "error", fmt::format("{} (see: fleetproof {} --help)", error.what(), argv[1]));
  }
  return say(kBadInput, "error", fmt::format("{} (see: fleetproof --help)", error.what()));
}

}  // namespace

int run_command_line(std::span<const Verb> verbs, int argc, const char* const* argv) {
  CLI::App app(
      "Test campaigns for AGV control software: how often is the 10 cm safety distance broken when messages are lost "
      "and late?",
      "fleetproof");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text);
  app.footer(
      "Exit codes: 0 demonstrated, 1 violated, 2 bad usage or input, 3 engine fault or damaged archive, 4 not "
      "demonstrated, 130/143 interrupted.");
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
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return bad_words(app, error, verbs, argc, argv);
  }
  for (const Prepared& verb : prepared) {
    if (verb.app->parsed()) return perform(verb.action);
  }
  return kBadInput;
}

}  // namespace fleetproof::cli
