#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"

// Judges layouts and scenarios without any code of the generators or of the geometry kernel: plain matrices, corners
// and samples.
namespace fleetproof::independent {

inline constexpr std::size_t kMostStations = 640;
using Row = std::bitset<kMostStations>;

// reach[a][b]: station b can be reached from a (Warshall), without passing station `without` if that is given.
inline std::vector<Row> reach(const Layout& layout, std::size_t without = kMostStations) {
  const auto n = layout.stations.size();
  if (n > kMostStations) std::abort();
  std::vector<Row> r(n);
  for (std::size_t i = 0; i < n; ++i) r[i][i] = true;
  for (const auto& s : layout.segments) {
    if (s.from.index() == without || s.to.index() == without) continue;
    r[s.from.index()][s.to.index()] = true;
    if (s.bidirectional) r[s.to.index()][s.from.index()] = true;
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      if (r[i][k]) r[i] |= r[k];
    }
  }
  return r;
}

inline bool all_reach_all(const Layout& layout) {
  const auto n = layout.stations.size();
  for (const auto& row : reach(layout)) {
    if (row.count() != n) return false;
  }
  return true;
}

// Whether all other stations still reach each other if an AGV stands on `station` and no AGV can pass it.
inline bool leaves_a_way(const Layout& layout, std::size_t station) {
  const auto r = reach(layout, station);
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (i != station && r[i].count() != r.size() - 1) return false;
  }
  return true;
}

// How many seeds a test goes through: 300, or what FLEETPROOF_SEEDS says.
inline std::uint64_t seed_count() {
  const char* wanted = std::getenv("FLEETPROOF_SEEDS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 300;
}

inline double distance_to_line_m(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + along * (b - a))).norm();
}

// Points along a segment, straight from the definition of a Bezier curve.
inline std::vector<Vec2> samples(const Layout& layout, const Segment& s) {
  constexpr int kSteps = 64;
  std::vector<Vec2> p{layout.stations[s.from.index()].position_m}, points{p[0]};
  p.insert(p.end(), s.control_points_m.begin(), s.control_points_m.end());
  p.push_back(layout.stations[s.to.index()].position_m);
  if (p.size() == 2) return p;
  for (std::size_t i = 0; i + 3 < p.size(); i += 3) {
    for (int k = 1; k <= kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps, u = 1.0 - t;
      points.push_back(u * u * u * p[i] + 3.0 * u * u * t * p[i + 1] + 3.0 * u * t * t * p[i + 2] +
                       t * t * t * p[i + 3]);
    }
  }
  return points;
}

inline double distance_to_segment_m(const Layout& layout, const Segment& s, const Vec2& p) {
  const auto points = samples(layout, s);
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    least = std::min(least, distance_to_line_m(p, points[i], points[i + 1]));
  return least;
}

inline double length_m(const Layout& layout, const Segment& s) {
  const auto points = samples(layout, s);
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  return length;
}

using Corners = std::array<Vec2, 4>;

inline Corners corners(const Vec2& centre, const Vec2& heading, const Footprint& f) {
  const Vec2 l = 0.5 * f.length_m * heading, w = 0.5 * f.width_m * Vec2(-heading.y(), heading.x());
  return {centre + l + w, centre - l + w, centre - l - w, centre + l - w};
}

inline bool inside(const Corners& body, const Vec2& p) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 side = body[(i + 1) % 4] - body[i], to = p - body[i];
    if (side.x() * to.y() - side.y() * to.x() < 0.0) return false;
  }
  return true;
}

// 0 where they overlap; exact otherwise, as the nearest points of two disjoint rectangles include a corner.
inline double gap_m(const Corners& a, const Corners& b) {
  const auto cross = [](const Vec2& u, const Vec2& v) { return u.x() * v.y() - u.y() * v.x(); };
  double least = 1e300;
  for (std::size_t i = 0; i < 4; ++i) {
    if (inside(a, b[i]) || inside(b, a[i])) return 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 a0 = a[i], a1 = a[(i + 1) % 4], b0 = b[k], b1 = b[(k + 1) % 4];
      if (cross(a1 - a0, b0 - a0) * cross(a1 - a0, b1 - a0) < 0.0 &&
          cross(b1 - b0, a0 - b0) * cross(b1 - b0, a1 - b0) < 0.0)
        return 0.0;
      least = std::min({least, distance_to_line_m(a0, b0, b1), distance_to_line_m(b0, a0, a1)});
    }
  }
  return least;
}

inline std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string source_file(const std::string& relative) {
  return std::string(FLEETPROOF_SOURCE_DIR) + "/" + relative;
}

}  // namespace fleetproof::independent
