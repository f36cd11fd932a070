#pragma once

#include <string>
#include <vector>

namespace pugi {
class xml_node;
}

namespace fleetproof {

class XmlText;

// Adds one sentence for each kind of thing in a plant model that the import does not use: how many there are, and the
// names of the first. It knows what the import reads, by element and attribute, for all versions of plant models. It
// names what it does not know. So a file cannot contain an element or attribute that is dropped silently, unless its
// value is the one that says nothing (a height of 0, a heading of NaN). `takes_vehicles`: another reader takes the
// vehicles.
void note_left_out(const XmlText& xml, const pugi::xml_node& model, bool takes_vehicles,
                   std::vector<std::string>& warnings);

}  // namespace fleetproof
