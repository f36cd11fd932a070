#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/explain/explanation.hpp"

namespace fleetproof {

// A sentence of an explanation, and where one looks to see that it holds.
struct Sentence {
  std::string text;
  std::optional<SimTime> at;          // the instant that it is about
  bool is_of_run = false;             // an instant of the run itself; otherwise of its smallest case
  std::vector<std::size_t> claims{};  // the runs that show it, as claims_of counts them, from 1 on
  std::size_t share = 0;              // the share that shows it, from 1 on; 0: none does
  // How directly it names what decided the failure, in a run that avoids it: the first of the largest ones leads a
  // page. 0: it names nothing of the kind.
  int decides = 0;
  std::string lead{};  // the same for a reader who has not read the others; empty: `text` does
};
// "It fails in the same way without AGV 3 [2].": with the numbers of the runs that show it.
std::string text_of(const Sentence& sentence);

// The explanation in words, in the order of claims_of.
std::vector<Sentence> told(const Explanation& explanation);
// The same as texts.
std::vector<std::string> sentences_of(const Explanation& explanation);

// The sentence that names what decided the failure; null: no run that was tried tells.
const Sentence* leading(const std::vector<Sentence>& sentences);

}  // namespace fleetproof
