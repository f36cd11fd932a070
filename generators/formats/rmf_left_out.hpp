#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace fleetproof {

class YamlText;

// What of an Open-RMF level was read: vertices and lanes by their places in their lists.
struct ReadLevel {
  std::string name{};
  bool is_nav_graph = false, by_fiducials = false;  // by_fiducials: they say how large a pixel is
  std::set<std::size_t> vertices;
  std::map<std::size_t, std::string> lanes;  // with the names of their segments
  std::set<std::size_t> lanes_of_no_length;  // their ends are one station
};

// Adds one sentence for each kind of thing in an Open-RMF building or nav graph that the import does not use: how many
// there are, and the names of the first. It knows what the import reads and names what it does not know. Of other
// levels and of lanes of other graphs nothing is told.
void note_left_out(const YamlText& yaml, const YAML::Node& root, const YAML::Node& level, const ReadLevel& read,
                   std::vector<std::string>& warnings);

}  // namespace fleetproof
