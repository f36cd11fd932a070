// The seeded faults of this folder still fit the sources: what a patch removes or keeps stands there, once.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace fleetproof::patches_test {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

Lines lines_of(const fs::path& path) {
  Lines lines;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Hunk {
  std::string file;
  Lines before, after;
};

std::vector<Hunk> hunks_of(const Lines& patch) {
  std::vector<Hunk> hunks;
  std::string file;
  for (const std::string& line : patch) {
    if (line.starts_with("--- a/")) {
      file = line.substr(6);
    } else if (line.starts_with("@@")) {
      hunks.push_back({file, {}, {}});
    } else if (!hunks.empty() && !line.empty() && !line.starts_with("+++")) {
      if (line[0] != '+') hunks.back().before.push_back(line.substr(1));
      if (line[0] != '-') hunks.back().after.push_back(line.substr(1));
    }
  }
  return hunks;
}

std::ptrdiff_t occurrences(const Lines& text, const Lines& part) {
  std::ptrdiff_t count = 0;
  for (auto at = text.begin(); (at = std::search(at, text.end(), part.begin(), part.end())) != text.end(); ++at)
    ++count;
  return count;
}

TEST(SeededFaults, StillFitTheSources) {
  const fs::path root = FLEETPROOF_SOURCE_DIR;
  int patches = 0;
  for (const auto& entry : fs::directory_iterator(root / "tests" / "mutations")) {
    if (entry.path().extension() != ".patch") continue;
    ++patches;
    const Lines patch = lines_of(entry.path());
    const auto hunks = hunks_of(patch);
    EXPECT_FALSE(hunks.empty()) << entry.path();
    EXPECT_TRUE(!patch.empty() && patch[0].ends_with('.')) << entry.path() << " says in its first line what is wrong";
    for (const Hunk& hunk : hunks) {
      EXPECT_TRUE(hunk.file.ends_with(".cpp")) << entry.path();
      EXPECT_NE(hunk.before, hunk.after) << entry.path();
      EXPECT_EQ(occurrences(lines_of(root / hunk.file), hunk.before), 1)
          << entry.path() << " no longer fits " << hunk.file << ": make it anew";
    }
  }
  EXPECT_GE(patches, 15);
}

}  // namespace
}  // namespace fleetproof::patches_test
