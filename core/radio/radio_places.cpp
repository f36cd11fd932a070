#include "core/radio/radio_places.hpp"

#include <cmath>

namespace fleetproof {
namespace {

OutageLaw windows(const PlaceSetup& setup) {
  const double mean_s = 0.5 * (setup.roaming_min_s + setup.roaming_max_s);
  return {.sojourn = OutageLaw::Sojourn::Uniform,
          .bad_share = setup.roaming_border_m > 0.0 ? mean_s / (mean_s + setup.roaming_gap_s) : 0.0,
          .min_s = setup.roaming_min_s,
          .max_s = setup.roaming_max_s};
}

}  // namespace

AccessCell access_cell(const Vec2& at_m, double spacing_m) {
  const auto number = [&](double coordinate_m) {
    return static_cast<std::int32_t>(std::floor(coordinate_m / spacing_m + 0.5));
  };
  return {number(at_m.x()), number(at_m.y())};
}

RadioPlaces::RadioPlaces(const PlaceSetup& setup, const OutageLaw& cell_law, std::uint64_t key)
    : setup_(setup), cell_law_(cell_law), border_law_(windows(setup)), key_(key) {}

bool RadioPlaces::near_border(double coordinate_m, std::int32_t& number) const {
  number = static_cast<std::int32_t>(std::floor(coordinate_m / setup_.ap_spacing_m));
  return std::abs(coordinate_m - (number + 0.5) * setup_.ap_spacing_m) <= setup_.roaming_border_m;
}

bool RadioPlaces::bad_at(Kind kind, std::int32_t i, std::int32_t k, const OutageLaw& law, SimTime t) {
  const auto [place, is_new] = processes_.try_emplace({kind, i, k});
  if (is_new) {
    place->second = OutageProcess(
        law, {key_, static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)});
  }
  return place->second.bad_at(t);
}

bool RadioPlaces::cell_is_out(const Vec2& at_m, SimTime t) {
  const auto [column, row] = access_cell(at_m, setup_.ap_spacing_m);
  return bad_at(Kind::Cell, column, row, cell_law_, t);
}

bool RadioPlaces::is_roaming(const Vec2& at_m, SimTime t) {
  const auto [column, row] = access_cell(at_m, setup_.ap_spacing_m);
  std::int32_t border = 0;
  if (near_border(at_m.x(), border) && bad_at(Kind::BorderAcrossX, border, row, border_law_, t)) return true;
  return near_border(at_m.y(), border) && bad_at(Kind::BorderAcrossY, column, border, border_law_, t);
}

}  // namespace fleetproof
