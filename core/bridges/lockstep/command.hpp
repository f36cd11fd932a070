#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fleetproof::lockstep {

// Who a process is for.
struct Recipient {
  std::string agv, name, seed;  // {agv}, {name}, {seed}
};

// A command line: words between spaces, in which '...', "..." and a backslash work as in a shell.
class Command {
 public:
  // Throws std::invalid_argument if it has no word, a quote that does not end, or a {word} in braces that means
  // nothing.
  explicit Command(std::string_view text);

  const std::vector<std::string>& words() const { return words_; }
  // Each participant has a process of its own.
  bool is_for_one() const { return has("{agv}") || has("{name}"); }
  // Each run has processes of its own.
  bool is_for_one_run() const { return has("{seed}"); }
  std::vector<std::string> words_for(const Recipient& recipient) const;

 private:
  bool has(std::string_view place) const;

  std::vector<std::string> words_;
};

// The words as one text that reads as the same command.
std::string command_text(const std::vector<std::string>& words);

}  // namespace fleetproof::lockstep
