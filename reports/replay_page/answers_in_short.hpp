#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reports/replay_page/drive_answers.hpp"

namespace fleetproof::web {

// Whom an AGV had asked, and which of them had answered in time. An empty text: there is only one other AGV.
struct AnswersInShort {
  std::string text;
  bool owes = false;  // one that was asked had not
};
AnswersInShort answers_in_short(const Film& film, const Setting& setting, const std::vector<SenderAnswers>& others);

// "AGV 3, AGV 4 and 12 more".
std::string names_text(const Film& film, const std::vector<std::size_t>& bodies);

}  // namespace fleetproof::web
