#include "laws/second_opinion.hpp"

#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

// FCL solves problems in space, this problem is planar: the boxes are so tall that their height decides nothing.
constexpr double kTall_m = 20.0;

// Placed relative to `origin_m`, because a solver loses digits far from the origin.
fcl::CollisionObjectd box_of(const OrientedRectangle& rectangle, const Vec2& origin_m) {
  const auto shape = std::make_shared<fcl::Boxd>(2.0 * rectangle.half_length_m, 2.0 * rectangle.half_width_m, kTall_m);
  const Vec2 at_m = rectangle.centre_m - origin_m;
  fcl::Matrix3d rotation;
  rotation << rectangle.heading.x(), -rectangle.heading.y(), 0.0,  //
      rectangle.heading.y(), rectangle.heading.x(), 0.0,           //
      0.0, 0.0, 1.0;
  return {shape, rotation, fcl::Vector3d(at_m.x(), at_m.y(), 0.0)};
}

struct TwoBoxes {
  fcl::CollisionObjectd first, second;

  TwoBoxes(const OrientedRectangle& one, const OrientedRectangle& other)
      : first(box_of(one, one.centre_m)), second(box_of(other, one.centre_m)) {}

  bool overlap() const {
    fcl::CollisionResultd result;
    return fcl::collide(&first, &second, fcl::CollisionRequestd(), result) > 0;
  }

  double clearance_m() const {
    // The default solver, GST_LIBCCD, reports distances up to metres too large; the signed mode aborts (FCL issue 508).
    fcl::DistanceRequestd request;
    request.enable_signed_distance = false;
    request.gjk_solver_type = fcl::GST_INDEP;
    fcl::DistanceResultd result;
    return std::max(0.0, fcl::distance(&first, &second, request, result));  // -1 stands for an overlap
  }
};

}  // namespace

bool overlap_by_fcl(const OrientedRectangle& first, const OrientedRectangle& second) {
  return TwoBoxes(first, second).overlap();
}

void confirm_clearance(const OrientedRectangle& first, const OrientedRectangle& second, double clearance_m) {
  const TwoBoxes boxes(first, second);
  const bool overlap = boxes.overlap();
  ensure(!(overlap && clearance_m > kSurelyApart_m),
         "a second opinion says that two bodies overlap which the law found apart");
  ensure(!(!overlap && clearance_m < -kSurelyApart_m),
         "a second opinion says that two bodies are apart which the law found overlapping");
  const double expected_m = std::max(0.0, clearance_m);
  ensure(std::abs(boxes.clearance_m() - expected_m) <= kOpinionsAgree_m,
         "a second opinion measures another clearance than the law");
}

}  // namespace fleetproof
