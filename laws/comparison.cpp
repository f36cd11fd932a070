#include "laws/comparison.hpp"

#include <algorithm>
#include <tuple>

#include "core/base/error.hpp"
#include "laws/episode.hpp"

namespace fleetproof {
namespace {

struct Span {
  SimTime begin, end;
  bool meets(const Piece& piece) const { return piece.begin < end && begin < piece.end; }
};

bool found_by(const std::vector<Violation>& others, const Violation& violation, Duration within) {
  return std::ranges::any_of(others, [&](const Violation& other) {
    return other.a == violation.a && other.b == violation.b && other.first <= violation.last + within &&
           violation.first <= other.last + within;
  });
}

class Explainer {
 public:
  Explainer(const Scenario& scenario, const TimelineKeeper& timelines)
      : threshold_m_(violation_threshold_m(scenario.law)),
        step_(seconds(scenario.law.snapshot_s)),
        timelines_(timelines) {}

  DifferenceCause of_miss(const Violation& v) const {
    const Span when{v.first, std::max(v.last, v.first + Duration{1})};
    if (const auto cause = two_drives(v, when)) return *cause;
    for (const auto& [mover, other] : {std::pair(v.a, v.b), std::pair(v.b, v.a)}) {
      for (const Piece& drive : timelines_.of(mover)) {
        if (drive.manner == Manner::Drive && when.meets(drive) && drives_within(other, drive))
          return DifferenceCause::RestPhase;
      }
    }
    if (drives_within(v.a, when) || drives_within(v.b, when)) return one_drive(v, when);
    return DifferenceCause::NoDriveActivity;
  }

  DifferenceCause of_accusation(const Violation& v) const {
    const OrientedRectangle a = body_at(v.a, v.closest_at), b = body_at(v.b, v.closest_at);
    const auto within = [](const OrientedRectangle& one, const OrientedRectangle& other) {
      return clearance_m(one, other) <= 0.0;
    };
    if (within(widened(a, threshold_m_), b) || within(widened(b, threshold_m_), a))
      return DifferenceCause::SquareCorners;
    return DifferenceCause::AxisAlignedPerimeter;
  }

 private:
  bool drives_within(EntityId entity, const Span& span) const {
    return std::ranges::any_of(timelines_.of(entity),
                               [&](const Piece& piece) { return piece.manner == Manner::Drive && span.meets(piece); });
  }
  bool drives_within(EntityId entity, const Piece& drive) const {
    return drives_within(entity, Span{drive.begin, drive.end});
  }

  // Both bodies drive during a part of the violation: which snapshots of their common time lie in the violation?
  std::optional<DifferenceCause> two_drives(const Violation& v, const Span& when) const {
    for (const Piece& one : timelines_.of(v.a)) {
      for (const Piece& other : timelines_.of(v.b)) {
        if (one.manner != Manner::Drive || other.manner != Manner::Drive) continue;
        const Span common{std::max(one.begin, other.begin), std::min(one.end, other.end)};
        if (common.begin >= common.end || std::max(common.begin, when.begin) >= std::min(common.end, when.end))
          continue;
        return snapshots_missed(common, when);
      }
    }
    return std::nullopt;
  }

  DifferenceCause snapshots_missed(const Span& seen, const Span& when) const {
    const auto steps = (std::max(when.begin, seen.begin) - seen.begin + step_ - Duration{1}) / step_;
    const SimTime next = seen.begin + steps * step_;  // the first snapshot at or after the violation's begin
    if (next >= seen.end && when.end >= seen.end) return DifferenceCause::LastInstant;
    return next < std::min(when.end, seen.end) ? DifferenceCause::Unexplained : DifferenceCause::BetweenSnapshots;
  }

  // One body drives, the other does not drive during that time: the rule compares boxes, or steps.
  DifferenceCause one_drive(const Violation& v, const Span& when) const {
    for (const EntityId entity : {v.a, v.b}) {
      for (const Piece& drive : timelines_.of(entity)) {
        if (drive.manner == Manner::Drive && when.meets(drive)) return snapshots_missed({drive.begin, drive.end}, when);
      }
    }
    return DifferenceCause::Unexplained;
  }

  OrientedRectangle body_at(EntityId entity, SimTime t) const {
    const auto& pieces = timelines_.of(entity);
    const auto later = std::ranges::upper_bound(pieces, t, {}, &Piece::begin);
    ensure(later != pieces.begin(), "the pieces of a body cover the run");
    return (later - 1)->body_at(t);
  }

  double threshold_m_;
  Duration step_;
  const TimelineKeeper& timelines_;
};

}  // namespace

const char* name_of(DifferenceCause cause) {
  switch (cause) {
    case DifferenceCause::RestPhase:
      return "rest phase";
    case DifferenceCause::BetweenSnapshots:
      return "between snapshots";
    case DifferenceCause::LastInstant:
      return "last instant";
    case DifferenceCause::NoDriveActivity:
      return "no drive activity";
    case DifferenceCause::AxisAlignedPerimeter:
      return "axis-aligned perimeter";
    case DifferenceCause::SquareCorners:
      return "square corners";
    case DifferenceCause::Unexplained:
      return "unexplained";
  }
  invariant_violated("a cause has a name");
}

std::vector<Difference> compare(const Scenario& scenario, const LawResults& published, const LawResults& judge,
                                const TimelineKeeper& timelines) {
  const Explainer why(scenario, timelines);
  const Duration step = seconds(scenario.law.snapshot_s);
  std::vector<Difference> differences;
  for (const Violation& v : judge.violations) {
    if (!found_by(published.violations, v, Duration::zero())) differences.push_back({true, why.of_miss(v), v});
  }
  for (const Violation& v : published.violations) {
    if (!found_by(judge.violations, v, step)) differences.push_back({false, why.of_accusation(v), v});
  }
  std::ranges::stable_sort(
      differences, {}, [](const Difference& d) { return std::tuple(d.violation.first, d.violation.a, d.violation.b); });
  return differences;
}

}  // namespace fleetproof
