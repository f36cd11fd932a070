#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

// What the two ranges draw from, in millimetres.
struct PassSizes {
  std::int64_t apart, room;              // at least, of two stations of a lane, and of any two
  std::int64_t low_height, high_height;  // of the ring
  std::int64_t low_pitch, high_pitch;    // of bars that are not side by side
  std::int64_t shift;                    // at most, of the end of a bar beside its root
  std::uint32_t fewest, most;            // bars
};

constexpr PassSizes kNormal{3'000, 2'100, 7'400, 8'400, 3'000, 4'200, 400, 8, 14},
    kStress{900, 900, 5'400, 6'600, 1'600, 4'200, 1'500, 6, 10};

// Of a lane, on a thousand millimetres of its straight line: kinks of a few degrees, or of up to 60. It keeps near it.
constexpr std::int64_t kGentle_mm = 80, kSharp_mm = 600, kMostSway_mm = 400;

// From the end of a bar to the other lane in the normal range: room for the nose of a fork lift.
constexpr std::int64_t kLowRoom_mm = 2'800, kHighRoom_mm = 3'400;

// Under stress, two bodies just pass each other, or just not: half the width of one, how far another reaches beyond its
// station, and a gap. It reaches there with its rear, nose or side, or when it turns: a fork lift, a vehicle without
// and with a load, a long one.
constexpr std::array<std::int64_t, 3> kHalfWidths_mm{500, 600, 650};
constexpr std::array<std::int64_t, 5> kReaches_mm{400, 800, 1'100, 1'200, 2'000};
constexpr std::array<std::int64_t, 4> kTurnReaches_mm{940, 1'280, 1'340, 2'090};
constexpr std::int64_t kLowGap_mm = -100, kHighGap_mm = 150;

// A station of a lane lies this far before or behind the end of a bar: there, corners of bodies are.
constexpr std::array<std::int64_t, 9> kOffsets_mm{-2'500, -1'600, -1'100, -400, 0, 400, 1'100, 1'600, 2'500};

// Of a bar that is not straight, in its middle: up to about 8 degrees.
constexpr std::int64_t kMostKink_mm = 150;

// From the first and the last bar to the ends of the lanes.
constexpr std::int64_t kMargin_mm = 3'000;

// An s-bend of a lane is as long as this at most, so that it is not nearly straight.
constexpr std::int64_t kLongestBend_mm = 3'500;

template <std::size_t N>
std::int64_t one_of(Draws& draws, const std::array<std::int64_t, N>& values) {
  return values[draws.below(N)];
}

class ClosePass {
 public:
  ClosePass(Draws& draws, Range range)
      : draws_(draws),
        stress_(range == Range::Stress),
        sizes_(stress_ ? kStress : kNormal),
        height_(draw_between(draws, sizes_.low_height, sizes_.high_height, 100)),
        way_(draw_way()),
        slope_(stress_ && draws.below(2) == 0 ? kSharp_mm : kGentle_mm),
        builder_(family_name("close-pass", range)) {}

  Layout make() {
    place_bars();
    for (const auto side : {kLower, kUpper}) place_lane(side);
    connect_lanes();
    add_bars();
    return builder_.take();
  }

 private:
  enum Side : std::size_t { kLower, kUpper };

  struct Bar {
    std::int64_t x, end_x;
    Side side;  // of the lane on which it stands
    StationId root{};
  };

  // Rings are one-way; under stress, every second one is two-way.
  Way draw_way() {
    const std::uint32_t drawn = draws_.below(stress_ ? 4 : 2);
    return drawn == 0 ? Way::Forward : drawn == 1 ? Way::Backward : Way::Both;
  }

  static Side other(Side side) { return side == kLower ? kUpper : kLower; }
  std::int64_t line(Side side) const { return side == kLower ? 0 : height_; }
  bool coin() { return draws_.below(2) == 0; }
  std::int64_t half_width() { return one_of(draws_, kHalfWidths_mm); }
  // For a body that passes, from the middle of its lane.
  std::int64_t room_beside() {
    const std::int64_t width = half_width();
    return width + draw_between(draws_, kLowGap_mm, kHighGap_mm, 10);
  }
  // Of the middles of two bodies side by side.
  std::int64_t side_by_side() {
    const std::int64_t reach = coin() ? one_of(draws_, kTurnReaches_mm) : half_width();
    return std::max(sizes_.apart, reach + room_beside());
  }

  void place_bars() {
    const std::uint32_t count = sizes_.fewest + draws_.below(sizes_.most - sizes_.fewest + 1);
    bars_.push_back({0, draw_shift(), draw_side()});
    while (bars_.size() < count) {
      const Bar& last = bars_.back();
      const bool is_beside_last = stress_ && coin();
      const std::int64_t x =
          last.x + (is_beside_last ? side_by_side() : draw_between(draws_, sizes_.low_pitch, sizes_.high_pitch, 50));
      // Bars side by side on one lane have the same shape.
      bars_.push_back(is_beside_last ? Bar{x, x + last.end_x - last.x, last.side}
                                     : Bar{x, x + draw_shift(), draw_side()});
    }
  }

  Side draw_side() { return coin() ? kLower : kUpper; }
  std::int64_t draw_shift() { return coin() ? 0 : draw_between(draws_, -sizes_.shift, sizes_.shift, 50); }

  // Stations at the roots of the lane's own bars and, where there is room, near the ends of the other lane's bars.
  void place_lane(Side side) {
    std::vector<std::int64_t> places{bars_.front().x - kMargin_mm, bars_.back().x + kMargin_mm};
    for (const auto& bar : bars_) {
      if (bar.side == side) places.push_back(bar.x);
    }
    for (const auto& bar : bars_) {
      const std::int64_t x = bar.end_x + one_of(draws_, kOffsets_mm);
      if (bar.side != side && is_inside(x) &&
          std::ranges::none_of(places, [&](std::int64_t other) { return std::abs(x - other) < sizes_.apart; }))
        places.push_back(x);
    }
    std::ranges::sort(places);
    for (const auto x : places) place_station(side, x);
    for (auto& bar : bars_) {
      if (bar.side == side)
        bar.root = lanes_[side][static_cast<std::size_t>(std::ranges::find(places, bar.x) - places.begin())];
    }
  }

  bool is_inside(std::int64_t x) const { return x > bars_.front().x - kMargin_mm && x < bars_.back().x + kMargin_mm; }

  void place_station(Side side, std::int64_t x) {
    auto& lane = lanes_[side];
    const std::int64_t sway = lane.empty() || !is_inside(x) ? 0 : draw_sway(builder_.position(lane.back()), x, side);
    lane.push_back(
        builder_.station(fmt::format("{}{}", side == kLower ? "L" : "U", lane.size() + 1), {x, line(side) + sway}));
  }

  // Every second station lies beside the line as far as the one before.
  std::int64_t draw_sway(PointMm before, std::int64_t x, Side side) {
    const std::int64_t sway = before.y - line(side);
    if (coin()) return sway;
    const std::int64_t most = (x - before.x) * slope_ / 1'000;
    return std::clamp(sway + draw_between(draws_, -most, most, 1), -kMostSway_mm, kMostSway_mm);
  }

  void connect_lanes() {
    for (const auto side : {kLower, kUpper}) {
      for (std::size_t i = 0; i + 1 < lanes_[side].size(); ++i) {
        // The ring runs along the upper lane from the largest x to the smallest.
        const StationId low = lanes_[side][i], high = lanes_[side][i + 1];
        connect(side == kLower ? low : high, side == kLower ? high : low);
      }
    }
    half_circle(lanes_[kLower].back(), lanes_[kUpper].back(), height_ / 2, "E1");
    half_circle(lanes_[kUpper].front(), lanes_[kLower].front(), -height_ / 2, "E2");
  }

  void connect(StationId from, StationId to) {
    const bool bends = draws_.below(3) == 0;
    if (bends && std::abs(builder_.position(to).x - builder_.position(from).x) <= kLongestBend_mm) {
      builder_.s_bend(from, to, way_);
    } else {
      builder_.straight(from, to, way_);
    }
  }

  void half_circle(StationId from, StationId to, std::int64_t radius, std::string name) {
    const PointMm begin = builder_.position(from), end = builder_.position(to);
    const StationId middle = builder_.station(std::move(name), {begin.x + radius, (begin.y + end.y) / 2});
    builder_.quarter_bend(from, {begin.x + radius, begin.y}, middle, way_);
    builder_.quarter_bend(middle, {end.x + radius, end.y}, to, way_);
  }

  void add_bars() {
    std::uint32_t number = 0;
    for (const auto n : draw_some(draws_, bars_.size(), bars_.size())) {
      const bool charges = number == 0, parks = number == 1;
      const auto name = charges ? "charge" : parks ? "park" : fmt::format("S{}", number - 1);
      const auto purpose = charges ? Purpose::Charging : parks ? Purpose::Parking : Purpose::Storage;
      add_bar(bars_[n], builder_.station(name, end_of(bars_[n]), purpose));
      ++number;
    }
  }

  // Straight, bent, or with a kink in its middle.
  void add_bar(const Bar& bar, StationId end) {
    const PointMm from = builder_.position(bar.root), to = builder_.position(end);
    const auto [in, out] = draw_travel();
    const PointMm kink{from.x + draw_between(draws_, -kMostKink_mm, kMostKink_mm, 10), (from.y + to.y) / 2};
    if (from.x != to.x) {
      builder_.s_bend_along_y(bar.root, end);
    } else if (stress_ && draws_.below(3) == 0 && !is_near_a_station(kink)) {
      const StationId middle = builder_.station(builder_.name(bar.root) + "k", kink);
      builder_.straight(bar.root, middle);
      builder_.travel(in, out);
      builder_.straight(middle, end);
    } else {
      builder_.straight(bar.root, end);
    }
    builder_.travel(in, out);
  }

  std::pair<Travel, Travel> draw_travel() {
    constexpr std::pair<Travel, Travel> kTravels[] = {{Travel::Forward, Travel::Forward},
                                                      {Travel::Forward, Travel::Forward},
                                                      {Travel::Backward, Travel::Forward},
                                                      {Travel::Forward, Travel::Backward},
                                                      {Travel::Either, Travel::Either}};
    return kTravels[draws_.below(std::size(kTravels))];
  }

  PointMm end_of(const Bar& bar) {
    const Side side = other(bar.side);
    const std::int64_t inwards = side == kLower ? 1 : -1;
    PointMm end{bar.end_x, lane_y(side, bar.end_x) + inwards * draw_room()};
    while (is_near_a_station(end)) end.y += inwards * 50;
    return end;
  }

  std::int64_t draw_room() {
    if (!stress_) return draw_between(draws_, kLowRoom_mm, kHighRoom_mm, 50);
    const std::int64_t reach = coin() ? one_of(draws_, kTurnReaches_mm) : one_of(draws_, kReaches_mm);
    return reach + room_beside();
  }

  // As if all its segments were straight.
  std::int64_t lane_y(Side side, std::int64_t x) const {
    const auto& lane = lanes_[side];
    const auto next = std::ranges::find_if(lane, [&](StationId s) { return builder_.position(s).x > x; });
    const PointMm b = builder_.position(*next), a = builder_.position(*(next - 1));
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
  }

  bool is_near_a_station(PointMm p) const {
    for (std::size_t i = 0; i < builder_.station_count(); ++i) {
      const PointMm station = builder_.position(StationId{i});
      const std::int64_t dx = station.x - p.x, dy = station.y - p.y;
      if (dx * dx + dy * dy < sizes_.room * sizes_.room) return true;
    }
    return false;
  }

  Draws& draws_;
  bool stress_;
  PassSizes sizes_;
  std::int64_t height_;  // of the ring, millimetres
  Way way_;
  std::int64_t slope_;  // of lanes at most, see kGentle_mm
  LayoutBuilder builder_;
  std::vector<Bar> bars_;
  std::array<std::vector<StationId>, 2> lanes_;  // by side, from the smallest x to the largest
};

}  // namespace

Layout make_close_pass(Draws& draws, Range range) { return ClosePass(draws, range).make(); }

}  // namespace fleetproof
