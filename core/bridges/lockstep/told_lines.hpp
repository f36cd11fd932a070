#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

// A call that was not asked and did not return FP_OK.
struct RefusedCall {
  std::size_t place = 0;  // among the calls of the line
  std::string name;
  std::int32_t result = FP_OK;
};

// Lines to a program. Each takes the place of what `line` holds.
void write_hello(std::string& line);
void write_run(const fp_briefing& briefing, std::string& line);
// An event, with all that it carries. The program knows the first `told_before` unread messages. `refused` is not
// empty: the event is those.
void write_event(const fp_briefing& briefing, const fp_event& event, const fp_perceived& seen,
                 std::uint32_t told_before, const std::vector<RefusedCall>& refused, std::string& line);
void write_destroy(std::uint32_t participant, std::string& line);
void write_bye(std::string& line);

}  // namespace fleetproof::lockstep
