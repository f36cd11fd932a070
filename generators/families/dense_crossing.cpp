#include <fmt/format.h>

#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kVehicleLength_mm = 1'600;

struct CrossingSizes {
  std::uint32_t lines;       // in each direction
  std::int64_t pitch, spur;  // millimetres
  std::uint32_t spurs;
};

CrossingSizes draw_crossing(Draws& draws, Range range) {
  CrossingSizes s{};
  const bool stress = range == Range::Stress;
  s.lines = stress ? 4 + draws.below(3) : 3 + draws.below(4);
  s.pitch = stress ? draw_between(draws, kVehicleLength_mm, kVehicleLength_mm * 2, 100)
                   : draw_between(draws, kVehicleLength_mm * 3 / 2, kVehicleLength_mm * 5 / 2, 50);
  s.spur = draw_between(draws, 3000, 3500, 50);
  s.spurs = 10 + draws.below(4 * s.lines - 9);
  return s;
}

class DenseCrossing {
 public:
  DenseCrossing(Draws& draws, Range range)
      : draws_(draws),
        range_(range),
        sizes_(draw_crossing(draws, range)),
        builder_(family_name("dense-crossing", range)) {}

  Layout make() {
    crossings_ = grid("X", sizes_.lines, 0);
    connect(crossings_);
    if (range_ == Range::Stress) overlay();
    add_spurs();
    return builder_.take();
  }

 private:
  using Grid = std::vector<std::vector<StationId>>;  // by column, then row

  Grid grid(std::string_view letter, std::uint32_t lines, std::int64_t offset) {
    Grid made;
    for (std::uint32_t i = 0; i < lines; ++i) {
      auto& column = made.emplace_back();
      for (std::uint32_t j = 0; j < lines; ++j) {
        column.push_back(builder_.station(fmt::format("{}{}.{}", letter, i + 1, j + 1),
                                          {offset + i * sizes_.pitch, offset + j * sizes_.pitch}));
      }
    }
    return made;
  }

  // A second grid, shifted by half a pitch, like the graph of a second fleet. Its lanes cross the lanes of the first
  // grid at places without a station. Only two opposite corners join the two grids.
  void overlay() {
    const Grid second = grid("Y", sizes_.lines - 1, sizes_.pitch / 2);
    connect(second);
    builder_.straight(crossings_.front().front(), second.front().front());
    builder_.straight(crossings_.back().back(), second.back().back());
  }

  // The outer lines form a ring in one direction, and every inner line starts and ends on the ring. The grid is
  // therefore strongly connected for every draw.
  void connect(const Grid& stations) {
    const auto last = static_cast<std::uint32_t>(stations.size()) - 1;
    const bool clockwise = draws_.below(2) == 0;
    const Way with = clockwise ? Way::Forward : Way::Backward, against = clockwise ? Way::Backward : Way::Forward;
    const auto way = [&](std::uint32_t line, Way first, Way final) {
      if (line == 0) return first;
      if (line == last) return final;
      return draws_.below(2) == 0 ? Way::Forward : Way::Backward;
    };
    for (std::uint32_t i = 0; i <= last; ++i) {
      const Way column = way(i, with, against), row = way(i, against, with);
      for (std::uint32_t k = 0; k < last; ++k) {
        builder_.straight(stations[i][k], stations[i][k + 1], column);
        builder_.straight(stations[k][i], stations[k + 1][i], row);
      }
    }
  }

  // Every line may go on beyond the rim, at both ends.
  void add_spurs() {
    struct Site {
      StationId from;
      PointMm outwards;
    };
    const std::uint32_t last = sizes_.lines - 1;
    std::vector<Site> sites;
    for (std::uint32_t i = 0; i <= last; ++i) {
      sites.push_back({crossings_[i][0], {0, -sizes_.spur}});
      sites.push_back({crossings_[i][last], {0, sizes_.spur}});
      sites.push_back({crossings_[0][i], {-sizes_.spur, 0}});
      sites.push_back({crossings_[last][i], {sizes_.spur, 0}});
    }
    std::uint32_t number = 0;
    const std::uint32_t charging = 1, parking = 2 + draws_.below(2);
    for (const auto n : draw_some(draws_, sites.size(), sizes_.spurs)) {
      const auto& [from, outwards] = sites[n];
      const PointMm at{builder_.position(from).x + outwards.x, builder_.position(from).y + outwards.y};
      const bool charges = number < charging, parks = !charges && number < charging + parking;
      const auto name = charges ? fmt::format("charge{}", number + 1)
                        : parks ? fmt::format("park{}", number - charging + 1)
                                : fmt::format("S{}", number - charging - parking + 1);
      const auto purpose = charges ? Purpose::Charging : parks ? Purpose::Parking : Purpose::Storage;
      builder_.straight(from, builder_.station(name, at, purpose));
      ++number;
    }
  }

  Draws& draws_;
  Range range_;
  CrossingSizes sizes_;
  LayoutBuilder builder_;
  Grid crossings_;
};

}  // namespace

Layout make_dense_crossing(Draws& draws, Range range) { return DenseCrossing(draws, range).make(); }

}  // namespace fleetproof
