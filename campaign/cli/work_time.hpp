#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "campaign/batch/time_limit.hpp"

namespace fleetproof::cli {

// How long a verb may take (--max-time), from the moment at which this is made. The bound holds for all that the verb
// does: what was found until then is printed.
class WorkTime {
 public:
  // Empty: it may take any time. Throws InputError.
  explicit WorkTime(const std::string& max_time);

  double allowed_s() const { return allowed_s_; }  // 0: any
  // So long before the end of the time; none: it may take any time.
  std::optional<TimeLimit::Clock::time_point> end_before(double reserve_s) const;
  // After half of what is left.
  std::optional<TimeLimit::Clock::time_point> half_of_rest() const;

 private:
  double allowed_s_ = 0.0;
  std::optional<TimeLimit::Clock::time_point> end_;
};

// Whether a signal asks the verb to end (interrupts.hpp).
bool is_interrupted();

// Does what the verb does. If the time or a signal ended it before there was anything to print, says so.
int unless_given_up(const std::function<int()>& work);

}  // namespace fleetproof::cli
