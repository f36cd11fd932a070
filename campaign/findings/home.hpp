#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "campaign/findings/failure_needs.hpp"

namespace fleetproof {

// What many failures of an agent have in common. Other failures of it join them if it takes them.
struct Home {
  std::vector<std::string> needs;
  std::string doing;
  std::vector<std::string> words;
  std::size_t size = 0;
  bool is_told_by_words = false;  // whatever else a failure needs or does without
  bool takes_more = true;         // failures that need more, too
  bool is_last = false;           // only failures that no other home takes

  // `needed`: what it needs, without kinds of messages that are chance. If nearly all failures show a turn or a bend,
  // one in which both AGVs just drove on may belong to them: its AGV might have turned a little later.
  bool takes(const FailureNeeds& failure, const std::vector<std::string>& needed) const;
  // Whether it says the words that tell this one, or needs what was tried first of what this one needs: hardly any
  // failure needs that by chance.
  bool is_like(const FailureNeeds& failure) const;
};

// The first of the simplest that take it; of these, the one with what was tried first and is needed all the same.
// Null: none does.
const Home* home_of(const FailureNeeds& failure, const std::vector<std::string>& needed,
                    const std::vector<Home>& homes);

// Of a failure with needs that hardly another has: one that it is like. Null: there is none.
const Home* related_home(const FailureNeeds& failure, const std::vector<Home>& homes);

}  // namespace fleetproof
