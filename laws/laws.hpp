#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof {

// All laws, and the default set of a campaign. Both begin with the judge of violations.
std::span<const Entry<MakeLaw>> laws();
std::span<const Entry<MakeLaw>> default_laws();
const Entry<MakeLaw>& judge_of_violations();

// Whether this is a published law. Published laws are judges, but are not in the default set.
bool is_to_compare_with(const Entry<MakeLaw>& law);

// The law with this name; null if there is none. `exact` is another name of `safety-distance`.
const Entry<MakeLaw>* find_law(std::string_view name);

// Empty if a campaign may leave this law out; else why not.
std::string why_not_left_out(std::string_view name);

// The default set for one run, without the laws in `left_out`. The judge comes first.
std::vector<std::unique_ptr<Law>> make_default_laws(const Scenario& scenario,
                                                    std::span<const std::string> left_out = {});

}  // namespace fleetproof
