#pragma once

#include <string>

namespace YAML {
class Node;
}

namespace fleetproof {

class YamlText;

struct RmfScale {
  double m_per_pixel = 1.0;
  bool by_fiducials = false;
  std::string sentence{};  // if something else decides than the measurements of the level
};

// The scale of a level that is drawn on an image, as Open-RMF computes it. The measurements of the reference level
// decide (reference_level_name, or the first level), and for another level the distances of the fiducials that both
// have. A level that shares less than two fiducials has its own measurements here. Throws InputError at a measurement
// or fiducial that gives no scale.
RmfScale scale_of_level(const YamlText& yaml, const YAML::Node& root, const std::string& level);

}  // namespace fleetproof
