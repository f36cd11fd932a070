#include "core/bridges/vda5050/version.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace fleetproof::bridges::vda5050 {
namespace {

// Sorted.
constexpr std::array<std::string_view, 5> kAbsentIn2_0 = {"agvAction.blockingTypes", "edge.corridor", "error.errorHint",
                                                          "factsheet.vehicleConfig", "state.maps"};
constexpr std::array<Version, 2> kVersions = {{{"2.0.0", "uagv/v2", kAbsentIn2_0}, {"2.1.0", "uagv/v2", {}}}};
constexpr std::array<std::string_view, 6> kTopicWords = {"order",      "instantActions", "state",
                                                         "connection", "factsheet",      "visualization"};

struct CivilDate {
  std::int64_t year;
  unsigned month, day;
};

// The proleptic Gregorian calendar. Years begin in March, so that the leap day is the last day of its year.
CivilDate date_of(std::int64_t days_since_1970) {
  constexpr std::int64_t kDaysOf400Years = 146'097, kDaysTo1970 = 719'468;
  const std::int64_t days = days_since_1970 + kDaysTo1970;
  const std::int64_t era = (days >= 0 ? days : days - kDaysOf400Years + 1) / kDaysOf400Years;
  const auto day_of_era = static_cast<unsigned>(days - era * kDaysOf400Years);
  const unsigned year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36'524 - day_of_era / 146'096) / 365;
  const unsigned day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const unsigned month_from_march = (5 * day_of_year + 2) / 153;
  const unsigned day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
  const unsigned month = month_from_march < 10 ? month_from_march + 3 : month_from_march - 9;
  return {static_cast<std::int64_t>(year_of_era) + era * 400 + (month <= 2 ? 1 : 0), month, day};
}

std::int64_t floor_divided(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace

bool Version::has(std::string_view field) const { return !std::ranges::binary_search(absent_fields, field); }

std::span<const Version> versions() { return kVersions; }

const Version* find_version(std::string_view number) {
  const auto found = std::ranges::find_if(kVersions, [&](const Version& version) {
    return number == version.number || number == version.number.substr(0, version.number.rfind('.'));
  });
  return found == kVersions.end() ? nullptr : &*found;
}

std::string_view topic_word(Topic topic) { return kTopicWords[static_cast<std::size_t>(topic)]; }

bool is_topic_level(std::string_view text) {
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.:-";
  return !text.empty() && text.find_first_not_of(kAllowed) == std::string_view::npos;
}

std::string topic_name(const Version& version, std::string_view manufacturer, std::string_view serial_number,
                       Topic topic) {
  std::string name(version.topic_prefix);
  for (const std::string_view level : {manufacturer, serial_number, topic_word(topic)})
    name.append(1, '/').append(level);
  return name;
}

std::string timestamp_of(std::int64_t unix_seconds_at_zero, std::int64_t now_ns) {
  constexpr std::int64_t kNsPerHundredth = 10'000'000, kDay_s = 86'400;
  const std::int64_t hundredths = floor_divided(now_ns, kNsPerHundredth);
  const std::int64_t seconds = unix_seconds_at_zero + floor_divided(hundredths, 100);
  const std::int64_t days = floor_divided(seconds, kDay_s);
  const CivilDate date = date_of(days);
  const auto second = static_cast<int>(seconds - days * kDay_s);
  std::array<char, 64> text{};
  const int size =
      std::snprintf(text.data(), text.size(), "%04lld-%02u-%02uT%02d:%02d:%02d.%02dZ",
                    static_cast<long long>(date.year), date.month, date.day, second / 3600, second / 60 % 60,
                    second % 60, static_cast<int>(hundredths - floor_divided(hundredths, 100) * 100));
  return {text.data(), static_cast<std::size_t>(size)};
}

}  // namespace fleetproof::bridges::vda5050
