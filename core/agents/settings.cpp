#include "core/agents/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

namespace fleetproof::agents {
namespace {

double number_in(std::string_view word, std::string_view value, double most) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc{} || end != value.data() + value.size() || !(number >= 0.0 && number <= most)) {
    throw std::invalid_argument("\"" + std::string(word) +
                                "\" in the agent's configuration is not a number from 0 to " + std::to_string(most));
  }
  return number;
}

}  // namespace

Settings read_settings(const char* config) {
  constexpr std::string_view kBlanks = " \t\r\n";
  Settings settings;
  std::string_view rest(config);
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    if (rest.empty()) return settings;
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view key = word.substr(0, equals), value = word.substr(equals + 1);
    if (key == "position_error_m") settings.position_error_m = number_in(word, value, 100.0);
    if (key == "position_late_s") settings.position_late_s = number_in(word, value, 3600.0);
    if (key == "charge_below") settings.charge_below = number_in(word, value, 1.0);
    if (key == "charge_to") settings.charge_to = number_in(word, value, 1.0);
    if (key == "zones_from") settings.zones_from = number_in(word, value, 1e6);
  }
}

}  // namespace fleetproof::agents
