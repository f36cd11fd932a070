#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/run/case_notes.hpp"
#include "campaign/run/itinerary.hpp"
#include "campaign/run/message_fates.hpp"
#include "campaign/workers/case_text.hpp"
#include "core/engine/run_watch.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// What the main process asks of a worker: a run of the plan, or one scenario with the first agent of the plan.
struct RunOrder {
  std::uint64_t run_index = 0;
  std::vector<KnownEnd> known_ends;
  bool record = false;  // what the agents do, in case the run fails
  CaseText scenario{};  // empty: the run of the plan
  bool fates = false;   // of a scenario: of its messages
};
std::string encode(const RunOrder& order);
RunOrder decode_order(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

// What a worker answers. Failed: `message` says why no run can be simulated in a worker.
struct RunAnswer {
  bool failed = false;
  bool explained = true;  // not sent: false if no worker brought the run to its end, and nobody knows why
  std::string message;
  std::uint64_t cpu_ns = 0;  // used by the worker process for this run
  std::uint64_t scenario_digest = 0;
  Outcome outcome;
  std::string recording;  // of a failed run, if the order asks for it; empty: there is none, or it is too long
  std::vector<std::string> states, doing, words, all_words;  // of a scenario: see CaseRun
  std::vector<Declared> first_said;                          // likewise
  CaseNotes notes;                                           // likewise
  std::vector<MessageFate> fates;                            // likewise
  Itinerary itinerary;                                       // likewise
};
std::string encode(const RunAnswer& answer);
RunAnswer decode_answer(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

}  // namespace fleetproof
