#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/geometry/rotation.hpp"
#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

struct FishboneSizes {
  std::int64_t dx, dy, spur;  // millimetres; dx, dy: from one picking aisle to the next, and one step along it
  std::int32_t steps;         // of a diagonal
  std::uint32_t parking, charging, docks;
};

std::int64_t whole_mm(double mm) { return static_cast<std::int64_t>(mm + 0.5); }

// Both legs of the diagonal's angle are at least `shorter`. At 45 degrees, a station beside the diagonal is then 0.707
// of `shorter` away from it. Stress: flatter or steeper, and so narrow that bodies on neighbouring aisles pass each
// other within 10 cm.
FishboneSizes draw_fishbone(Draws& draws, Range range) {
  FishboneSizes s{};
  const bool stress = range == Range::Stress, steep = stress && draws.below(2) == 0;
  const double shorter =
      static_cast<double>(stress ? draw_between(draws, 2100, 2600, 50) : draw_between(draws, 3150, 3700, 50));
  const std::int64_t degrees = !stress ? draw_between(draws, 30, 60, 1)
                               : steep ? draw_between(draws, 60, 70, 1)
                                       : draw_between(draws, 20, 30, 1);
  const Vec2 diagonal = unit_vector(static_cast<double>(degrees) * kPi / 180.0);
  const double scale = shorter / std::min(diagonal.x(), diagonal.y());
  s.dx = whole_mm(scale * diagonal.x());
  s.dy = whole_mm(scale * diagonal.y());
  s.spur = draw_between(draws, 3000, 3500, 50);
  s.steps = 3 + static_cast<std::int32_t>(draws.below(3));
  s.parking = 2;
  s.charging = 1;
  s.docks = 1 + draws.below(2);
  return s;
}

// Stations lie on a grid: column 0 in the middle, row 0 in front. Diagonals run through |column| = row.
class Fishbone {
 public:
  Fishbone(Draws& draws, Range range)
      : draws_(draws), range_(range), sizes_(draw_fishbone(draws, range)), builder_(family_name("fishbone", range)) {}

  Layout make() {
    for (std::int32_t column = -sizes_.steps; column <= sizes_.steps; ++column) {
      for (std::int32_t row = 0; row <= sizes_.steps; ++row) place(column, row);
    }
    for (const std::int32_t side : {-1, 1}) add_half(side);
    upright_aisle(0);
    add_services();
    return builder_.take();
  }

 private:
  // The other stations, which are on no diagonal and on no front, back or side aisle, form the picking aisles.
  void place(std::int32_t column, std::int32_t row) {
    const std::int32_t away = std::abs(column), last = sizes_.steps;
    const bool cross = away == row || row == 0 || row == last || away == last;
    const auto name = fmt::format("{}{}.{}", cross ? "C" : "S", column + last + 1, row);
    at_[{column, row}] =
        builder_.station(name, {column * sizes_.dx, row * sizes_.dy}, cross ? Purpose::Routing : Purpose::Storage);
  }

  // Cross aisles are two-way. A picking aisle leads from one cross aisle to another, so its direction makes no station
  // unreachable.
  void add_half(std::int32_t side) {
    const std::int32_t last = sizes_.steps;
    for (std::int32_t k = 0; k < last; ++k) {
      connect({side * k, k}, {side * (k + 1), k + 1}, Way::Both);
      connect({side * k, 0}, {side * (k + 1), 0}, Way::Both);
      connect({side * k, last}, {side * (k + 1), last}, Way::Both);
      connect({side * last, k}, {side * last, k + 1}, Way::Both);
    }
    for (std::int32_t k = 1; k < last; ++k) {
      upright_aisle(side * k);
      const Way way = draw_way();
      for (std::int32_t i = k; i < last; ++i) connect({side * i, k}, {side * (i + 1), k}, way);
    }
  }

  void upright_aisle(std::int32_t column) {
    const Way way = draw_way();
    for (std::int32_t row = std::abs(column); row < sizes_.steps; ++row) connect({column, row}, {column, row + 1}, way);
  }

  Way draw_way() {
    return range_ == Range::Stress || draws_.below(2) == 0 ? Way::Both
           : draws_.below(2) == 0                          ? Way::Forward
                                                           : Way::Backward;
  }

  using Place = std::pair<std::int32_t, std::int32_t>;
  void connect(Place from, Place to, Way way) { builder_.straight(at_.at(from), at_.at(to), way); }

  // Spurs before the front.
  void add_services() {
    const auto columns = static_cast<std::size_t>(2 * sizes_.steps + 1);
    std::uint32_t number = 0;
    for (const auto n : draw_some(draws_, columns, sizes_.parking + sizes_.charging + sizes_.docks)) {
      const StationId from = at_.at({static_cast<std::int32_t>(n) - sizes_.steps, 0});
      const PointMm at{builder_.position(from).x, -sizes_.spur};
      const bool parks = number < sizes_.parking, charges = !parks && number < sizes_.parking + sizes_.charging;
      const auto name = parks     ? fmt::format("park{}", number + 1)
                        : charges ? fmt::format("charge{}", number - sizes_.parking + 1)
                                  : fmt::format("dock{}", number - sizes_.parking - sizes_.charging + 1);
      builder_.straight(from, builder_.station(name, at,
                                               parks     ? Purpose::Parking
                                               : charges ? Purpose::Charging
                                                         : Purpose::Storage));
      ++number;
    }
  }

  Draws& draws_;
  Range range_;
  FishboneSizes sizes_;
  LayoutBuilder builder_;
  std::map<Place, StationId> at_;
};

}  // namespace

Layout make_fishbone(Draws& draws, Range range) { return Fishbone(draws, range).make(); }

}  // namespace fleetproof
