#include "campaign/cli/work_time.hpp"

#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/command_line.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/shrink/case_host.hpp"
#include "core/base/error.hpp"

namespace fleetproof::cli {

using Clock = TimeLimit::Clock;

WorkTime::WorkTime(const std::string& max_time) {
  if (max_time.empty()) return;
  const auto allowed = duration_of(max_time, "--max-time");
  allowed_s_ = std::chrono::duration<double>(allowed).count();
  end_ = Clock::now() + allowed;
}

std::optional<Clock::time_point> WorkTime::end_before(double reserve_s) const {
  if (!end_) return std::nullopt;
  return *end_ - std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(reserve_s));
}

std::optional<Clock::time_point> WorkTime::half_of_rest() const {
  if (!end_) return std::nullopt;
  const auto now = Clock::now();
  return now + (*end_ - now) / 2;
}

bool is_interrupted() { return interrupted() != 0; }

int unless_given_up(const std::function<int()>& work) {
  listen_to_interrupts();
  try {
    return work();
  } catch (const GivenUp&) {
    if (!is_interrupted())
      throw InputError("--max-time", "was over before there was anything to tell; give the verb more time");
    talk("interrupted before there was anything to tell\n");
    return exit_code_of_signal(interrupted());
  }
}

}  // namespace fleetproof::cli
