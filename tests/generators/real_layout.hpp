#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "independent_check.hpp"

namespace fleetproof::independent {

// Other projects' layouts lie outside the tree. A test that needs one skips if it is absent.
inline std::string real_layout(const std::string& name) {
  const char* folder = std::getenv("FLEETPROOF_LAYOUTS");
  return std::string(folder != nullptr ? folder : "$FLEETPROOF_LAYOUTS") + "/" + name;
}

// Lanes: a bidirectional segment has two.
inline std::size_t directed(const Layout& layout) {
  std::size_t count = 0;
  for (const auto& segment : layout.segments) count += segment.bidirectional ? 2 : 1;
  return count;
}

}  // namespace fleetproof::independent

#define FLEETPROOF_SKIP_IF_ABSENT(path) \
  if (!std::filesystem::exists(path))   \
  GTEST_SKIP() << path << " is absent; set FLEETPROOF_LAYOUTS to the folder of real layouts"
