#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace fleetproof {

class YamlText;

// The value of an attribute of an Open-RMF vertex or lane: the building file says [type, value] where the nav graph
// says value. Undefined if the attribute does not exist, or if `words` are no map of attributes.
YAML::Node parameter(const YAML::Node& words, const char* word);

// Empty if there is no such attribute.
std::string text_of(const YAML::Node& words, const char* word);

// Whether the attribute names something, such as the dispenser at a vertex. A word for false names nothing.
bool names_something(const YAML::Node& words, const char* word);

// The attributes of a vertex, lane or measurement: its last item, if that is a map; else undefined. An item after them,
// or in their place, is refused: it would hide them. `most`: items of a whole list, which `what` shows.
YAML::Node attributes_of(const YamlText& yaml, const YAML::Node& list, std::size_t most, std::string_view what);

// The name of a vertex in the file; empty if it has none.
std::string given_name(const YAML::Node& vertex, bool is_nav_graph);

}  // namespace fleetproof
