#include "core/base/json_text.hpp"

#include <nlohmann/json.hpp>

#include "core/base/outside_text.hpp"

namespace fleetproof {

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string json_text(const SortedJson& json) {
  return json.dump(-1, ' ', false, SortedJson::error_handler_t::replace);
}

std::string shown_json(const Json& json) { return printable_json(json_text(json, 2)) + "\n"; }

Json read_json(std::string_view text) { return Json::parse(text, nullptr, false); }

SortedJson read_sorted_json(std::string_view text) { return SortedJson::parse(text, nullptr, false); }

}  // namespace fleetproof
