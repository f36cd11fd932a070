#pragma once

#include <string>
#include <vector>

#include "core/scenario/layout.hpp"

namespace pugi {
class xml_node;
}

namespace fleetproof {

class XmlText;

// Reads the velocities of an openTCS plant model. They say in which directions each path is driven, and how fast.
class OpenTcsSpeeds {
 public:
  // Requires: the text outlives the object.
  explicit OpenTcsSpeeds(const XmlText& xml) : xml_(xml) {}

  // A path is driven forward from source to destination, and backward from destination to source, each unless its
  // velocity is 0. False if both are. A velocity above that of every vehicle is no limit. A path without maxVelocity is
  // driven forward without a limit, although openTCS itself would take the missing number for 0.
  bool say_travel(const pugi::xml_node& path, Segment& segment);

  // What is odd about the velocities: the paths without one, those whose velocity is no limit, and those that take very
  // long.
  // Requires: the curves of the layout are sound.
  std::vector<std::string> sentences(const Layout& layout) const;

 private:
  const XmlText& xml_;
  std::vector<std::string> silent_, unlimited_;  // names of paths without a velocity, and with one that is no limit
};

}  // namespace fleetproof
