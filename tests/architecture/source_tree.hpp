#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fleetproof::architecture {

// A text file of the project.
struct Source {
  std::string path;  // from the project's root
  std::vector<std::string> lines;

  bool is_header() const { return path.ends_with(".hpp") || path.ends_with(".h"); }
};

// Every C and C++ source of the project; read once.
const std::vector<Source>& sources();

// Pages, build files, campaigns and scripts: what is written by hand besides sources.
const std::vector<Source>& other_texts();

// A check returns a sentence for everything that it finds wrong in a file.
using Check = std::function<std::vector<std::string>(const Source&)>;

// Fails the current test with all that the check finds in the files.
void expect_none(const std::vector<Source>& files, const Check& check);

}  // namespace fleetproof::architecture
