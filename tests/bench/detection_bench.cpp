// One distance between two rectangles: ours against FCL's, in one run.
#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

struct Pair {
  OrientedRectangle a, b;
};

std::vector<Pair> random_pairs() {
  Draws draws(11);
  const auto body = [&] {
    const Vec2 centre{draws.uniform(0.0, 6.0), draws.uniform(0.0, 6.0)};
    return OrientedRectangle{centre, unit_vector(draws.uniform(-3.0, 3.0)), draws.uniform(0.3, 1.5),
                             draws.uniform(0.3, 1.5)};
  };
  std::vector<Pair> pairs(1024);
  for (Pair& pair : pairs) pair = {body(), body()};
  return pairs;
}

void planar_distance(benchmark::State& state) {
  const auto pairs = random_pairs();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(separation(pairs[i].a, pairs[i].b));
    i = (i + 1) % pairs.size();
  }
}
BENCHMARK(planar_distance);

fcl::Transform3d transform_of(const OrientedRectangle& rectangle) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.linear() << rectangle.heading.x(), -rectangle.heading.y(), 0, rectangle.heading.y(), rectangle.heading.x(),
      0, 0, 0, 1;
  transform.translation() << rectangle.centre_m.x(), rectangle.centre_m.y(), 0;
  return transform;
}

void fcl_distance(benchmark::State& state) {
  struct Prepared {
    fcl::Boxd a, b;
    fcl::Transform3d at_a, at_b;
  };
  std::vector<Prepared> prepared;
  for (const Pair& pair : random_pairs()) {
    prepared.push_back({fcl::Boxd(2 * pair.a.half_length_m, 2 * pair.a.half_width_m, 20.0),
                        fcl::Boxd(2 * pair.b.half_length_m, 2 * pair.b.half_width_m, 20.0), transform_of(pair.a),
                        transform_of(pair.b)});
  }
  fcl::DistanceRequestd request;
  request.gjk_solver_type = fcl::GST_INDEP;
  std::size_t i = 0;
  for (auto _ : state) {
    fcl::DistanceResultd result;
    benchmark::DoNotOptimize(
        fcl::distance(&prepared[i].a, prepared[i].at_a, &prepared[i].b, prepared[i].at_b, request, result));
    i = (i + 1) % prepared.size();
  }
}
BENCHMARK(fcl_distance);

}  // namespace
}  // namespace fleetproof
