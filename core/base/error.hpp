// The errors of the program: who or what is at fault decides which one is thrown.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace fleetproof {

// Input that a person has to mend. `where` is a file with line and column, or a word of the command line; `what` names
// the field, the value and the remedy. Both may quote text from outside: the message is one printable line
// (outside_text.hpp). If it is longer than 1500 bytes, its middle is left out.
class InputError : public std::runtime_error {
 public:
  InputError(std::string_view where, std::string_view what);
};

// Damage or failure that no user caused by the words of the call: a broken archive, a full disk.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Our own bug. On in every build; a run that meets one is filed as `engine_error`.
class InvariantViolation : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void invariant_violated(const char* sentence);

inline void ensure(bool holds, const char* sentence) {
  if (!holds) [[unlikely]]
    invariant_violated(sentence);
}

// The machine failed: a full or failing disk, no memory or process to be had, a helper process that somebody killed.
// It is no fault of the engine, and nothing is damaged. `what` ends with the remedy.
class MachineError : public EngineError {
 public:
  using EngineError::EngineError;
};

}  // namespace fleetproof
