// Names of topics, and filters with wildcards.
#pragma once

#include <string>
#include <string_view>

namespace fleetproof::mqtt {

// Well-formed UTF-8 without U+0000, as all texts of MQTT are.
bool is_mqtt_text(std::string_view text);
// A text for a topic: not empty, without wildcards.
bool is_topic(std::string_view text);
// "a/+/b", "a/#": not empty, + alone in its level, # alone in the last one.
bool is_filter(std::string_view text);
// Of the server's own, as $SYS: wildcards at the beginning do not match them.
inline bool is_of_server(std::string_view topic) { return topic.starts_with('$'); }
// Requires: is_filter, is_topic.
bool matches(std::string_view filter, std::string_view topic);

// For messages to people: what is no printable ASCII is a question mark, and long texts are cut.
std::string printable(std::string_view text);

}  // namespace fleetproof::mqtt
