#pragma once

#include <span>
#include <string_view>

namespace fleetproof::agents {

// What the reference agents and those of faulty/ mean by the words that they use in notes, states and contents of
// messages: for readers of traces and replay pages.
struct Word {
  std::string_view word;
  std::string_view meaning;
};
std::span<const Word> vocabulary();

}  // namespace fleetproof::agents
