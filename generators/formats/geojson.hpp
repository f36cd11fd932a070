#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// What to read of a route graph.
struct GeojsonChoice : ReadChoice {
  std::int64_t graph_idx = 0;  // of lanes of Open-RMF, where a file has several graphs
};

// Reads a route graph in GeoJSON, as the route server of Nav2 and the sites of Open-RMF have it. Points with an id
// become stations, lines between two of them one-way segments, as they are drawn, with an arc round each corner. A line
// names its points (startid and endid, start_node and end_node, from and to, source and target), or begins and ends at
// them. Coordinates are metres, degrees of longitude and latitude, or those of Web Mercator far from its origin: the
// last two become metres from the corner of the plant.
//
// `warnings` receives one sentence, with file and line, for everything that was left out, guessed or changed. Throws
// InputError with file, line, field, value and remedy if no AGV can drive on the graph.
Layout read_geojson(const std::string& path, std::vector<std::string>& warnings, const GeojsonChoice& choice = {});
Layout parse_geojson(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                     const GeojsonChoice& choice = {});

}  // namespace fleetproof
