// One maker for each kind of fault.
#pragma once

#include <memory>

#include "core/bridges/wrapped/fault_words.hpp"
#include "core/bridges/wrapped/wrapped_agent.hpp"

namespace fleetproof::wrapped {

using AgentMaker = std::unique_ptr<WrappedAgent> (*)(const Fault& fault, const Surroundings& around);

// It hears one message of each `every` not at all, or twice. It counts what it has heard since its computer started.
std::unique_ptr<WrappedAgent> make_dropping(const Fault& fault, const Surroundings& around);
std::unique_ptr<WrappedAgent> make_repeating(const Fault& fault, const Surroundings& around);
// In each period it hears no event for `length_ns`, and then all that came meanwhile, in order. Events that say the
// same (the inbox is not empty; this timer went off) are heard once. Periods begin at another instant for each
// participant.
std::unique_ptr<WrappedAgent> make_stalling(const Fault& fault, const Surroundings& around);
// Once in each period it begins again, as after a restart, but for the number of its boot. The disk stays; timers and
// what was not read are gone. Actions under way go on.
std::unique_ptr<WrappedAgent> make_forgetting(const Fault& fault, const Surroundings& around);
// It perceives a position that is `length_ns` old; in the beginning that of the beginning.
std::unique_ptr<WrappedAgent> make_old_position(const Fault& fault, const Surroundings& around);
// Its clock is ahead by a draw of less than `length_ns`.
std::unique_ptr<WrappedAgent> make_clock_off(const Fault& fault, const Surroundings& around);

}  // namespace fleetproof::wrapped
