#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/simulation.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fleetproof/agent.h"

// Small worlds and agents that tests and benchmarks share.
namespace fleetproof::test {

// Stations in a row along x, `gap_m` apart, joined by bidirectional segments.
inline std::shared_ptr<const LogicalMap> row_map(int stations, double gap_m = 4.0) {
  Layout layout;
  layout.name = "row";
  for (int i = 0; i < stations; ++i) {
    layout.stations.push_back(
        {"s" + std::to_string(i), Vec2{gap_m * i, 0.0}, Purposes(Purpose::Routing) | Purpose::Storage});
  }
  for (int i = 0; i + 1 < stations; ++i) {
    layout.segments.push_back({"e" + std::to_string(i),
                               StationId{static_cast<std::uint32_t>(i)},
                               StationId{static_cast<std::uint32_t>(i + 1)},
                               true,
                               {}});
  }
  return std::make_shared<const LogicalMap>(layout);
}

inline Scenario row_scenario(int stations, std::vector<std::uint32_t> starts, double horizon_s = 60.0) {
  Scenario scenario;
  scenario.name = "row";
  scenario.map = row_map(stations);
  scenario.horizon = seconds(horizon_s);
  scenario.seed = 1;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    AgvSetup agv;
    agv.name = "agv-" + std::to_string(i + 1);
    agv.start = StationId{starts[i]};
    scenario.agvs.push_back(agv);
  }
  return scenario;
}

// What a test agent does at an event; it lives in the test, which must outlive the run. One instance per participant
// shares the handler.
using Handler = std::function<void(const fp_host&, fp_controller*, const fp_briefing&, const fp_event&)>;

// Hands every event to the handler that `current_handler` names while the run lasts. Tests run their simulations on one
// thread.
inline thread_local const Handler* current_handler = nullptr;

struct HandlerAgent {
  const fp_host* host;
  fp_controller* controller;
  const fp_briefing* briefing;
};

inline const fp_agent_type& handler_agent() {
  static const fp_agent_type type = {
      sizeof(fp_agent_type),
      FP_ABI_MAJOR,
      FP_ABI_MINOR,
      FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
      "handler",
      "does what the test says",
      [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
        return new HandlerAgent{host, controller, briefing};
      },
      [](void* agent, const fp_event* event) {
        const auto* self = static_cast<HandlerAgent*>(agent);
        (*current_handler)(*self->host, self->controller, *self->briefing, *event);
      },
      [](void* agent) { delete static_cast<HandlerAgent*>(agent); },
      [](const char* word) -> uint32_t { return std::string_view(word).starts_with("known") ? 1 : 0; },
      nullptr};
  return type;
}

// It serves every participant.
inline FleetSoftware handler_software(const Scenario& scenario) {
  return {{&handler_agent()}, std::vector<RoleSoftware>(scenario.computers.size(), RoleSoftware{&handler_agent()})};
}

inline Outcome simulate_with(const Scenario& scenario, const Handler& handler, TraceSink* sink = nullptr) {
  current_handler = &handler;
  Outcome outcome = simulate(scenario, handler_software(scenario), {}, sink);
  current_handler = nullptr;
  return outcome;
}

// Keeps every record.
class Recorder final : public TraceSink {
 public:
  void record(const TraceRecord& record, std::string_view) override { records.push_back(record); }
  std::vector<TraceRecord> of(TraceKind kind) const {
    std::vector<TraceRecord> found;
    for (const TraceRecord& r : records) {
      if (r.kind == kind) found.push_back(r);
    }
    return found;
  }
  std::vector<TraceRecord> records;
};

}  // namespace fleetproof::test
