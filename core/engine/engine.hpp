#pragma once

#include <memory>
#include <span>

#include "core/engine/parts.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// The event loop of one run: takes the next event from the queue, sets the clock, and hands the event to the part that
// its kind belongs to. A local variable of simulate(); thousands can live at once.
class Engine {
 public:
  Engine(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
         TraceSink* sink, const char* agent_config, const RunWatch& watch = {});

  // From the start to the horizon. Call it once. Throws RunAbandoned if the watch says so.
  void run();
  // Closes the books. Requires: `run` has returned. Call it once: the findings of the laws move into the outcome.
  Outcome finish();

 private:
  void start();
  void goes_on_until(SimTime at);
  void handle(const Event& event);
  bool is_stuck() const;
  void file_findings(Outcome& outcome) const;

  std::span<const std::unique_ptr<Law>> laws_;
  const std::atomic<bool>* abandon_;
  RunContext run_;
  Parts parts_;
};

}  // namespace fleetproof
