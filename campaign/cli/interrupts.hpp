#pragma once

#include <atomic>

namespace fleetproof::cli {

// From now on, the first SIGINT, SIGTERM or SIGHUP asks the verb to finish what is under way and to keep it. A second
// one ends the program at once.
void listen_to_interrupts();

// The number of the signal that came first; 0: none.
const std::atomic<int>& interrupted();

}  // namespace fleetproof::cli
