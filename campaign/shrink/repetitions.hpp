#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "campaign/shrink/case_host.hpp"

namespace fleetproof {

// What becomes of one scenario when it is simulated again and again, each time in a process that has hosted nothing
// before. Software that takes something from its process does not always do the same; to change its scenario and to
// look whether it still fails tells nothing then.
struct Repetitions {
  std::size_t of = 0, alike = 0;
  std::map<std::string, std::size_t>
      otherwise{};  // how often it ended in another way: "deadlock, two AGVs", "no failure"

  bool always_alike() const { return alike == of; }
  // "3 of 10 repetitions in fresh processes failed so (5: deadlock, two AGVs; 2: no failure)"
  std::string text() const;
};

// Two repetitions, and ten if not both are as `is_it` says; fewer than ten if the time of the host is over.
Repetitions repeated(const CaseHost& host, const Scenario& scenario, const std::function<bool(const CaseRun&)>& is_it);

}  // namespace fleetproof
