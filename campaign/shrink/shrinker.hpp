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
  // Requires: trials and on_smaller outlive the object.
  Shrinker(Trials& trials, FailingCase original, const OnSmaller& on_smaller)
      : trials_(trials), best_(std::move(original)), on_smaller_(on_smaller) {}

  // Ends the run some time after the failure: a case that takes another course may fail later.
  bool shorten_with_slack();
  // Ends the run with the failure.
  bool shorten();
  // Leaves only the AGVs of the failure, or these and one more.
  bool keep_the_involved();
  // AGVs, transports, faults, obstacles, sources of radio noise.
  bool take_out_things();
  bool take_out_segments();
  // The radio is perfect before and after a stretch of time.
  bool narrow_bad_luck();

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
  Scenario with_other_luck(Scenario scenario, std::size_t attempt) const;
  std::size_t attempts() const;

  Trials& trials_;
  FailingCase best_;
  const OnSmaller& on_smaller_;
};

}  // namespace fleetproof
