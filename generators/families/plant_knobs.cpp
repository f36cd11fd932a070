#include "generators/families/plant_knobs.hpp"

#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

struct Between {
  std::int64_t low, high, step;
};

std::int64_t draw(Draws& draws, const Between& normal, const Between& provoking, bool provoked) {
  const Between& range = provoked ? provoking : normal;
  return draw_between(draws, range.low, range.high, range.step);
}

}  // namespace

PlantKnobs draw_plant_knobs(Draws& draws, const PlantWish& wish) {
  const bool stress = wish.range == Range::Stress;
  // One draw for each, whatever is asked for, so that a plant with one knob turned is like the plant without it.
  const auto turned = [&](Provocation one) {
    const bool drawn = draws.below(2) == 0;
    return wish.provocation == one || (stress && drawn);
  };
  PlantKnobs k;
  k.all_mouths_cross = turned(Provocation::Crossing);
  const bool curves = turned(Provocation::CurveBesideLane), tight = turned(Provocation::TightGap),
             overhang = turned(Provocation::OverhangPass) && !tight;
  k.bottleneck = turned(Provocation::Bottleneck);
  k.four_way = turned(Provocation::FourWay);
  k.side_lanes_everywhere = curves;
  k.lane_gap = overhang ? draw_between(draws, 100, 150, 10) : draw(draws, {300, 600, 50}, {0, 120, 10}, tight);
  k.side_gap = draw(draws, {1200, 1700, 50}, {0, 300, 20}, curves);
  k.corner_radius = draw(draws, {2000, 3000, 50}, {1200, 1600, 50}, overhang);
  k.mouth_radius = draw_between(draws, 1500, 2200, 50);
  k.stop_pitch = draw(draws, {1000, 1500, 50}, {500, 1500, 50}, stress);
  k.aisle_rest = draw_between(draws, 2000, 3600, 100);
  k.corridor = draw_between(draws, 6000, 12000, 500);
  // Every second plant. The corridors say which, so that this takes no draw of its own.
  k.back_in = k.corridor >= 9'000 || wish.provocation == Provocation::BackIn;
  return k;
}

}  // namespace fleetproof
