#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/scenario/scenario_fields.hpp"
#include "storage/factors.hpp"

namespace fleetproof {

// The fields that a factor can set: those of the setups that a plan and a scenario both have. Owner: one of the two.
template <class Owner, class Visit>
void visit_factor_fields(Owner& owner, Visit&& visit) {
  const auto one = [&](const Field& field, auto&& value) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) {
      if (const auto factor = factor_of(field.key)) visit(*factor, field, value);
    }
  };
  visit_fields(owner.radio, one);
  visit_fields(owner.agent_clock, one);
  visit_fields(owner.scanner, one);
  visit_fields(owner.operator_help, one);
}

// The field behind a factor: its bounds and its explanation, as a field of [factors].
inline Field factor_field(Factor factor) {
  std::optional<Field> found;
  const Scenario scenario;
  visit_factor_fields(scenario, [&](Factor other, const Field& field, double) {
    if (other == factor) found = field;
  });
  ensure(found.has_value(), "a factor is a field of the scenario");
  found->home = FieldHome::Both;
  return *found;
}

template <class Owner>
double factor_value(const Owner& owner, Factor factor) {
  double found = 0.0;
  visit_factor_fields(owner, [&](Factor other, const Field&, double value) {
    if (other == factor) found = value;
  });
  return found;
}

inline void set_factors(Scenario& scenario, const FactorValues& factors) {
  visit_factor_fields(scenario, [&](Factor factor, const Field&, double& value) { value = factors[factor]; });
}

}  // namespace fleetproof
