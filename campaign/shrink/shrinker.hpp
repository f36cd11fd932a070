#pragma once

#include <functional>
#include <string_view>
#include <utility>

#include "campaign/shrink/shrink.hpp"
#include "campaign/shrink/surgery.hpp"
#include "campaign/shrink/trials.hpp"

namespace fleetproof {

// The passes of shrink(). Each tries smaller cases, keeps what fails in the same way, and says whether it kept any.
class Shrinker {
 public:
  // Requires: trials and on_smaller outlive the object. Timelines::Free: each smaller case is tried with other
  // timelines, too. Timelines::Kept: only where the radio draws.
  enum class Timelines : bool { Kept, Free };
  Shrinker(Trials& trials, FailingCase original, const OnSmaller& on_smaller, Timelines timelines = Timelines::Kept)
      : trials_(trials), best_(std::move(original)), on_smaller_(on_smaller), timelines_(timelines) {}

  // Ends the run some time after the failure, perhaps later than before: on another timeline, it may fail later.
  bool end_with_slack();
  // Starts the run before the failure, at least by `lead_up`, from where the AGVs were then.
  bool start_later(Duration lead_up);
  // Ends the run with the failure.
  bool shorten();
  // A perfect radio; if that is too much, one on which no message is copied, late, or lost.
  bool improve_radio();
  // Leaves only the AGVs of the failure, or these and one more.
  bool keep_the_involved();
  // AGVs, transports, faults, obstacles, sources of radio noise.
  bool take_out_things();
  bool take_out_segments();
  // The radio is perfect before and after a span of time.
  bool narrow_losses();

  // Of which passes are made. The first candidate that fails in the same way is kept; if there is one, true.
  using Edit = std::function<Scenario(const Scenario& scenario, const Keeps& keeps)>;
  using Count = std::function<std::size_t(const Scenario& scenario)>;
  bool accept(std::optional<Trials::Found> found, std::string_view pass);
  // `edit` makes candidates 0 to count - 1 of the best case.
  bool try_each(std::string_view pass, std::size_t count, const std::function<void(Scenario&, std::size_t)>& edit);
  // Things of a list that has `count` items and of which `edit` keeps some: many at once, then fewer, then each alone.
  bool take_out(std::string_view pass, const Count& count, const Edit& edit);

  const FailingCase& best() const { return best_; }
  Trials& trials() { return trials_; }

 private:
  bool end_earliest(std::string_view pass);
  bool try_with_timelines(std::string_view pass, const Scenario& smaller);
  std::size_t attempts() const;
  bool is_involved(std::size_t agv) const;

  Trials& trials_;
  FailingCase best_;
  const OnSmaller& on_smaller_;
  Timelines timelines_;
  Duration shortest_ = kLongestDuration;  // of the runs that began later; they may end later again
};

}  // namespace fleetproof
