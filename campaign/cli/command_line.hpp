#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof::cli {

// The options of one verb. Values are bound by reference and must outlive parsing; CLI11 stays in command_line.cpp.
class Options {
 public:
  virtual ~Options() = default;
  virtual void positional(const std::string& name, std::string& value, const std::string& help) = 0;
  virtual void positional(const std::string& name, std::uint64_t& value, const std::string& help) = 0;
  virtual void optional_positional(const std::string& name, std::string& value, const std::string& help) = 0;
  virtual void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help) = 0;
  virtual void option(const std::string& names, std::string& value, const std::string& help) = 0;
  virtual void option(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help) = 0;
  virtual void option(const std::string& names, std::optional<double>& value, const std::string& help) = 0;
  virtual void option(const std::string& names, std::vector<std::string>& values, const std::string& help) = 0;
  virtual void flag(const std::string& names, bool& value, const std::string& help) = 0;
};

// What a verb does after its words are parsed. Returns the exit code.
using Action = std::function<int()>;

struct Verb {
  std::string_view name, description, example;
  Action (*prepare)(Options& options);
};

// All exit codes, and what the help and the manual say of them.
enum ExitCode : int {
  kDemonstrated = 0,
  kViolated = 1,
  kBadInput = 2,
  kEngineFault = 3,
  kNotDemonstrated = 4,
  kCannotTest = 125,  // of `retest --bisect`: git skips the commit
};
std::string exit_codes_text();
// After a signal (SIGHUP, SIGINT, SIGTERM), as shells say it.
constexpr int exit_code_of_signal(int number) { return 128 + number; }

// Parses the words and runs one verb. An exception becomes one clear line on stderr and an exit code.
int run_command_line(std::span<const Verb> verbs, int argc, const char* const* argv);

}  // namespace fleetproof::cli
