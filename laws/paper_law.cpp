#include "laws/paper_law.hpp"

#include <algorithm>

#include "laws/published_law.hpp"
#include "laws/second_opinion.hpp"

namespace fleetproof {
namespace {

bool in_same_time(const Piece& drive, const Piece& other) { return drive.begin < other.end && other.begin < drive.end; }

OrientedRectangle as_rectangle(const Box& box) {
  const Vec2 half_m = 0.5 * (box.high_m - box.low_m);
  return {0.5 * (box.low_m + box.high_m), Vec2::UnitX(), half_m.x(), half_m.y()};
}

class PaperLaw final : public PublishedLaw {
 public:
  using PublishedLaw::PublishedLaw;

 private:
  Box activity_perimeter(const Piece& drive) const { return drive.swept_box(drive.end).grown(threshold_m()); }
  void inspect(const Piece& drive) override;
  void inspect_stationary(const Piece& drive, EntityId entity);
  void inspect_other_drive(const Piece& drive, const Piece& other);
};

void PaperLaw::inspect(const Piece& drive) {
  for (std::size_t i = 0; i < entity_count(); ++i) {
    const EntityId entity{i};
    if (entity == drive.entity) continue;
    bool stationary = true;
    for (const Piece& other : timeline(entity)) {
      if (other.manner != Manner::Drive || !in_same_time(drive, other)) continue;
      stationary = false;
      inspect_other_drive(drive, other);
    }
    if (stationary) inspect_stationary(drive, entity);
  }
}

void PaperLaw::inspect_stationary(const Piece& drive, EntityId entity) {
  const OrientedRectangle perimeter = as_rectangle(activity_perimeter(drive));
  const Piece* standing = piece_at(entity, drive.begin);
  if (standing == nullptr || !is_there_throughout(entity, drive.begin, drive.end))
    return;  // the paper has no entities that come or go
  const OrientedRectangle body = standing->body_at(drive.begin);
  if (checked(overlap_by_fcl(perimeter, body))) accuse_throughout(drive, entity);
}

void PaperLaw::inspect_other_drive(const Piece& drive, const Piece& other) {
  if (!checked(activity_perimeter(drive).overlaps(activity_perimeter(other)))) return;
  const SimTime begin = std::max(drive.begin, other.begin), end = std::min(drive.end, other.end);
  for (SimTime t = begin; t < end; t += step()) check_snapshot(drive, other, t);
}

}  // namespace

std::unique_ptr<Law> make_paper_law(const Scenario& scenario) { return std::make_unique<PaperLaw>(scenario); }

}  // namespace fleetproof
