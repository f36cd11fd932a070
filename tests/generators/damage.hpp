#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/random.hpp"

// What every importer has to bear: cut and damaged files are read or refused with an InputError; nothing else comes out of it.
namespace fleetproof::independent {

// The message with which `parse` refuses the text, or "accepted".
template <class Parse>
std::string refusal(Parse parse, const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

template <class Parse>
void bear_cuts(Parse parse, const std::string& text, std::size_t cuts) {
  for (std::size_t i = 0; i < cuts; ++i) EXPECT_NO_THROW(refusal(parse, text.substr(0, text.size() * i / cuts))) << "cut " << i;
}

template <class Parse>
void bear_damage(Parse parse, const std::string& original, int rounds, std::string_view spice) {
  Draws draws(7);
  for (int round = 0; round < rounds; ++round) {
    auto text = original;
    for (std::uint32_t k = 1 + draws.below(4); k > 0; --k) {
      const auto at = draws.below(static_cast<std::uint32_t>(text.size()));
      const char c = spice[draws.below(static_cast<std::uint32_t>(spice.size()))];
      switch (draws.below(4)) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        case 2:
          text[at] = static_cast<char>(text[at] ^ (1 << draws.below(8)));
          break;
        default:
          text.erase(at, 1 + draws.below(40));
          break;
      }
    }
    EXPECT_NO_THROW(refusal(parse, text)) << "round " << round;
  }
}

}  // namespace fleetproof::independent
