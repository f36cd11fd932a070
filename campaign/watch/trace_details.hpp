#pragma once

#include <string>
#include <string_view>

#include "campaign/watch/trace_context.hpp"

namespace fleetproof {

// What a record says besides its time, body and kind, in words. `text` as in TraceSink.
std::string trace_details(const TraceRecord& record, std::string_view text, const TraceContext& context);

// Seconds with nine digits, cut from the whole number of nanoseconds.
std::string nanosecond_text(SimTime t);

}  // namespace fleetproof
