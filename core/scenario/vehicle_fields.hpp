#pragma once

#include "core/scenario/field.hpp"
#include "core/scenario/vehicle_type.hpp"

// The fields of a kind of AGV. In every list of fields, structured bindings take the struct apart: a member that is
// added to it does not compile until it stands in its list.
namespace fleetproof {

inline constexpr double kLargestBody_m = 100.0, kSmallestBody_m = 0.001, kHour_s = 3600.0, kDay_s = 86400.0;
// Slower or faster than any vehicle. They keep every activity within the range of simulated time.
inline constexpr double kSlowest = 0.001, kFastest = 100.0;

inline constexpr Field kLength{"length_m", "length of the body, along its heading", Lenient::down(Weight::Plant, 0.3),
                               kSmallestBody_m, kLargestBody_m};
inline constexpr Field kWidth{"width_m", "width of the body", Lenient::down(Weight::Plant, 0.2), kSmallestBody_m,
                              kLargestBody_m};

inline constexpr Field kCentreAhead{
    .key = "centre_ahead_m",
    .text = "the body's centre, ahead of the reference point, which follows the track and about which it turns",
    .lenient = Lenient::none("no place of it is easier than another"),
    .low = -kLargestBody_m,
    .high = kLargestBody_m};
inline constexpr Field kReverseSpeed{.key = "reverse_speed_mps",
                                     .text = "top speed of driving backward, also above speed_mps; 0: as forward",
                                     .lenient = Lenient::down(Weight::Plant, 0.1).zero_is_endless(),
                                     .high = kFastest};

// How fast it drives and turns, and what a load changes. In scenario files these stand in groups.
template <class Drive, class Turn, class Loaded, class Visit>
void visit_motion_fields(Drive& drive, Turn& turn, Loaded& loaded, Visit&& visit) {
  auto& [speed_mps, acceleration_mps2, deceleration_mps2] = drive;
  auto& [speed_radps, acceleration_radps2, deceleration_radps2] = turn;
  auto& [extra_length_m, extra_width_m, speed_share, acceleration_share] = loaded;
  const auto rate = [](std::string_view key, std::string_view text, std::string_view place, Lenient lenient) {
    return Field{.key = key, .text = text, .lenient = lenient, .low = kSlowest, .high = kFastest, .place = place};
  };
  const auto extra = [](std::string_view key, std::string_view text, std::string_view place) {
    return Field{
        .key = key, .text = text, .lenient = Lenient::down(Weight::Plant), .high = kLargestBody_m, .place = place};
  };
  const auto share = [](std::string_view key, std::string_view text, std::string_view place) {
    return Field{.key = key, .text = text, .lenient = Lenient::down(Weight::Plant, 0.2), .low = 0.1, .place = place};
  };
  visit(rate("speed_mps", "top speed", "drive/speed_mps", Lenient::down(Weight::Plant, 0.2)), speed_mps);
  visit(rate("acceleration_mps2", "acceleration of a drive", "drive/acceleration_mps2",
             Lenient::down(Weight::Plant, 0.05)),
        acceleration_mps2);
  visit(rate("deceleration_mps2", "braking of a drive", "drive/deceleration_mps2", Lenient::up(Weight::Plant, 10.0)),
        deceleration_mps2);
  visit(rate("turn_speed_radps", "top speed of a turn on the spot", "turn/speed_radps",
             Lenient::down(Weight::Plant, 0.05)),
        speed_radps);
  visit(rate("turn_acceleration_radps2", "acceleration of a turn", "turn/acceleration_radps2",
             Lenient::down(Weight::Plant, 0.05)),
        acceleration_radps2);
  visit(rate("turn_deceleration_radps2", "braking of a turn", "turn/deceleration_radps2",
             Lenient::up(Weight::Plant, 20.0)),
        deceleration_radps2);
  visit(extra("loaded_extra_length_m", "a load makes the body longer by this much", "loaded/extra_length_m"),
        extra_length_m);
  visit(extra("loaded_extra_width_m", "a load makes the body wider by this much", "loaded/extra_width_m"),
        extra_width_m);
  visit(share("loaded_speed_share", "speed with a load, as a share of the empty vehicle's", "loaded/speed_share"),
        speed_share);
  visit(share("loaded_acceleration_share", "acceleration and braking with a load, as a share of the empty vehicle's",
              "loaded/acceleration_share"),
        acceleration_share);
}

template <FieldsOf<VehicleType> Vehicle, class Visit>
void visit_fields(Vehicle& vehicle, Visit&& visit) {
  auto& [name, footprint, drive, turn, loaded, lateral_mps2, reverse_speed_mps, speed_deviation, settle_s,
         battery_per_m, battery_idle_per_s, charge_per_s, dock_s, pick_s, drop_s, storage_spread_s, other_spread_s] =
      vehicle;
  auto& [length_m, width_m, centre_ahead_m] = footprint;
  visit(Field{.key = "name", .text = "name of the vehicle type", .lenient = kIsName}, name);
  visit(kLength, length_m);
  visit(kWidth, width_m);
  visit(kCentreAhead.left_out_if(centre_ahead_m == 0.0), centre_ahead_m);
  visit_motion_fields(drive, turn, loaded, visit);
  visit(Field{.key = "lateral_mps2",
              .text = "in a bend of radius R the speed is at most sqrt(lateral_mps2 * R); 0: as on the straight",
              .lenient = Lenient::down(Weight::Plant, 0.05).zero_is_endless(),
              .high = kFastest},
        lateral_mps2);
  visit(kReverseSpeed.left_out_if(reverse_speed_mps == 0.0), reverse_speed_mps);
  visit(Field{.key = "speed_deviation",
              .text = "every drive is faster or slower by up to this share",
              .lenient = Lenient::down(Weight::Plant),
              .high = 0.5},
        speed_deviation);
  visit(Field{.key = "settle_s",
              .text = "longest fine positioning after a drive to a stop; uniform",
              .lenient = Lenient::up(Weight::Plant, 120.0),
              .high = kHour_s},
        settle_s);
  visit(Field{.key = "battery_per_m",
              .text = "share of a full battery that a metre uses",
              .lenient = Lenient::down(Weight::Plant, 1e-6)},
        battery_per_m);
  visit(Field{.key = "battery_idle_per_s",
              .text = "share of a full battery that a second without charging uses",
              .lenient = Lenient::down(Weight::Plant)},
        battery_idle_per_s);
  visit(Field{.key = "charge_per_s",
              .text = "share of a full battery that a second of charging adds",
              .lenient = Lenient::up(Weight::Plant, 0.01),
              .low = 1e-6},
        charge_per_s);
  visit(Field{.key = "dock_s",
              .text = "time to connect to the charger, before charging begins",
              .lenient = Lenient::down(Weight::Plant),
              .high = kHour_s},
        dock_s);
  visit(Field{.key = "pick_s",
              .text = "shortest time to pick a load up",
              .lenient = Lenient::up(Weight::Plant, 300.0),
              .high = kHour_s},
        pick_s);
  visit(Field{.key = "drop_s",
              .text = "shortest time to set a load down",
              .lenient = Lenient::up(Weight::Plant, 300.0),
              .high = kHour_s},
        drop_s);
  visit(Field{.key = "storage_spread_s",
              .text = "a transfer at a storage station takes longer by up to this; uniform",
              .lenient = Lenient::up(Weight::Plant, 600.0),
              .high = kHour_s},
        storage_spread_s);
  visit(Field{.key = "other_spread_s",
              .text = "a transfer at any other station takes longer by up to this; uniform",
              .lenient = Lenient::up(Weight::Plant, 600.0),
              .high = kHour_s},
        other_spread_s);
}

}  // namespace fleetproof
