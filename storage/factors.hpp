#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/contract.hpp"

namespace fleetproof {

// The numeric factors of a campaign: what varies between cells beside agent, layout and fleet size. None of them shapes
// the world. This list drives the cells of a plan, the columns of a results file and the texts of reports. The bounds
// and the explanation of a factor are those of the scenario's field with the same key.
enum class Factor : std::uint8_t { Loss, Delay, MeanOutage, CallCost };

struct FactorInfo {
  Factor id;
  std::string_view key, key_to;  // of the value or lower bound, and of the upper bound: in files, columns and JSON
  std::uint32_t nesting;         // cells vary the factor with the highest number fastest
  // How a page shows it: "mean outage" in a sentence, "outage" at the head of a column, "outages of 0.5 s" in a list.
  std::string_view name, head, phrase;
  double scale;  // a page shows value * scale
  std::string_view sign;
  // A page names the factor only if it is above 0 somewhere. The table then says "none" for 0 and explains the column.
  bool only_above_zero;
  std::string_view legend;
  // Results files of an earlier schema have no column of this factor. Then every run had one value, which the plan
  // holds under this path. 0 if the plan does not hold it either.
  std::int32_t first_schema = 0;
  std::string_view plan_path = {};
};

// A new factor stands at the end: the place in the list is the dimension that it draws from, and the place of its
// column.
inline constexpr auto kFactors = std::to_array<FactorInfo>({
    {Factor::Loss, "loss", "loss_to", 0, "loss", "loss", "loss", 100.0, " %", false, ""},
    {Factor::Delay, "delay_s", "delay_to_s", 2, "delay", "delay", "delay", 1.0, " s", false, ""},
    {Factor::MeanOutage, "mean_outage_s", "mean_outage_to_s", 1, "mean outage", "outage", "outages of", 1.0, " s", true,
     "outage = mean length of an outage of the radio; none = losses are independent of each other. The loss is the "
     "same on average."},
    {Factor::CallCost, "call_cost_s", "call_cost_to_s", 3, "call cost", "call cost", "call cost", 1000.0, " ms", true,
     "call cost = simulated time that every call of the controller takes; none = calls take no time.", 5,
     "$.agent_clock.call_cost_s"},
});

consteval bool factors_stand_at_their_numbers() {
  std::array<bool, kFactors.size()> taken{};
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    if (kFactors[i].id != static_cast<Factor>(i)) return false;
    if (taken.at(kFactors[i].nesting)) return false;
    if (i > 0 && kFactors[i].first_schema < kFactors[i - 1].first_schema) return false;
    taken[kFactors[i].nesting] = true;
  }
  return true;
}
static_assert(factors_stand_at_their_numbers(),
              "a factor stands at its own number, each nesting occurs once, newer factors stand last");

constexpr const FactorInfo& info_of(Factor factor) { return kFactors.at(static_cast<std::size_t>(factor)); }

// The factor with this key.
constexpr std::optional<Factor> factor_of(std::string_view key) {
  for (const FactorInfo& factor : kFactors) {
    if (factor.key == key) return factor.id;
  }
  return std::nullopt;
}

// One value for each factor.
template <class Value>
struct PerFactor {
  std::array<Value, kFactors.size()> values{};

  constexpr Value& operator[](Factor factor) { return values.at(static_cast<std::size_t>(factor)); }
  constexpr const Value& operator[](Factor factor) const { return values.at(static_cast<std::size_t>(factor)); }
};

// The factors of one run, or one corner of a cell.
struct FactorValues : PerFactor<double> {
  // The region in which safe *and normal* operation is required (Sect. 2.4), and its corner.
  bool in_contract() const { return fleetproof::in_contract((*this)[Factor::Loss], (*this)[Factor::Delay]); }
  bool is_worst_case() const { return is_worst_case_of_contract((*this)[Factor::Loss], (*this)[Factor::Delay]); }
  friend bool operator==(const FactorValues& a, const FactorValues& b) { return a.values == b.values; }
  friend auto operator<=>(const FactorValues& a, const FactorValues& b) { return a.values <=> b.values; }
};

}  // namespace fleetproof
