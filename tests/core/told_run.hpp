#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/engine/call_tape.hpp"
#include "core/engine/simulation.hpp"
#include "tests/support/worlds.hpp"

// Runs that are recorded, and runs that are played from their recordings.
namespace fleetproof::test {

// Everything that a run tells.
struct ToldRun {
  using Line =
      std::tuple<SimTime, EntityId, TraceKind, std::uint64_t, std::uint64_t, std::uint32_t, std::uint32_t, std::string>;
  Outcome outcome;
  std::vector<Line> trace;
  std::string tape;  // if it was recorded
};

inline void expect_same(const ToldRun& one, const ToldRun& other) {
  EXPECT_EQ(one.outcome, other.outcome) << one.outcome.message << " / " << other.outcome.message;
  EXPECT_TRUE(one.trace == other.trace);
}

class Listener final : public TraceSink {
 public:
  explicit Listener(std::vector<ToldRun::Line>& lines) : lines_(lines) {}
  void record(const TraceRecord& r, std::string_view text) override {
    lines_.emplace_back(r.at, r.entity, r.kind, r.a, r.b, r.bytes, r.more, text);
  }

 private:
  std::vector<ToldRun::Line>& lines_;
};

using Laws = std::vector<std::unique_ptr<Law>>;

inline ToldRun watched(const Scenario& scenario, const fp_agent_type& agent, const RunWatch& watch,
                       const Laws& laws = {}) {
  ToldRun told;
  Listener listener(told.trace);
  told.outcome = simulate(scenario, agent, laws, &listener, "", watch);
  return told;
}

inline ToldRun recorded(const Scenario& scenario, const fp_agent_type& agent, const Laws& laws = {},
                        std::span<const KnownEnd> known_ends = {}) {
  CallTape tape;
  RunWatch watch;
  watch.record = &tape;
  watch.known_ends = known_ends;
  ToldRun told = watched(scenario, agent, watch, laws);
  EXPECT_TRUE(tape.is_complete());
  told.tape = tape.take();
  return told;
}

// An agent type none of whose functions may be called.
inline const fp_agent_type& untouchable_agent() {
  static const fp_agent_type type = {sizeof(fp_agent_type),
                                     FP_ABI_MAJOR,
                                     FP_ABI_MINOR,
                                     0,
                                     "untouchable",
                                     "fails the test if it is called",
                                     [](const fp_host*, fp_controller*, const fp_briefing*) -> void* {
                                       ADD_FAILURE() << "create() was called";
                                       return nullptr;
                                     },
                                     [](void*, const fp_event*) { ADD_FAILURE() << "on_event() was called"; },
                                     [](void*) { ADD_FAILURE() << "destroy() was called"; },
                                     [](const char*) -> uint32_t {
                                       ADD_FAILURE() << "knows_fault() was called";
                                       return 0;
                                     },
                                     nullptr};
  return type;
}

inline ToldRun played(const Scenario& scenario, std::string_view tape, const Laws& laws = {}) {
  RunWatch watch;
  watch.play = tape;
  return watched(scenario, untouchable_agent(), watch, laws);
}

}  // namespace fleetproof::test
