#pragma once

#include "core/scenario/field.hpp"
#include "core/scenario/radio_setup.hpp"

// The fields of the radio and of an external source.
namespace fleetproof {

inline constexpr double kLongestDelay_s = 3600.0, kLongestRange_m = 1e9, kLongestOutage_s = 1e6;

template <FieldsOf<RadioSource> Source, class Visit>
void visit_fields(Source& source, Visit&& visit) {
  auto& [x_m, y_m, range_m, mean_on_s, mean_off_s, loss] = source;
  visit(Field{.key = "x_m",
              .text = "where the source stands",
              .lenient = kOfScenarios,
              .low = -1e9,
              .high = 1e9,
              .needed = true},
        x_m);
  visit(Field{.key = "y_m",
              .text = "where the source stands",
              .lenient = kOfScenarios,
              .low = -1e9,
              .high = 1e9,
              .needed = true},
        y_m);
  visit(Field{.key = "range_m",
              .text = "receivers within this distance of a source that is on lose messages",
              .lenient = Lenient::down(Weight::Load),
              .high = kLongestRange_m,
              .above_low = true},
        range_m);
  visit(Field{.key = "mean_on_s",
              .text = "mean time for which a source is on; exponential",
              .lenient = Lenient::down(Weight::Load),
              .low = 0.001,
              .high = 1e6},
        mean_on_s);
  visit(Field{.key = "mean_off_s",
              .text = "mean time between two such times; exponential; 0: it is always on",
              .lenient = Lenient::up(Weight::Load),
              .high = 1e6},
        mean_off_s);
  visit(Field{.key = "loss",
              .text = "share of the messages that a receiver near a source that is on loses",
              .lenient = Lenient::down(Weight::Load)},
        loss);
}

template <FieldsOf<OutageSetup> Outages, class Visit>
void visit_fields(Outages& outages, Visit&& visit) {
  auto& [mean_outage_s, model, shape, scope, loss_good, loss_bad] = outages;
  visit(Field{.key = "mean_outage_s",
              .text = "mean length of an outage; 0: losses are independent of each other",
              .lenient = kSampled,
              .high = kLongestOutage_s,
              .home = FieldHome::Factor},
        mean_outage_s);
  visit(Field{.key = "outage_model",
              .text = "how the lengths of outages are distributed",
              .lenient = Lenient::either(Weight::Load)},
        model);
  visit(Field{.key = "outage_shape",
              .text = "of \"heavy-tail\" outages: the nearer to 1, the heavier the tail",
              .lenient = Lenient::up(Weight::Load),
              .low = 1.05,
              .high = 100.0},
        shape);
  visit(Field{.key = "outage_scope",
              .text = "one process for each pair of AGVs, for each direction of a pair, or for each access-point cell",
              .lenient = Lenient::either(Weight::Load)},
        scope);
  visit(
      Field{.key = "loss_good", .text = "share of messages lost between outages", .lenient = Lenient::up(Weight::Load)},
      loss_good);
  visit(Field{.key = "loss_bad", .text = "share of messages lost in an outage", .lenient = Lenient::down(Weight::Load)},
        loss_bad);
}

template <FieldsOf<DelayTailSetup> Tail, class Visit>
void visit_fields(Tail& tail, Visit&& visit) {
  auto& [min_share, median_share, shape, cap_share] = tail;
  visit(Field{.key = "delay_min_share",
              .text = "of \"heavy-tail\" delays: the shortest, as a share of delay_s",
              .lenient = Lenient::down(Weight::Load)},
        min_share);
  visit(Field{.key = "delay_median_share",
              .text = "of \"heavy-tail\" delays: the median, as a share of delay_s",
              .lenient = Lenient::down(Weight::Load)},
        median_share);
  visit(Field{.key = "delay_tail_shape",
              .text = "of \"heavy-tail\" delays: the smaller, the heavier the tail",
              .lenient = Lenient::up(Weight::Load),
              .low = 0.1,
              .high = 100.0},
        shape);
  visit(Field{.key = "delay_cap_share",
              .text = "of \"heavy-tail\" delays: the longest, as a share of delay_s; 0: there is no longest",
              .lenient = Lenient::down(Weight::Load).zero_is_endless(),
              .high = 1e6},
        cap_share);
}

template <FieldsOf<PlaceSetup> Places, class Visit>
void visit_fields(Places& places, Visit&& visit) {
  auto& [ap_spacing_m, at_crossing, border_m, min_s, max_s, gap_s] = places;
  visit(Field{.key = "ap_spacing_m",
              .text = "side of the square cell of an access point",
              .lenient = Lenient::up(Weight::Load),
              .low = 1.0,
              .high = 1e6},
        ap_spacing_m);
  visit(Field{.key = "roaming_at_crossing",
              .text = "an AGV that drives over a border of cells is deaf and mute",
              .lenient = Lenient::down(Weight::Load)},
        at_crossing);
  visit(Field{.key = "roaming_border_m",
              .text = "AGVs this near a border are deaf and mute in its handover windows; 0: no windows",
              .lenient = Lenient::down(Weight::Load),
              .high = 1e6},
        border_m);
  visit(Field{.key = "roaming_min_s",
              .text = "shortest change of access point, and shortest window",
              .lenient = Lenient::down(Weight::Load),
              .low = 0.001,
              .high = kLongestDelay_s},
        min_s);
  visit(Field{.key = "roaming_max_s",
              .text = "longest change of access point, and longest window; uniform",
              .lenient = Lenient::down(Weight::Load),
              .low = 0.001,
              .high = kLongestDelay_s},
        max_s);
  visit(Field{.key = "roaming_gap_s",
              .text = "mean time between two windows of a border; exponential; 0: one follows the other",
              .lenient = Lenient::up(Weight::Load),
              .high = 1e6},
        gap_s);
}

template <FieldsOf<InterferenceSetup> Contention, class Visit>
void visit_fields(Contention& contention, Visit&& visit) {
  auto& [interference, contention_window] = contention;
  visit(Field{.key = "interference",
              .text = "transmissions that overlap destroy each other",
              .lenient = Lenient::down(Weight::Load)},
        interference);
  visit(Field{.key = "contention_window",
              .text = "longest wait before sending, in air times",
              .lenient = Lenient::either(Weight::Load),
              .high = 1023.0},
        contention_window);
}

template <FieldsOf<AdverseScope> Adverse, class Visit>
void visit_fields(Adverse& adverse, Visit&& visit) {
  auto& [adverse_from_s, adverse_until_s, spared_kinds] = adverse;
  visit(Field{.key = "adverse_from_s",
              .text = "what is sent earlier arrives, at once and once",
              .lenient = kOfScenarios,
              .high = 1e7,
              .home = FieldHome::ScenarioOnly,
              .left_out = adverse_from_s == 0.0,
              .is_later = true},
        adverse_from_s);
  visit(Field{.key = "adverse_until_s",
              .text = "so does what is sent then or later; 0: no end",
              .lenient = kOfScenarios,
              .high = 1e7,
              .home = FieldHome::ScenarioOnly,
              .left_out = adverse_until_s == 0.0,
              .is_later = true},
        adverse_until_s);
  visit(Field{.key = "spared_kinds",
              .text = "messages that their sender describes so arrive, at once and once",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = spared_kinds.empty(),
              .is_later = true},
        spared_kinds);
}

template <FieldsOf<RadioSetup> Radio, class Visit>
void visit_fields(Radio& radio, Visit&& visit) {
  auto& [loss, delay_s, delay_model, range_m, range_falloff_m, air_time_s, air_time_per_byte_s, outages, delay_tail,
         adverse, asymmetry, duplicates, places, contention, sources, trace] = radio;
  visit(
      Field{.key = "loss", .text = "nominal share of receptions lost", .lenient = kSampled, .home = FieldHome::Factor},
      loss);
  visit(Field{.key = "delay_s",
              .text = "nominal delay of a message; the longest one, but for \"heavy-tail\"",
              .lenient = kSampled,
              .high = kLongestDelay_s,
              .home = FieldHome::Factor},
        delay_s);
  visit(Field{.key = "delay_model",
              .text = "always delay_s, uniform from 0 to delay_s, or mostly short and seldom long",
              .lenient = Lenient::either(Weight::Load)},
        delay_model);
  visit(Field{.key = "range_m",
              .text = "how far a message reaches, between reference points",
              .lenient = Lenient::up(Weight::Load),
              .high = kLongestRange_m,
              .above_low = true},
        range_m);
  visit(Field{.key = "range_falloff_m",
              .text = "over this last part of the range the loss grows to 1; 0: the range ends sharply",
              .lenient = Lenient::down(Weight::Load),
              .high = kLongestRange_m,
              .left_out = range_falloff_m == 0.0},
        range_falloff_m);
  visit(Field{.key = "air_time_s",
              .text = "how long an empty message is in the air",
              .lenient = Lenient::down(Weight::Load),
              .high = kLongestDelay_s},
        air_time_s);
  visit(Field{.key = "air_time_per_byte_s",
              .text = "what each byte adds to it: 8 / bit rate; 0: size does not matter",
              .lenient = Lenient::down(Weight::Load)},
        air_time_per_byte_s);
  visit_fields(outages, visit);
  visit_fields(delay_tail, visit);
  visit_fields(adverse, visit);
  visit(Field{.key = "asymmetry",
              .text = "how far the losses of the two directions of a pair differ",
              .lenient = Lenient::down(Weight::Load)},
        asymmetry);
  visit(Field{.key = "duplicates",
              .text = "share of the messages received that arrive twice",
              .lenient = Lenient::down(Weight::Load)},
        duplicates);
  visit_fields(places, visit);
  visit_fields(contention, visit);
  visit(Field{.key = "sources",
              .text = "things that send and are no AGVs: other networks, ovens, welding robots",
              .lenient = kOfScenarios,
              .home = FieldHome::ScenarioOnly,
              .left_out = sources.empty()},
        sources);
  visit(Field{.key = "trace",
              .text = "a recording that decides the delivery of messages; a campaign names a CSV file",
              .lenient = kToldAtHead,
              .left_out = trace == nullptr || trace->empty()},
        trace);
}

template <FieldsOf<GivenDelivery> Given, class Visit>
void visit_fields(Given& delivery, Visit&& visit) {
  auto& [sender, receiver, sent, ordinal, lost, delay, copied, copy_delay] = delivery;
  visit(Field{.key = "sender",
              .text = "name of the AGV or computer that sends it",
              .lenient = kOfScenarios,
              .needed = true},
        sender);
  visit(Field{.key = "receiver",
              .text = "name of the AGV or computer to which this applies",
              .lenient = kOfScenarios,
              .needed = true},
        receiver);
  visit(Field{.key = "sent_s",
              .text = "when it is sent, to the nanosecond",
              .lenient = kOfScenarios,
              .high = 1e9,
              .needed = true},
        sent);
  visit(Field{.key = "ordinal",
              .text = "which of the messages from the one to the other at that instant, from 0 on",
              .lenient = kOfScenarios,
              .high = 4294967295.0,
              .left_out = ordinal == 0},
        ordinal);
  visit(Field{.key = "lost", .text = "it does not arrive", .lenient = kOfScenarios, .left_out = !lost}, lost);
  visit(Field{.key = "delay_s",
              .text = "when it arrives after it was sent",
              .lenient = kOfScenarios,
              .high = kLongestDelay_s,
              .left_out = lost},
        delay);
  visit(
      Field{
          .key = "copied", .text = "it arrives twice", .lenient = kOfScenarios, .left_out = !copied, .is_later = true},
      copied);
  visit(Field{.key = "copy_delay_s",
              .text = "when its copy arrives after it was sent",
              .lenient = kOfScenarios,
              .high = kLongestDelay_s,
              .left_out = !copied,
              .is_later = true},
        copy_delay);
}

}  // namespace fleetproof
