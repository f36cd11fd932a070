#pragma once

#include "core/scenario/scenario_fields.hpp"
#include "generators/worlds/computer_faults.hpp"
#include "generators/worlds/drawn_radio.hpp"
#include "generators/worlds/fault_rates.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_maker.hpp"

// The fields of what a campaign fixes about its worlds.
namespace fleetproof {

inline constexpr Field kPlacement{.key = "placement",
                                  .text = "how the fleet stands at the start",
                                  .lenient = Lenient::either(Weight::Load).but_not("adversarial mixed")};

template <FieldsOf<Demand> Given, class Visit>
void visit_fields(Given& demand, Visit&& visit) {
  auto& [transports_per_agv_hour, hot_spot_skew] = demand;
  visit(Field{.key = "transports_per_agv_hour",
              .text = "mean of a Poisson process for each AGV, whose first order comes within 10 s; 0: no orders",
              .lenient = Lenient::down(Weight::Load),
              .high = 3600.0},
        transports_per_agv_hour);
  visit(Field{.key = "hot_spot_skew",
              .text = "the n-th busiest station gets n^-skew of the busiest one's orders; 0: all get alike",
              .lenient = Lenient::down(Weight::Load),
              .high = 4.0},
        hot_spot_skew);
}

template <FieldsOf<OrderSetup> Given, class Visit>
void visit_fields(Given& orders, Visit&& visit) {
  auto& [transports, withdrawn_share] = orders;
  visit(Field{.key = "transports",
              .text = "assigned: each AGV has its own; open: the computers get all, or without computers every AGV",
              .lenient = Lenient::none("it says what the software has to decide"),
              .left_out = transports == OrderKind::Assigned},
        transports);
  visit(Field{.key = "withdrawn_share",
              .text = "probability that a transport is withdrawn within 300 s of its release",
              .lenient = Lenient::up(Weight::Load, 0.5),
              .left_out = withdrawn_share == 0.0},
        withdrawn_share);
}

// Sources are alike in all but their places, which are drawn.
template <FieldsOf<DrawnSources> Sources, class Visit>
void visit_fields(Sources& sources, Visit&& visit) {
  auto& [count, like] = sources;
  visit(Field{.key = "sources",
              .text = "external sources (other networks, ovens, welding robots), in other places in every replicate",
              .lenient = Lenient::down(Weight::Load),
              .high = 1000.0},
        count);
  visit_fields(like, [&](const Field& field, auto& value) {
    if (field.key == "range_m") visit(field.named("source_range_m"), value);
    if (field.key == "mean_on_s") visit(field.named("source_mean_on_s"), value);
    if (field.key == "mean_off_s") visit(field.named("source_mean_off_s"), value);
    if (field.key == "loss") visit(field.named("source_loss"), value);
  });
}

template <FieldsOf<VehicleShare> Share, class Visit>
void visit_fields(Share& vehicle, Visit&& visit) {
  auto& [type, share] = vehicle;
  visit(Field{.key = "share",
              .text = "how much of the fleet is of this type, relative to the others",
              .lenient = Lenient::none("what fills the fleet stands under Conditions"),
              .high = 1e6,
              .above_low = true},
        share);
  visit_fields(type, visit);
}

}  // namespace fleetproof
