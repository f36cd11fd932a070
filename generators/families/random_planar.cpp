#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kLeastDistance_mm = 4'000, kLongestSegment_mm = 9'000;
constexpr std::uint32_t kThrows = 400, kMostJunctions = 34, kFewestPoints = 16, kFewestUnderStress = 12;
constexpr std::uint32_t kFirstGentleTry = 8;  // from this try on, every edge is two-way

std::int64_t squared(std::int64_t x) { return x * x; }
std::int64_t squared_distance(PointMm a, PointMm b) { return squared(a.x - b.x) + squared(a.y - b.y); }

struct Edge {
  std::uint32_t a, b;
  Way way;
};

std::int64_t nearest_mm(double mm) { return static_cast<std::int64_t>(std::floor(mm + 0.5)); }

class RandomPlanar {
 public:
  RandomPlanar(Draws& draws, Range range) : draws_(draws), range_(range) {}

  // The first tries leave edges out and make some edges one-way. If the core is too small, the network is drawn again;
  // the last tries make every edge two-way.
  Layout make() {
    for (std::uint32_t attempt = 0;; ++attempt) {
      strew();
      join(attempt >= kFirstGentleTry);
      keep_core();
      if (points_.size() < (range_ == Range::Stress ? kFewestUnderStress : kFewestPoints)) continue;
      if (range_ == Range::Stress && !squeeze_in_lanes()) continue;
      return build();
    }
  }

 private:
  // Poisson disk: a point that would lie too near to an earlier point is not added.
  void strew() {
    const std::int64_t width = draw_between(draws_, 22'000, 32'000, 500),
                       height = draw_between(draws_, 16'000, 24'000, 500);
    points_.clear();
    for (std::uint32_t i = 0; i < kThrows && points_.size() < kMostJunctions; ++i) {
      PointMm p;
      p.x = draw_between(draws_, 0, width, 10);
      p.y = draw_between(draws_, 0, height, 10);
      const auto near = [&](PointMm q) { return squared_distance(p, q) < squared(kLeastDistance_mm); };
      if (std::ranges::none_of(points_, near)) points_.push_back(p);
    }
  }

  // Two stations are neighbours in the Gabriel graph if no third lies in the circle over the line between them. So no
  // lines cross, and a station keeps at least 0.707 of the least distance from every line that does not end at it. This
  // is room to wait.
  bool are_neighbours(std::size_t a, std::size_t b) const {
    const std::int64_t apart = squared_distance(points_[a], points_[b]);
    if (apart > squared(kLongestSegment_mm)) return false;
    for (std::size_t c = 0; c < points_.size(); ++c) {
      if (c != a && c != b &&
          squared_distance(points_[a], points_[c]) + squared_distance(points_[c], points_[b]) <= apart)
        return false;
    }
    return true;
  }

  void join(bool gentle) {
    const std::uint32_t least_percent = range_ == Range::Stress ? 30 : 0;
    const std::uint32_t left_out_percent = gentle ? least_percent : least_percent + draws_.below(31),
                        two_way_percent = gentle ? 100 : 40 + draws_.below(61);
    edges_.clear();
    for (std::uint32_t a = 0; a < points_.size(); ++a) {
      for (std::uint32_t b = a + 1; b < points_.size(); ++b) {
        if (!are_neighbours(a, b)) continue;
        const bool left_out = draws_.below(100) < left_out_percent, two_way = draws_.below(100) < two_way_percent;
        const Way one_way = draws_.below(2) == 0 ? Way::Forward : Way::Backward;
        if (!left_out) edges_.push_back({a, b, two_way ? Way::Both : one_way});
      }
    }
  }

  void keep_core() {
    LayoutBuilder all("all");
    for (std::size_t i = 0; i < points_.size(); ++i) all.station(fmt::format("{}", i), points_[i]);
    for (const auto& e : edges_) all.straight(StationId{e.a}, StationId{e.b}, e.way);
    const LogicalMap map(all.take());
    const Reachability reachability(map);
    std::vector<std::uint32_t> number(points_.size());
    std::vector<PointMm> kept;
    for (const auto station : reachability.core()) {
      number[station.index()] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(points_[station.index()]);
    }
    std::erase_if(edges_, [&](const Edge& e) {
      return !reachability.in_core(StationId{e.a}) || !reachability.in_core(StationId{e.b});
    });
    for (auto& e : edges_) e = {number[e.a], number[e.b], e.way};
    points_ = std::move(kept);
  }

  // Adds a lane beside up to three of the longer edges. The lane leaves one end at less than 30 degrees and comes back
  // to the other end in the same way. Between them it runs beside the edge at 1.2 to 1.5 vehicle widths. Two bodies
  // side by side there share no station, but have little or no room.
  bool squeeze_in_lanes() {
    const std::size_t before = edges_.size();
    std::size_t squeezed = 0;
    for (const auto n : draw_some(draws_, before, before)) {
      if (squeezed == 3) break;
      if (squeeze_in_beside(edges_[n])) ++squeezed;
    }
    return squeezed > 0;
  }

  bool squeeze_in_beside(const Edge edge) {
    const PointMm a = points_[edge.a], b = points_[edge.b];
    const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y),
                 length = std::sqrt(dx * dx + dy * dy);
    const auto aside = static_cast<double>(draw_between(draws_, 1200, 1500, 10));
    const double side = draws_.below(2) == 0 ? 1.0 : -1.0, along = 1.9 * aside;  // 27.8 degrees
    if (length < 2.0 * along + 1'000.0) return false;
    const auto beside = [&](double s) {
      return PointMm{a.x + nearest_mm((s * dx - side * aside * dy) / length),
                     a.y + nearest_mm((s * dy + side * aside * dx) / length)};
    };
    const PointMm p = beside(along), q = beside(length - along);
    const auto near = [&](PointMm other) {
      return std::min(squared_distance(p, other), squared_distance(q, other)) < squared(1'000);
    };
    if (std::ranges::any_of(points_, near)) return false;
    const auto first = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    points_.push_back(q);
    for (const Edge& e :
         {Edge{edge.a, first, edge.way}, Edge{first, first + 1, edge.way}, Edge{first + 1, edge.b, edge.way}})
      edges_.push_back(e);
    return true;
  }

  Layout build() {
    struct Place {
      std::string name;
      Purpose purpose;
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i < points_.size(); ++i) places.push_back({fmt::format("R{}", i + 1), Purpose::Routing});
    const std::size_t parking = points_.size() / 8, charging = 1, storage = points_.size() * 2 / 5;
    std::size_t k = 0;
    for (const auto n : draw_some(draws_, points_.size(), parking + charging + storage)) {
      if (k < parking) {
        places[n] = {fmt::format("park{}", k + 1), Purpose::Parking};
      } else if (k < parking + charging) {
        places[n] = {fmt::format("charge{}", k - parking + 1), Purpose::Charging};
      } else {
        places[n] = {fmt::format("S{}", k - parking - charging + 1), Purpose::Storage};
      }
      ++k;
    }
    LayoutBuilder builder(family_name("random-planar", range_));
    for (std::size_t i = 0; i < points_.size(); ++i) builder.station(places[i].name, points_[i], places[i].purpose);
    for (const auto& e : edges_) builder.straight(StationId{e.a}, StationId{e.b}, e.way);
    return builder.take();
  }

  Draws& draws_;
  Range range_;
  std::vector<PointMm> points_;
  std::vector<Edge> edges_;
};

}  // namespace

Layout make_random_planar(Draws& draws, Range range) { return RandomPlanar(draws, range).make(); }

}  // namespace fleetproof
