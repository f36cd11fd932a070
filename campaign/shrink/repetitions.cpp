#include "campaign/shrink/repetitions.hpp"

#include <fmt/format.h>

namespace fleetproof {
namespace {

constexpr std::size_t kFirst = 2, kAll = 10;

}  // namespace

std::string Repetitions::text() const {
  std::string others;
  for (const auto& [how, times] : otherwise) others += fmt::format("{}{}: {}", others.empty() ? "" : "; ", times, how);
  return fmt::format("{} of {} repetitions in fresh processes failed so{}", alike, of,
                     others.empty() ? "" : " (" + others + ")");
}

Repetitions repeated(const CaseHost& host, const Scenario& scenario, const std::function<bool(const CaseRun&)>& is_it) {
  Repetitions found;
  while (found.of < kFirst || (!found.always_alike() && found.of < kAll)) {
    if (found.of >= kFirst && host.is_over()) break;
    const CaseRun run = host.in_fresh_process(scenario, found.of);
    ++found.of;
    if (is_it(run)) {
      ++found.alike;
    } else {
      const auto failure = failure_of(run);
      ++found.otherwise[failure ? failure->kind.what : "no failure"];
    }
  }
  return found;
}

}  // namespace fleetproof
