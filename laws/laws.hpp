#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/outcome/law.hpp"

namespace fleetproof {

// Every law there is: first the default set, beginning with the judge of violations; then those to compare with.
std::span<const Entry<MakeLaw>> laws();
std::span<const Entry<MakeLaw>> default_laws();

// The published rules: judges like the first of the default set, and no part of it.
bool is_to_compare_with(const Entry<MakeLaw>& law);

// By name; `exact` is the other name of `safety-distance`. Null if there is none.
const Entry<MakeLaw>* find_law(std::string_view name);

// The default set for one run, the judge first, without those named.
std::vector<std::unique_ptr<Law>> make_default_laws(const Scenario& scenario,
                                                    std::span<const std::string> left_out = {});

}  // namespace fleetproof
