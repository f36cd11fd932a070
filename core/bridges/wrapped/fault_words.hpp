// The words for faults that are put around a program: "drop every 5th message". They are read here and nowhere else.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof::wrapped {

enum class FaultKind : std::uint8_t { Drop, Repeat, Stall, Forget, OldPosition, ClockOff };

// A fault around a program. Numbers that its kind does not have are 0.
struct Fault {
  FaultKind kind = FaultKind::Drop;
  std::uint32_t every = 0;     // message heard
  std::int64_t length_ns = 0;  // of a stall; how old a position is; how far a clock is off at most
  std::int64_t period_ns = 0;

  friend bool operator==(const Fault&, const Fault&) = default;
};

// Throws std::invalid_argument, which says what is wrong and how to write it, for other words than those of the table.
Fault parse_fault(std::string_view words);
// The one way to write the fault: "stall 3 s every 200 s".
std::string text_of(const Fault& fault);
// What the fault does, for people.
std::string description_of(const Fault& fault);
// One of each kind, with numbers that most software should live with: what a campaign is tried with if nobody says
// more.
std::vector<Fault> usual_faults();

// Between a program and the fault around it, and between two faults, of which the second is outside.
inline constexpr std::string_view kWith = " with ";

// A word that names a program, in two: "my.so" and " with clock 5 s off", with the faults as text_of() writes them.
struct WrappedWord {
  std::string bare, with;  // with: empty, or it begins with kWith
};

// Only what stands at the end and reads as faults is taken off: other words stay part of `bare`.
WrappedWord split_word(std::string_view word);
// The same. Throws what parse_fault() throws if what is left ends in kWith and the first word of a fault, so that a
// slip in its numbers is not taken for a part of a file name or a command.
WrappedWord split_checked(std::string_view word);
// "A with B" in the one way to write it, with kWith before it. Throws what parse_fault() throws.
std::string with_text(std::string_view faults);
// The name of the program inside all faults.
std::string bare_name(std::string_view name);

}  // namespace fleetproof::wrapped
