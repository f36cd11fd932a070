#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

// What differs between the versions of VDA 5050, as data.
namespace fleetproof::bridges::vda5050 {

struct Version {
  std::string_view number;        // as every message says it: "2.1.0"
  std::string_view topic_prefix;  // "uagv/v2"
  // Fields that other versions have and this one has not, as "edge.corridor". They are neither written nor read.
  std::span<const std::string_view> absent_fields;

  bool has(std::string_view field) const;
};

// All versions that are built in, the oldest first.
std::span<const Version> versions();
// "2.0" or "2.0.0"; null if there is no such version.
const Version* find_version(std::string_view number);

enum class Topic : std::uint8_t { Order, InstantActions, State, Connection, Factsheet, Visualization };

std::string_view topic_word(Topic topic);  // "instantActions"

// Whether the standard allows this text as a level of a topic (6.3).
bool is_topic_level(std::string_view text);

// "uagv/v2/fleetproof/agv2/order".
std::string topic_name(const Version& version, std::string_view manufacturer, std::string_view serial_number,
                       Topic topic);

// ISO 8601 in UTC with hundredths of a second, which are cut off: "2026-01-01T00:00:03.12Z".
std::string timestamp_of(std::int64_t unix_seconds_at_zero, std::int64_t now_ns);

}  // namespace fleetproof::bridges::vda5050
