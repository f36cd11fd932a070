#include <fmt/format.h>

#include <algorithm>

#include "core/geometry/rotation.hpp"
#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kShortestLoop_mm = 60'000, kLongestLoop_mm = 200'000;
// Between the ends of two spurs that face each other, and between a spur's end and the lane across the loop.
constexpr std::int64_t kRoomToWait_mm = 2'300;

struct LoopSizes {
  std::int64_t pitch, radius, spur;  // millimetres
  std::uint32_t along, across;       // segments of a long and of a short side
  std::uint32_t spurs;
};

LoopSizes draw_loop(Draws& draws) {
  LoopSizes s{};
  s.pitch = draw_between(draws, 3600, 4800, 50);
  s.radius = draw_between(draws, kRoomToWait_mm, 3000, 50);
  s.spur = draw_between(draws, 3500, 6000, 50);
  s.across = 1 + draws.below(3);
  // The curve of a bend is a thousandth longer than the quarter circle.
  const auto bends = static_cast<std::int64_t>(2.002 * kPi * static_cast<double>(s.radius));
  const std::int64_t rest = bends + 2 * s.across * s.pitch, two_steps = 2 * s.pitch;
  const std::int64_t fewest = (kShortestLoop_mm - rest + two_steps - 1) / two_steps,
                     most = (kLongestLoop_mm - rest) / two_steps;
  s.along = static_cast<std::uint32_t>(draw_between(draws, fewest, most, 1));
  s.spurs = 8 + draws.below(23);
  return s;
}

class LoopSpurs {
 public:
  LoopSpurs(Draws& draws, Range range)
      : draws_(draws),
        range_(range),
        sizes_(draw_loop(draws)),
        way_(draws.below(2) == 0 ? Way::Forward : Way::Backward),
        builder_(family_name("loop-spurs", range)) {}

  Layout make() {
    place_loop();
    connect_loop();
    if (range_ == Range::Stress) add_chords();
    add_spurs();
    return builder_.take();
  }

 private:
  struct Side {
    PointMm begin, step;  // counter-clockwise round the loop
    std::uint32_t steps;
    PointMm corner;  // beyond its last station
    std::vector<StationId> stations;
  };

  struct Site {
    StationId from;
    PointMm to;
  };

  std::int64_t width() const { return sizes_.along * sizes_.pitch; }
  std::int64_t height() const { return sizes_.across * sizes_.pitch; }

  void place_loop() {
    const std::int64_t w = width(), h = height(), r = sizes_.radius, p = sizes_.pitch;
    sides_ = {{{0, 0}, {p, 0}, sizes_.along, {w + r, 0}, {}},
              {{w + r, r}, {0, p}, sizes_.across, {w + r, h + 2 * r}, {}},
              {{w, h + 2 * r}, {-p, 0}, sizes_.along, {-r, h + 2 * r}, {}},
              {{-r, h + r}, {0, -p}, sizes_.across, {-r, 0}, {}}};
    std::uint32_t number = 0;
    for (auto& side : sides_) {
      for (std::uint32_t i = 0; i <= side.steps; ++i) {
        const PointMm at{side.begin.x + i * side.step.x, side.begin.y + i * side.step.y};
        side.stations.push_back(builder_.station(fmt::format("L{}", ++number), at));
      }
    }
  }

  void connect_loop() {
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const auto& side = sides_[k];
      for (std::size_t i = 0; i + 1 < side.stations.size(); ++i)
        builder_.straight(side.stations[i], side.stations[i + 1], way_);
      builder_.quarter_bend(side.stations.back(), side.corner, sides_[(k + 1) % sides_.size()].stations.front(), way_);
    }
  }

  // Lanes across the loop, in pairs. The two lanes of a pair cross each other at a place without a station.
  void add_chords() {
    const std::uint32_t pairs = 1 + draws_.below(2), half = sizes_.along / 2;
    for (std::uint32_t k = 0; k < pairs; ++k) {
      const std::uint32_t span = 1 + draws_.below(std::min(2U, half)), left = k * half + draws_.below(half - span + 1),
                          right = left + span;
      add_chord(left, right);
      add_chord(right, left);
    }
  }

  // From the lower long side to the upper one, whose stations run the other way.
  void add_chord(std::uint32_t low, std::uint32_t high) {
    builder_.straight(sides_[0].stations[low], sides_[2].stations[sizes_.along - high],
                      draws_.below(2) == 0 ? Way::Forward : Way::Backward);
  }

  // Spurs lead outwards everywhere. They lead inwards from the long sides only, where the loop is wide enough to wait.
  std::vector<Site> sites() const {
    const std::int64_t spur = sizes_.spur, inside = height() + 2 * sizes_.radius;
    const bool lower_inwards = range_ == Range::Normal && inside >= spur + kRoomToWait_mm,
               upper_inwards = range_ == Range::Normal && inside >= 2 * spur + kRoomToWait_mm;
    std::vector<Site> found;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const PointMm outwards{k == 1 ? spur : k == 3 ? -spur : 0, k == 0 ? -spur : k == 2 ? spur : 0};
      const bool inwards = (k == 0 && lower_inwards) || (k == 2 && upper_inwards);
      for (const auto station : sides_[k].stations) {
        const PointMm at = builder_.position(station);
        found.push_back({station, {at.x + outwards.x, at.y + outwards.y}});
        if (inwards) found.push_back({station, {at.x - outwards.x, at.y - outwards.y}});
      }
    }
    return found;
  }

  void add_spurs() {
    const auto all = sites();
    const auto chosen = draw_some(draws_, all.size(), sizes_.spurs);
    const std::size_t charging = chosen.size() >= 16 ? 2 : 1, parking = chosen.size() / 6;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto site = range_ == Range::Stress ? shortened(all[chosen[i]], i == 0) : all[chosen[i]];
      if (i < charging) {
        add_spur(site, fmt::format("charge{}", i + 1), Purpose::Charging);
      } else if (i < charging + parking) {
        add_spur(site, fmt::format("park{}", i - charging + 1), Purpose::Parking);
      } else {
        add_spur(site, fmt::format("S{}", i - charging - parking + 1), Purpose::Storage);
      }
    }
  }

  // In every second spur, and in one at least, a vehicle sticks out into the loop.
  Site shortened(const Site& site, bool certainly) {
    if (draws_.below(2) == 0 && !certainly) return site;
    const std::int64_t spur = draw_between(draws_, 900, 1500, 50);
    const PointMm root = builder_.position(site.from);
    return {site.from,
            {root.x + (site.to.x - root.x) * spur / sizes_.spur, root.y + (site.to.y - root.y) * spur / sizes_.spur}};
  }

  void add_spur(const Site& site, std::string name, Purpose purpose) {
    builder_.straight(site.from, builder_.station(std::move(name), site.to, purpose));
  }

  Draws& draws_;
  Range range_;
  LoopSizes sizes_;
  Way way_;
  LayoutBuilder builder_;
  std::vector<Side> sides_;
};

}  // namespace

Layout make_loop_spurs(Draws& draws, Range range) { return LoopSpurs(draws, range).make(); }

}  // namespace fleetproof
