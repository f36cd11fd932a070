#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/radio_setup.hpp"

// The radio's fields by their names, once for scenario files, campaign files, plans and checks.
namespace fleetproof {

struct RadioField {
  std::string_view key;
  double low = 0.0, high = 1.0;               // of a number
  bool above_low = false;                     // `low` itself is refused
  bool is_factor = false;                     // a campaign sets it cell by cell
  std::span<const std::string_view> words{};  // of an enumeration, in its order
};

inline constexpr std::string_view kDelayModels[] = {"constant", "uniform", "heavy-tail"};
inline constexpr std::string_view kOutageModels[] = {"gilbert-elliott", "heavy-tail"};
inline constexpr std::string_view kOutageScopes[] = {"link", "direction", "place"};

// Calls visit(field, value) for every number, switch and word, in the order of files; sources and the recording are
// left to the caller. Structured bindings: a field that is added to the radio does not compile until it stands here.
template <class Radio, class Visit>
void for_each_radio_field(Radio& radio, Visit visit) {
  auto& [loss, delay_s, delay_model, range_m, air_time_s, air_time_per_byte_s, outages, delay_tail, asymmetry,
         duplicates, places, contention, sources, trace] = radio;
  (void)sources;
  (void)trace;
  visit(RadioField{.key = "loss", .is_factor = true}, loss);
  visit(RadioField{.key = "delay_s", .high = 1e9, .is_factor = true}, delay_s);
  visit(RadioField{.key = "delay_model", .words = kDelayModels}, delay_model);
  visit(RadioField{.key = "range_m", .high = 1e9, .above_low = true}, range_m);
  visit(RadioField{.key = "air_time_s", .high = 1e9}, air_time_s);
  visit(RadioField{.key = "air_time_per_byte_s"}, air_time_per_byte_s);
  auto& [mean_outage_s, outage_model, outage_shape, outage_scope, loss_good, loss_bad] = outages;
  visit(RadioField{.key = "mean_outage_s", .high = 1e6, .is_factor = true}, mean_outage_s);
  visit(RadioField{.key = "outage_model", .words = kOutageModels}, outage_model);
  visit(RadioField{.key = "outage_shape", .low = 1.05, .high = 100.0}, outage_shape);
  visit(RadioField{.key = "outage_scope", .words = kOutageScopes}, outage_scope);
  visit(RadioField{.key = "loss_good"}, loss_good);
  visit(RadioField{.key = "loss_bad"}, loss_bad);
  auto& [min_share, median_share, tail_shape, cap_share] = delay_tail;
  visit(RadioField{.key = "delay_min_share"}, min_share);
  visit(RadioField{.key = "delay_median_share"}, median_share);
  visit(RadioField{.key = "delay_tail_shape", .low = 0.1, .high = 100.0}, tail_shape);
  visit(RadioField{.key = "delay_cap_share", .high = 1e6}, cap_share);
  visit(RadioField{.key = "asymmetry"}, asymmetry);
  visit(RadioField{.key = "duplicates"}, duplicates);
  auto& [ap_spacing_m, roaming_at_crossing, roaming_border_m, roaming_min_s, roaming_max_s, roaming_gap_s] = places;
  visit(RadioField{.key = "ap_spacing_m", .low = 1.0, .high = 1e6}, ap_spacing_m);
  visit(RadioField{.key = "roaming_at_crossing"}, roaming_at_crossing);
  visit(RadioField{.key = "roaming_border_m", .high = 1e6}, roaming_border_m);
  visit(RadioField{.key = "roaming_min_s", .low = 0.001, .high = 3600.0}, roaming_min_s);
  visit(RadioField{.key = "roaming_max_s", .low = 0.001, .high = 3600.0}, roaming_max_s);
  visit(RadioField{.key = "roaming_gap_s", .high = 1e6}, roaming_gap_s);
  auto& [interference, contention_window] = contention;
  visit(RadioField{.key = "interference"}, interference);
  visit(RadioField{.key = "contention_window", .high = 1023.0}, contention_window);
}

// The same for an external source, all of them numbers.
template <class Source, class Visit>
void for_each_source_field(Source& source, Visit visit) {
  auto& [x_m, y_m, range_m, mean_on_s, mean_off_s, loss] = source;
  visit(RadioField{.key = "x_m", .low = -1e9, .high = 1e9}, x_m);
  visit(RadioField{.key = "y_m", .low = -1e9, .high = 1e9}, y_m);
  visit(RadioField{.key = "range_m", .high = 1e9, .above_low = true}, range_m);
  visit(RadioField{.key = "mean_on_s", .low = 0.001, .high = 1e6}, mean_on_s);
  visit(RadioField{.key = "mean_off_s", .high = 1e6}, mean_off_s);
  visit(RadioField{.key = "loss"}, loss);
}

// What is wrong with a field (its key, "sources/0/loss" or "trace/7"), one entry for each.
struct RadioFault {
  std::string key, sentence;
};
std::vector<RadioFault> radio_faults(const RadioSetup& radio);

}  // namespace fleetproof
