#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/engine/run_context.hpp"
#include "core/outcome/probes.hpp"

namespace fleetproof {

// What agents declare. It moves nothing: it goes into the trace, and some of it is counted.
class Declarations {
 public:
  explicit Declarations(RunContext& run) : run_(run), slices_(run.agvs.size()) {}

  void set_safe_mode(AgvId agv, bool on);
  // Invalid: it waits for no AGV.
  void set_waiting_for(AgvId agv, AgvId other);
  // `kind`: Probe or Log.
  void note(AgvId agv, TraceKind kind, std::string_view text);
  // The AGV's computer goes down: its safe mode and its waiting are over.
  void forget(AgvId agv);

  // At the end of the run.
  void close_books();
  const ProbeTally& probes() const { return probes_; }

 private:
  struct Slice {
    std::optional<SimTime> safe_since;
    std::uint64_t safe_mode_ns = 0;
  };

  RunContext& run_;
  ProbeTally probes_;
  std::vector<Slice> slices_;  // by AGV
};

}  // namespace fleetproof
