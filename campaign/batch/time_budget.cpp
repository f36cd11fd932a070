#include "campaign/batch/time_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

constexpr long kLongestBudget_s = 1'000'000'000;

// The whole number at the beginning of `text`, which it takes away; none if there is no digit, or if it is above
// kLongestBudget_s.
std::optional<long> take_number(std::string_view& text) {
  long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || value < 0 || value > kLongestBudget_s) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::optional<long> seconds_of(std::string_view text) {
  long total = 0;
  std::string_view units = "hms";  // each at most once, in this order
  while (!text.empty()) {
    const auto number = take_number(text);
    if (!number) return std::nullopt;
    const char unit = text.empty() ? 's' : text.front();
    const auto place = units.find(unit);
    if (place == std::string_view::npos) return std::nullopt;
    total += *number * (unit == 'h' ? 3600 : unit == 'm' ? 60 : 1);
    units.remove_prefix(place + 1);
    text.remove_prefix(std::min<std::size_t>(1, text.size()));
  }
  return total;
}

std::optional<std::vector<long>> clock_of(std::string_view text) {
  std::vector<long> parts;
  for (;;) {
    const auto number = take_number(text);
    if (!number) return std::nullopt;
    parts.push_back(*number);
    if (text.empty()) break;
    if (text.front() != ':' || parts.size() == 3) return std::nullopt;
    text.remove_prefix(1);
  }
  if (parts.size() < 2 || parts[0] > 23 || parts[1] > 59 || (parts.size() == 3 && parts[2] > 59)) return std::nullopt;
  parts.resize(3, 0);
  return parts;
}

}  // namespace

std::chrono::seconds duration_of(const std::string& text, const std::string& where) {
  const auto seconds = seconds_of(text);
  if (!seconds || *seconds < 1 || *seconds > kLongestBudget_s) {
    throw InputError(
        where, fmt::format("{} is no duration of at least 1 s; write it as in 90, 45m or 5h30m", in_quotes(text)));
  }
  return std::chrono::seconds(*seconds);
}

std::string duration_text(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{}s", whole);
  if (whole < 3600) return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  const auto minutes = std::lround(seconds / 60.0);
  return fmt::format("{}h{:02}m", minutes / 60, minutes % 60);
}

std::chrono::seconds time_until(const std::string& text, std::time_t now, const std::string& where) {
  const auto clock = clock_of(text);
  if (!clock) throw InputError(where, fmt::format("{} is no time of day; write it as in 06:00", in_quotes(text)));
  std::tm day{};
  localtime_r(&now, &day);
  day.tm_hour = static_cast<int>((*clock)[0]);
  day.tm_min = static_cast<int>((*clock)[1]);
  day.tm_sec = static_cast<int>((*clock)[2]);
  day.tm_isdst = -1;
  std::time_t then = std::mktime(&day);
  if (then <= now) {
    ++day.tm_mday;
    day.tm_isdst = -1;
    then = std::mktime(&day);
  }
  return std::chrono::seconds(std::max<std::time_t>(1, then - now));
}

}  // namespace fleetproof
