#include "core/scenario/lenient.hpp"

#include <fmt/format.h>

#include <limits>

namespace fleetproof {

bool Lenient::names(double value, double usual) const {
  if (value == usual) return false;
  const auto amount = [&](double number) {
    return zero_is_endless_ && number == 0.0 ? std::numeric_limits<double>::infinity() : number;
  };
  const double bound = beyond_.value_or(amount(usual));
  switch (way_) {
    case Way::None:
      return false;
    case Way::Up:
      return amount(value) > bound;
    case Way::Down:
      return amount(value) < bound;
    case Way::Either:
      return true;
  }
  return false;
}

bool Lenient::names(std::string_view word, std::string_view usual) const {
  return way_ != Way::None && word != usual && words_.find(word) == words_.npos;
}

std::string Lenient::text() const {
  if (way_ == Way::None) return "no: " + std::string(words_);
  std::string text = "any but the default";
  if (way_ != Way::Either) text = fmt::format("{} {}", way_ == Way::Up ? "above" : "below", bound_text());
  if (zero_is_endless_) text += way_ == Way::Up ? ", and 0" : ", but 0";
  if (!words_.empty()) text += fmt::format(", {}", words_);
  return fmt::format("{} ({})", text, name_of(weight_));
}

std::string Lenient::bound_text() const { return beyond_ ? fmt::format("{:g}", *beyond_) : "the default"; }

}  // namespace fleetproof
