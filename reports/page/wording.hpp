#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/outside_text.hpp"
#include "core/base/sim_time.hpp"
#include "reports/evidence/tally.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Figures as text on a page: hundredths of a second, whole centimetres (rounded down, towards the unsafe side), percent
// with a blank before the sign.
std::string percent(double fraction);
std::string seconds_text(double value_s);
std::string instant_text(SimTime t);  // "12.345 s", as every page shows it (core/base/shown_time.hpp)
// A value of a factor: "40 %". Between two bounds: "0 .. 40 %".
std::string factor_text(const FactorInfo& factor, double value);
std::string factor_span(const FactorInfo& factor, double from, double to);
// "loss 40 %, delay 2 s, outages of 0.5 s". Factors that are only named above 0 stand at the end, or not at all.
std::string factors_text(const FactorValues& factors);
// "layout ring, fleet of 5, loss 40 %, delay 2 s": what is given, or nothing.
std::string filter_text(const CellFilter& filter);
// The values of the same factors between bounds, with the words of the last ones only: "0 .. 40 %, 2 s".
std::string factor_spans(const FactorValues& lowest, const FactorValues& highest, std::string_view separator = ", ");
// A distance that a plan states: hundredths of a metre, or all its digits if it has more.
std::string distance_text(double value_m);
std::string metres_text(std::int64_t value_um);
// "> 0.5 m" if no measured clearance was below 0.5 m, "-" if none was measured.
std::string clearance_text(const Tally& tally);
inline constexpr std::int64_t kSlack_um = 1;  // of clearances that are not violations: kBuiltToTheLimit_m
std::string per_hour_text(const std::optional<double>& rate);
std::string count_text(std::uint64_t count, std::string_view singular);  // "1 run", "3 runs"
// "3", or "3 +5?" with five more that stayed unknown: what is not known is never called a failure.
std::string failed_text(std::uint64_t failing, std::uint64_t failing_or_unknown);
// What pages mean by an unknown outcome.
inline constexpr std::string_view kUnknownMeans =
    "Unknown (+N?): the run cannot tell whether the software would have failed. The software crashed or hung, the run "
    "was "
    "indeterminate, AGVs stood behind a wreck, or they met nothing but fallen loads and obstacles. Every rate and "
    "bound "
    "counts it as failing.";
std::string hex_text(std::uint64_t digest);  // 16 digits
// "AGV 3", "fallen load or obstacle 0", or the name of a computer. `computers`: of the agent of the cell, as
// Evidence::computers_of has them.
std::string body_name(EntityId body, const CellRecord& cell, const std::vector<std::string>& computers);

// The command that replays a run, as a person copies it into a shell.
std::string replay_command(const std::string& archive_path, std::uint64_t run_index);
// The same in a debugger, for an agent that crashed.
std::string debug_command(const std::string& archive_path, std::uint64_t run_index);

std::string joined(const std::vector<std::string>& parts, std::string_view separator = ", ");

}  // namespace fleetproof
