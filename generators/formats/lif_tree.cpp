#include "generators/formats/lif_tree.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

// A layout means something else without them, or nothing.
constexpr std::string_view kNeeded[] = {
    "layouts",    "nodes",      "nodeId",        "nodePosition",       "x",
    "y",          "edges",      "edgeId",        "startNodeId",        "endNodeId",
    "actionType", "knotVector", "controlPoints", "interactionNodeIds", "vehicleTypeId",
    "seriesName", "loaded",     "unloaded"};

bool says_nothing(const std::string& key, const JsonValue& value) {
  return value.shape == JsonValue::Shape::Scalar && std::holds_alternative<std::nullptr_t>(value.scalar) &&
         std::ranges::find(kNeeded, key) == std::end(kNeeded);
}

void drop_nulls(JsonValue& value) {
  std::vector<std::string> keys;
  std::vector<JsonValue> items;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    drop_nulls(value.items[i]);
    if (value.shape == JsonValue::Shape::Object) {
      if (says_nothing(value.keys[i], value.items[i])) continue;
      keys.push_back(std::move(value.keys[i]));
    }
    items.push_back(std::move(value.items[i]));
  }
  value.keys = std::move(keys);
  value.items = std::move(items);
}

}  // namespace

JsonValue parse_lif_tree(std::string_view text, std::string_view source) {
  auto root = parse_json(text, source);
  drop_nulls(root);
  return root;
}

}  // namespace fleetproof
