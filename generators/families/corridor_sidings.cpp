#include <fmt/format.h>

#include <algorithm>

#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

// Along the corridor from station `first` to station `last`; on the left side (y > 0) or on the right.
struct Siding {
  std::uint32_t first, last;
  bool left;
  Way way;
};

struct CorridorSizes {
  std::int64_t pitch, spur, offset;  // millimetres; offset: of a siding's track from the corridor
  std::uint32_t steps;               // segments of the corridor
};

CorridorSizes draw_corridor(Draws& draws, Range range) {
  CorridorSizes s{};
  s.pitch = draw_between(draws, 3600, 4800, 50);
  s.spur = draw_between(draws, 3000, 3500, 50);
  s.offset = draw_between(draws, 2400, 3000, 50);
  const std::int64_t shortest = range == Range::Stress ? 60'000 : 30'000,
                     longest = range == Range::Stress ? 100'000 : 60'000;
  s.steps = static_cast<std::uint32_t>(draw_between(draws, (shortest + s.pitch - 1) / s.pitch, longest / s.pitch, 1));
  return s;
}

class CorridorSidings {
 public:
  CorridorSidings(Draws& draws, Range range)
      : draws_(draws),
        range_(range),
        sizes_(draw_corridor(draws, range)),
        builder_(family_name("corridor-sidings", range)) {}

  Layout make() {
    for (std::uint32_t i = 0; i <= sizes_.steps; ++i)
      corridor_.push_back(builder_.station(fmt::format("C{}", i), {i * sizes_.pitch, 0}));
    for (std::uint32_t i = 0; i < sizes_.steps; ++i) builder_.straight(corridor_[i], corridor_[i + 1]);
    range_ == Range::Stress ? draw_one_siding_or_none() : draw_sidings();
    for (const auto& siding : sidings_) add_siding(siding);
    add_end(0, -1);
    add_end(sizes_.steps, 1);
    add_spurs();
    return builder_.take();
  }

 private:
  // Two or three segments long, 10 to 20 m from the beginning of one to the beginning of the next.
  void draw_sidings() {
    std::uint32_t at = 1 + draws_.below(2);
    while (true) {
      const std::uint32_t steps = 2 + draws_.below(2);
      const std::uint32_t longest_gap = (steps + 2) * sizes_.pitch <= 20'000 ? 2 : 1;
      const std::uint32_t gap = 1 + draws_.below(longest_gap);
      if (at + steps + 1 > sizes_.steps) return;
      const bool left = draws_.below(2) == 0;
      const Way way = draws_.below(3) != 0 ? Way::Both : draws_.below(2) == 0 ? Way::Forward : Way::Backward;
      sidings_.push_back({at, at + steps, left, way});
      at += steps + gap;
    }
  }

  // AGVs that meet in the corridor must back out of it, because there is only one place to pass, or none.
  void draw_one_siding_or_none() {
    if (draws_.below(2) == 0) return;
    const std::uint32_t at = 1 + draws_.below(sizes_.steps - 3);
    sidings_.push_back({at, at + 2, draws_.below(2) == 0, Way::Both});
  }

  // A siding leaves the corridor in a gentle bend, runs beside it, and comes back in another bend. Every inner station
  // of a siding is a place to wait.
  void add_siding(const Siding& siding) {
    const std::int64_t y = siding.left ? sizes_.offset : -sizes_.offset;
    StationId before = corridor_[siding.first];
    for (std::uint32_t i = siding.first + 1; i < siding.last; ++i) {
      const StationId here =
          builder_.station(fmt::format("park{}", ++parking_), {i * sizes_.pitch, y}, Purpose::Parking);
      if (i == siding.first + 1) {
        builder_.s_bend(before, here, siding.way);
      } else {
        builder_.straight(before, here, siding.way);
      }
      before = here;
    }
    builder_.s_bend(before, corridor_[siding.last], siding.way);
  }

  // A corridor ends in two or three spurs; one of them, on the first end, is a charger.
  void add_end(std::uint32_t i, std::int64_t outwards) {
    const std::int64_t x = i * sizes_.pitch;
    const std::uint32_t missing = draws_.below(4);  // 3: none
    const PointMm places[] = {{x + outwards * sizes_.spur, 0}, {x, sizes_.spur}, {x, -sizes_.spur}};
    bool charger = i == 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (k == missing) continue;
      add_spur(corridor_[i], places[k], charger);
      charger = false;
    }
  }

  void add_spur(StationId from, PointMm to, bool charger) {
    const auto name = charger ? std::string("charge1") : fmt::format("S{}", ++storage_);
    builder_.straight(from, builder_.station(name, to, charger ? Purpose::Charging : Purpose::Storage));
  }

  bool beside_siding(std::uint32_t i, bool left) const {
    return std::ranges::any_of(sidings_,
                               [&](const Siding& s) { return s.left == left && s.first <= i && i <= s.last; });
  }

  void add_spurs() {
    struct Site {
      std::uint32_t station;
      bool left;
    };
    std::vector<Site> sites;
    for (std::uint32_t i = 1; i < sizes_.steps; ++i) {
      for (const bool left : {true, false}) {
        if (!beside_siding(i, left)) sites.push_back({i, left});
      }
    }
    const std::uint32_t wanted = 4 + draws_.below(5);
    for (std::uint32_t k = 0; k < wanted && !sites.empty(); ++k) {
      const auto n = draws_.below(static_cast<std::uint32_t>(sites.size()));
      const auto [station, left] = sites[n];
      sites.erase(sites.begin() + n);
      const PointMm at{station * sizes_.pitch, left ? sizes_.spur : -sizes_.spur};
      if (parking_ == 0) {
        builder_.straight(corridor_[station],
                          builder_.station(fmt::format("park{}", ++parking_), at, Purpose::Parking));
      } else {
        add_spur(corridor_[station], at, false);
      }
    }
  }

  Draws& draws_;
  Range range_;
  CorridorSizes sizes_;
  LayoutBuilder builder_;
  std::vector<StationId> corridor_;
  std::vector<Siding> sidings_;
  std::uint32_t parking_ = 0, storage_ = 0;
};

}  // namespace

Layout make_corridor_sidings(Draws& draws, Range range) { return CorridorSidings(draws, range).make(); }

}  // namespace fleetproof
