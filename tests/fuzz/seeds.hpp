#pragma once

#include <string>
#include <vector>

// Files to begin with, one function for each reader: small ones with every feature, and those of the tests.
namespace fleetproof::fuzz {

std::string source_file(const std::string& relative);  // its path

std::vector<std::string> opentcs_seeds();
std::vector<std::string> lif_seeds();
std::vector<std::string> rmf_building_seeds();
std::vector<std::string> rmf_nav_graph_seeds();
std::vector<std::string> geojson_seeds();
std::vector<std::string> smap_seeds();
std::vector<std::string> mqtt_seeds();
std::vector<std::string> mqtt_disk_seeds();
std::vector<std::string> grid_map_seeds();
std::vector<std::string> csv_layout_seeds();
std::vector<std::string> layout_seeds();
std::vector<std::string> scenario_seeds();
std::vector<std::string> factsheet_seeds();
std::vector<std::string> opentcs_vehicle_seeds();
std::vector<std::string> radio_trace_seeds();
std::vector<std::string> order_seeds();
std::vector<std::string> vda5050_seeds();
std::vector<std::string> campaign_seeds();

}  // namespace fleetproof::fuzz
