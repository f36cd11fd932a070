#pragma once

#include <string>

namespace fleetproof {

// What could make this machine compute differently from another one, for session logs.
struct MachineFacts {
  std::string cpu;           // the model, as the kernel names it; empty: it does not
  std::string instructions;  // those that the C library chooses its functions by: "avx2 fma"
  std::string c_library;     // "glibc 2.36"
};

MachineFacts machine_facts();

}  // namespace fleetproof
