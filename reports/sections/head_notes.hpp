#pragma once

#include <vector>

#include "reports/page/page.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof {

// Sentences of the head that belong to no gate.

// What stands there beside the verdict, and says how much the runs prove: what is held, exempt, waived or weak, audits,
// the ledger and the sessions. A comparison with this campaign tells it, too.
std::vector<Headline> head_beside_verdict(const ReportInput& input);

// The agents under test that stalled within the contract region: deadlock, livelock or starvation that no contact and
// no foreign body explains.
std::vector<Remark> stall_notes(const ReportInput& input);

// Crashes and hangs of the agents under test in the contract region, if no gate over the whole region judges them.
std::vector<Remark> crash_notes(const ReportInput& input);

// The agents under test whose AGVs met in less than half of the runs, or in no way but one behind the other: there,
// most of what control software has to settle does not come up.
std::vector<Remark> meeting_notes(const ReportInput& input);

// The agents under test whose AGVs sent no message in many of the runs with two or more of them.
std::vector<Remark> silence_notes(const ReportInput& input);

// How many runs of each plug-in under test may come out otherwise if they are simulated once more, by audits of which
// none did.
std::vector<Remark> repeat_notes(const ReportInput& input);

// That nothing casts doubt on the simulator: errors of its own, and audits. Empty if something does: then a headline
// says so.
std::vector<Remark> soundness_notes(const ReportInput& input);

// What no plug-in can be cleared of, for each agent under test that is one: forgery, and doing otherwise in simulation
// than on a vehicle.
std::vector<Remark> foreign_code_notes(const ReportInput& input);

// Which planted faults these worlds detect, that it was not measured, or why what was measured tells nothing.
std::vector<Remark> sensitivity_notes(const ReportInput& input);

}  // namespace fleetproof
