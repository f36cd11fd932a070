#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// Something of a scenario that a failure may need: a kind of loss or delay on the radio, of fault, of body.
struct Ingredient {
  std::string name;  // "lost messages", "restart", "GRANT messages": these are lost or late, too
  std::function<void(Scenario&)> take_out;
};

// All that the scenario has of it, in the order in which it is taken out: what a failure seldom needs comes first, so
// that a failure which can come about in several ways is known by the same one each time.
// `kinds`: of messages that may be lost, late or copied; a sender that does not describe its messages has none.
std::vector<Ingredient> ingredients_of(const Scenario& scenario, std::span<const std::string> kinds);

inline constexpr const char *kLateMessages = "late messages", *kLostMessages = "lost messages",
                            *kCopiedMessages = "doubled messages";

// Whether `needs` names all that `some` does.
bool names_all(const std::vector<std::string>& needs, const std::vector<std::string>& some);

// Of needs: those that name no kind of message.
std::vector<std::string> without_kinds(std::vector<std::string> needs);

}  // namespace fleetproof
