#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/run/case_run.hpp"
#include "campaign/workers/case_text.hpp"
#include "campaign/workers/cause_of_death.hpp"
#include "core/engine/run_watch.hpp"

namespace fleetproof {

// What the main process asks of a worker: a run of the plan, or one scenario with the first agent of the plan.
struct RunOrder {
  std::uint64_t run_index = 0;
  std::vector<KnownEnd> known_ends;
  bool record = false;      // what the agents do, in case the run fails; of an audit and a scenario in any case
  CaseText scenario{};      // empty: the run of the plan
  bool deliveries = false;  // of a scenario: of its messages
  bool is_audit = false;    // of the run, which has been simulated before
  FailureChoice choice{};   // of a scenario: the failure that is looked at
  // Not sent. True: nobody waits for the answer any more. Null: somebody does in any case.
  const std::atomic<bool>* abandon = nullptr;
};
std::string encode(const RunOrder& order);
RunOrder decode_order(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

// What a worker answers; the first answer says that it has loaded its plug-ins. Failed: `message` says why no run can
// be simulated in a worker; `machine`: a file or the machine is the reason, not the engine.
struct RunAnswer {
  bool failed = false, machine = false;
  bool declined = false;  // this worker hosts no more runs; another one has to take the order
  bool is_piece = false;  // of a recording; the answer comes later, and has the last piece
  bool explained = true;  // not sent: false if no worker brought the run to its end, and nobody knows why
  // Not sent: how the run ended in a worker before, if that did not come again.
  std::optional<CauseOfDeath> ended_otherwise{};
  std::string message;
  std::uint64_t cpu_ns = 0;  // used by the worker process for this run
  std::uint64_t scenario_digest = 0;
  std::string recording;  // if the order asks for it; empty: there is none, or it is too long
  CaseRun run;            // of a run of the plan: the outcome alone
};
std::string encode(const RunAnswer& answer);
RunAnswer decode_answer(std::string_view bytes);  // throws EngineError on bytes that `encode` did not write

}  // namespace fleetproof
