#pragma once

#include "core/scenario/faults.hpp"
#include "core/scenario/vehicle_fields.hpp"

// The fields of a fault, and of the two helpers: scanner and operator.
namespace fleetproof {

inline constexpr double kLongest_s = 1e9;  // of any time in a scenario: keeps sums of times within 64 bits

template <FieldsOf<Fault> Given, class Visit>
void visit_fields(Given& fault, Visit&& visit) {
  auto& [kind, agv, at, transport, lasts, load, ahead_m, left_m, word, number] = fault;
  auto& [length_m, width_m, centre_ahead_m] = load;
  const bool no_load = kind != Fault::Kind::LoadDrop, no_name = kind != Fault::Kind::Named;
  visit(Field{.key = "kind", .text = "what goes wrong", .lenient = kOfScenarios, .needed = true}, kind);
  visit(Field{.key = "agv",
              .text = "name of the AGV or computer; left out: the AGV that picks the open transport",
              .lenient = kOfScenarios,
              .left_out = !agv.valid()},
        agv);
  visit(Field{.key = "at_s",
              .text = "when: since the start of the run, or since the AGV took up the load of `transport`",
              .lenient = kOfScenarios,
              .high = kLongest_s,
              .needed = true},
        at);
  visit(Field{.key = "transport",
              .text = "number among the AGV's own transports, from 0; without agv, among the open ones",
              .lenient = kOfScenarios,
              .high = 4294967295.0,
              .left_out = !transport},
        transport);
  visit(Field{.key = "lasts_s", .text = "for how long", .lenient = kOfScenarios, .high = kLongest_s, .needed = true},
        lasts);
  visit(kLength.left_out_if(no_load), length_m);
  visit(kWidth.left_out_if(no_load), width_m);
  visit(Field{.key = "ahead_m",
              .text = "of a load on the floor: its centre, ahead of the AGV's",
              .lenient = kOfScenarios,
              .low = -kLargestBody_m,
              .high = kLargestBody_m,
              .left_out = no_load},
        ahead_m);
  visit(Field{.key = "left_m",
              .text = "of a load on the floor: its centre, to the left of the AGV's",
              .lenient = kOfScenarios,
              .low = -kLargestBody_m,
              .high = kLargestBody_m,
              .left_out = no_load},
        left_m);
  visit(Field{.key = "word",
              .text = "of a named fault: what its program calls it",
              .lenient = kIsName,
              .left_out = no_name,
              .is_later = true},
        word);
  visit(Field{.key = "number",
              .text = "of a named fault: which one; its program knows what that means",
              .lenient = kOfScenarios,
              .high = 4294967295.0,
              .left_out = no_name,
              .is_later = true},
        number);
}

template <FieldsOf<ScannerSetup> Scanner, class Visit>
void visit_fields(Scanner& scanner, Visit&& visit) {
  auto& [on, reaction_s, margin_m, resume_s, range_m] = scanner;
  visit(Field{.key = "on",
              .text = "every AGV has a scanner; a campaign's [scanner] switches it on",
              .lenient = Lenient::up(Weight::Judgement)},
        on);
  visit(Field{.key = "reaction_s",
              .text = "time from seeing a body to braking; the scanner looks as often",
              .lenient = Lenient::down(Weight::Plant, 0.01),
              .low = 0.001,
              .high = 10.0},
        reaction_s);
  visit(Field{.key = "margin_m",
              .text = "added to the braking way, and to either side of the AGV",
              .lenient = Lenient::up(Weight::Plant, 1.0),
              .high = kLargestBody_m},
        margin_m);
  visit(Field{.key = "resume_s",
              .text = "the AGV drives on so long after the field is clear",
              .lenient = Lenient::up(Weight::Plant, 30.0),
              .high = kHour_s},
        resume_s);
  visit(Field{.key = "range_m",
              .text = "longest field that the scanner can watch; 0: as long as the braking way needs",
              .lenient = Lenient::up(Weight::Plant, 50.0).zero_is_endless(),
              .high = 1000.0,
              .left_out = range_m == 0.0},
        range_m);
}

template <FieldsOf<OperatorSetup> Help, class Visit>
void visit_fields(Help& help, Visit&& visit) {
  auto& [on, least_s, most_s, battery] = help;
  visit(Field{.key = "on",
              .text = "an operator helps; a campaign's [operator] switches it on",
              .lenient = Lenient::up(Weight::Judgement)},
        on);
  visit(Field{.key = "least_s",
              .text = "shortest time from a call to the help",
              .lenient = Lenient::down(Weight::Load),
              .low = 1.0,
              .high = kDay_s},
        least_s);
  visit(Field{.key = "most_s",
              .text = "longest time from a call to the help; uniform",
              .lenient = Lenient::down(Weight::Load),
              .low = 1.0,
              .high = kDay_s},
        most_s);
  visit(Field{.key = "battery",
              .text = "level of a battery after its change",
              .lenient = Lenient::none("full is usual"),
              .low = 0.01},
        battery);
}

}  // namespace fleetproof
