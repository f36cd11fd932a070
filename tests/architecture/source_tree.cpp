#include "tests/architecture/source_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fleetproof::architecture {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolders[] = {"core", "campaign", "generators", "laws", "storage", "reports", "tests"};

Source read(const fs::path& path, const fs::path& root) {
  Source source{fs::relative(path, root).generic_string(), {}};
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) source.lines.push_back(line);
  return source;
}

bool ends_like(const fs::path& path, std::initializer_list<const char*> extensions) {
  return std::ranges::find(extensions, path.extension().string()) != extensions.end();
}

// Scripts have no extension.
bool is_other_text(const fs::path& path) {
  return ends_like(path, {".md", ".txt", ".cmake", ".toml", ".js", ".css", ".html", ""}) &&
         path.filename() != "LICENSE";
}

template <class Wanted>
std::vector<Source> read_all(Wanted wanted) {
  const fs::path root = FLEETPROOF_SOURCE_DIR;
  std::vector<Source> found;
  for (const char* folder : kFolders) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.is_regular_file() && wanted(entry.path())) found.push_back(read(entry.path(), root));
    }
  }
  std::ranges::sort(found, {}, &Source::path);
  return found;
}

}  // namespace

const std::vector<Source>& sources() {
  static const std::vector<Source> all = read_all([](const fs::path& path) {
    return ends_like(path, {".cpp", ".hpp", ".h", ".c"});
  });
  return all;
}

const std::vector<Source>& other_texts() {
  static const std::vector<Source> all = [] {
    const fs::path root = FLEETPROOF_SOURCE_DIR;
    std::vector<Source> found = read_all(is_other_text);
    for (const char* file :
         {"README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CMakeLists.txt", "get-started", ".ci/run"})
      found.push_back(read(root / file, root));
    return found;
  }();
  return all;
}

void expect_none(const std::vector<Source>& files, const Check& check) {
  std::ostringstream list;
  for (const Source& file : files) {
    for (const std::string& finding : check(file)) list << "\n  " << finding;
  }
  EXPECT_EQ(list.str(), "");
}

}  // namespace fleetproof::architecture
