#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/run_watch.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// What the main process asks of a worker.
struct RunOrder {
  std::uint64_t run_index = 0;
  std::vector<KnownEnd> known_ends;
  bool record = false;  // what the agents do, in case the run fails
};
std::string encode(const RunOrder& order);
RunOrder decode_order(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

// What a worker answers. Failed: `message` says why no run can be simulated in a worker.
struct RunAnswer {
  bool failed = false;
  std::string message;
  std::uint64_t cpu_ns = 0;  // used by the worker process for this run
  std::uint64_t scenario_digest = 0;
  Outcome outcome;
  std::string recording;  // of a failed run, if the order asks for it; empty: there is none, or it is too long
};
std::string encode(const RunAnswer& answer);
RunAnswer decode_answer(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

}  // namespace fleetproof
