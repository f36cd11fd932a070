#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/words.hpp"

namespace fleetproof {

// What an easier value of a field touches, the heaviest last.
enum class Weight : std::uint8_t {
  Load,       // what the software has to cope with
  Plant,      // vehicles that no plant has
  Judgement,  // what counts as a failure, and how it is looked for
};
constexpr const char* name_of(Weight weight) {
  switch (weight) {
    case Weight::Load:
      return "load";
    case Weight::Plant:
      return "plant";
    case Weight::Judgement:
      return "judgement";
  }
  return kNoWord;
}

// Which values of a field make it easier to pass. A report on a campaign that has one of them names it at its head.
// There is no default: every field of a campaign says it, or why no value of it is easier.
class Lenient {
 public:
  enum class Way : std::uint8_t { None, Up, Down, Either };

  // Values above `beyond` are named; without it, those above the usual value, which a plan has that does not give it.
  // What describes a plant is named beyond a bound that no real plant has. The usual value itself is never named.
  static constexpr Lenient up(Weight weight, std::optional<double> beyond = {}) { return {Way::Up, weight, beyond}; }
  static constexpr Lenient down(Weight weight, std::optional<double> beyond = {}) {
    return {Way::Down, weight, beyond};
  }
  // Every other value than the usual one.
  static constexpr Lenient either(Weight weight) { return {Way::Either, weight, {}}; }
  static constexpr Lenient none(std::string_view reason) {
    Lenient none{Way::None, Weight::Load, {}};
    none.words_ = reason;
    return none;
  }
  // 0 stands for more than any number.
  constexpr Lenient zero_is_endless() const {
    Lenient changed = *this;
    changed.zero_is_endless_ = true;
    return changed;
  }
  // Words that are harder than the usual one, with spaces between them.
  constexpr Lenient but_not(std::string_view harder) const {
    Lenient changed = *this;
    changed.words_ = harder;
    return changed;
  }

  constexpr Way way() const { return way_; }
  constexpr Weight weight() const { return weight_; }

  // Beyond it a number is named.
  constexpr double bound(double usual) const { return beyond_.value_or(usual); }
  bool names(double value, double usual) const;
  bool names(std::string_view word, std::string_view usual) const;
  // "above 120 (judgement)", "below the default (load)", "any but the default (load)"; of none, the reason.
  std::string text() const;

 private:
  std::string bound_text() const;
  constexpr Lenient(Way way, Weight weight, std::optional<double> beyond)
      : way_(way), weight_(weight), beyond_(beyond) {}

  Way way_;
  Weight weight_;
  std::optional<double> beyond_;
  bool zero_is_endless_ = false;
  std::string_view words_;  // that are harder; of none, the reason
};

inline constexpr Lenient kIsName = Lenient::none("a name");
inline constexpr Lenient kIsTable = Lenient::none("its fields say it");
inline constexpr Lenient kOfScenarios = Lenient::none("no campaign has it");
inline constexpr Lenient kSampled = Lenient::none("what was sampled stands in the verdict");
inline constexpr Lenient kToldOfGate = Lenient::none("it stands in the table of gates");
inline constexpr Lenient kToldAtHead = Lenient::none("a sentence of its own stands at the head");
// Of what a file says in other places than fields.
inline constexpr Lenient kDecidesNothing = Lenient::none("it decides no outcome");

}  // namespace fleetproof
