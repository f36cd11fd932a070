#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/foreign_calls.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// How a program comes in.
enum class ProgramKind : std::uint8_t { BuiltIn, Plugin, Lockstep };

// Where a program comes from: all that another process needs to open the same one.
struct ProgramSource {
  ProgramKind kind = ProgramKind::BuiltIn;
  std::string file, sha256;     // as a command line names it, and what it was; both empty: it is built in
  bool global_symbols = false;  // its shared object is loaded with RTLD_GLOBAL: embedded Python needs it
};

// A program in this process.
struct OpenedProgram {
  const fp_agent_type* type = nullptr;
  std::shared_ptr<ForeignHandles> handles{};  // null: its code is part of this program
  std::shared_ptr<const void> own{};          // the type and all that it needs end with this
  std::function<void()> renew{};              // the next run finds new processes; empty: it has none
};

// The source that a word of a campaign file or of a command line names: the path of a shared object, or
// "lockstep:COMMAND". Throws InputError, at the word, if there is no such file or if it is no command.
ProgramSource source_of(const std::string& word, bool global_symbols);
// The SHA-256 of what the source is now. Throws InputError if it cannot be read.
std::string identity_of(const ProgramSource& source);
// The door of every program that is not built in: this function alone tells the kinds apart. Code of the program may
// run in this process from now on. `word`: how errors name it. Throws InputError if it is no program for this version
// of fleetproof/agent.h, or has a name that is longer than 100 bytes or not plain UTF-8.
OpenedProgram open(const ProgramSource& source, const std::string& word);
// The same source with its file relative to `folder`; empty: as it is.
std::string word_of(const ProgramSource& source, const std::string& folder = "");
// The files that the source names: the shared object, or those of the command.
std::vector<std::string> files_of(const ProgramSource& source);
// The word of the same source with other names for these files, in the same order.
std::string word_with(const ProgramSource& source, std::span<const std::string> names);
// The same source for later: without the symbolic links of today.
std::string lasting_word_of(const ProgramSource& source);

}  // namespace fleetproof
