#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

// JSON as text, for plans, logs, pages and verbs: the library's parser and writer are compiled once. Files of people
// are read by generators/text/json_value.hpp, which knows the line of each value.
namespace fleetproof {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they were written
using SortedJson = nlohmann::json;    // keys in the order of the alphabet: equal content has equal text

// On one line if `indent` is negative, else a line a value. Bytes that are no UTF-8 become U+FFFD.
std::string json_text(const Json& json, int indent = -1);
std::string json_text(const SortedJson& json);

// The text that a person or another program reads: on several lines, and safe for a terminal (printable_json).
std::string shown_json(const Json& json);

// Discarded (is_discarded()) if the text is no JSON.
Json read_json(std::string_view text);
SortedJson read_sorted_json(std::string_view text);

}  // namespace fleetproof
