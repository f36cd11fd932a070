#pragma once

#include <string_view>

#include "campaign/workers/shared_slots.hpp"

namespace fleetproof {

// The line before a stack trace.
inline constexpr std::string_view kStackTitle = "fleetproof: this process ends with a signal; its stack:\n";

// From now on a signal that ends this process leaves a stack trace on standard error first, and a note in the slot if
// the stack overflowed. Call this once, on the thread that will call the agents. Agents may set handlers of their own.
void note_fatal_signals(WorkerSlot& slot);

}  // namespace fleetproof
