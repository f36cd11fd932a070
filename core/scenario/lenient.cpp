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
  return way_ != Way::None && word != usual && word != harder_ && word != other_harder_;
}

std::string Lenient::text() const {
  const std::string bound = beyond_ ? fmt::format("{:g}", *beyond_) : "the default";
  switch (way_) {
    case Way::None:
      return "no: " + std::string(reason_);
    case Way::Up:
      return fmt::format("above {}{}", bound, zero_is_endless_ ? ", and 0" : "");
    case Way::Down:
      return fmt::format("below {}{}", bound, zero_is_endless_ ? ", but 0" : "");
    case Way::Either:
      return harder_.empty() ? "any but the default"
                             : fmt::format("any but the default, {} and {}", harder_, other_harder_);
  }
  return {};
}

}  // namespace fleetproof
