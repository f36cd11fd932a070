#include "generators/random_planar.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generators/layout_builder.hpp"
#include "generators/reachability.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kLeastDistance_mm = 4'000, kLongestSegment_mm = 9'000;
constexpr std::uint32_t kThrows = 400, kMostStations = 34, kFewestStations = 16;
constexpr std::uint32_t kFirstGentleTry = 8;  // of drawing a network whose core is large enough

std::int64_t squared(std::int64_t x) { return x * x; }
std::int64_t squared_distance(PointMm a, PointMm b) { return squared(a.x - b.x) + squared(a.y - b.y); }

struct Edge {
  std::uint32_t a, b;
  Way way;
};

class RandomPlanar {
 public:
  explicit RandomPlanar(Draws& draws) : draws_(draws) {}

  // The first tries leave edges out and make some one-way; a core too small is drawn anew, in the end with every edge two-way.
  Layout make() {
    for (std::uint32_t attempt = 0;; ++attempt) {
      strew();
      join(attempt >= kFirstGentleTry);
      keep_core();
      if (points_.size() < kFewestStations) continue;
      return build();
    }
  }

 private:
  // Poisson disk: darts that fall too near to an earlier one are taken away.
  void strew() {
    const std::int64_t width = draw_between(draws_, 22'000, 32'000, 500), height = draw_between(draws_, 16'000, 24'000, 500);
    points_.clear();
    for (std::uint32_t i = 0; i < kThrows && points_.size() < kMostStations; ++i) {
      PointMm p;
      p.x = draw_between(draws_, 0, width, 10);
      p.y = draw_between(draws_, 0, height, 10);
      const auto near = [&](PointMm q) { return squared_distance(p, q) < squared(kLeastDistance_mm); };
      if (std::ranges::none_of(points_, near)) points_.push_back(p);
    }
  }

  // Two stations are neighbours in the Gabriel graph if no third lies in the circle over the line between them. So a station is at
  // least 0.707 of the least distance from every line of which it is no end: room to wait, and no lines that cross.
  bool are_neighbours(std::size_t a, std::size_t b) const {
    const std::int64_t apart = squared_distance(points_[a], points_[b]);
    if (apart > squared(kLongestSegment_mm)) return false;
    for (std::size_t c = 0; c < points_.size(); ++c) {
      if (c != a && c != b && squared_distance(points_[a], points_[c]) + squared_distance(points_[c], points_[b]) <= apart) return false;
    }
    return true;
  }

  void join(bool gentle) {
    const std::uint32_t left_out_percent = gentle ? 0 : draws_.below(31), two_way_percent = gentle ? 100 : 40 + draws_.below(61);
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
    std::erase_if(edges_, [&](const Edge& e) { return !reachability.in_core(StationId{e.a}) || !reachability.in_core(StationId{e.b}); });
    for (auto& e : edges_) e = {number[e.a], number[e.b], e.way};
    points_ = std::move(kept);
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
    LayoutBuilder builder("random-planar");
    for (std::size_t i = 0; i < points_.size(); ++i) builder.station(places[i].name, points_[i], places[i].purpose);
    for (const auto& e : edges_) builder.straight(StationId{e.a}, StationId{e.b}, e.way);
    return builder.take();
  }

  Draws& draws_;
  std::vector<PointMm> points_;
  std::vector<Edge> edges_;
};

}  // namespace

Layout make_random_planar(Draws& draws) { return RandomPlanar(draws).make(); }

}  // namespace fleetproof
