#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/bridges/lockstep/process.hpp"
#include "core/bridges/lockstep/program_calls.hpp"
#include "core/bridges/lockstep/told_lines.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

// What a program says about itself when it starts.
struct Introduction {
  std::string name, description;
  bool is_deterministic = false, serves_agvs = true, serves_computers = true;
  bool takes_many_runs = true;  // one after the other
  std::vector<std::string> faults;

  friend bool operator==(const Introduction&, const Introduction&) = default;
};

// A participant behind the bridge.
struct Participant {
  Controller controller;
  const fp_briefing* briefing = nullptr;
  std::uint32_t unread = 0;  // messages of which the program was told, and which it has not read
};

// A process that speaks lockstep. If it breaks the protocol, it is ended, and all that it hosts fails in the same words
// until the run ends.
class HostedProcess {
 public:
  // Starts it and lets it introduce itself. Throws Broken.
  explicit HostedProcess(std::vector<std::string> words);

  const Introduction& introduction() const { return introduction_; }
  bool is_in_run() const { return is_in_run_; }
  // Not empty: it is gone, for this reason.
  const std::string& trouble() const { return trouble_; }

  // The first participant of a run tells what is the same for all.
  void begin_run(const fp_briefing& briefing);
  // One activation: the program gets the event and answers until it is done.
  void tell(Participant& participant, const fp_event& event);
  void tell_end_of(std::uint32_t participant);
  // Whether it may serve another run.
  bool end_run();

 private:
  template <class Exchange>
  void guarded(Exchange exchange);
  void exchange(Participant& participant, const fp_event& event);
  bool take_answer(Participant& participant, std::vector<RefusedCall>& refused);
  void make_calls(Participant& participant, const Json& calls, std::vector<RefusedCall>& refused);
  CallResult make_call_of(Participant& participant, const Json& call);

  std::unique_ptr<Process> process_;
  Introduction introduction_;
  bool is_in_run_ = false;
  std::string trouble_, line_;
};

}  // namespace fleetproof::lockstep
