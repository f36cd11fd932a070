// Every path that a page or a comment names exists.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::pages_test {
namespace {

namespace fs = std::filesystem;

using Findings = std::vector<std::string>;

constexpr std::array kTopFolders = {"campaign", "core", "generators", "laws", "reports", "storage", "tests", ".ci"};

// All files and folders, each under every ending of its path: "core/base/words.hpp", "base/words.hpp", "words.hpp".
const std::set<std::string>& known_paths() {
  static const std::set<std::string> known = [] {
    const fs::path root = FLEETPROOF_SOURCE_DIR;
    std::set<std::string> found;
    const auto add = [&](const fs::path& path) {
      std::string rest = fs::relative(path, root).generic_string();
      found.insert(rest);
      for (auto slash = rest.find('/'); slash != std::string::npos; slash = rest.find('/')) {
        rest.erase(0, slash + 1);
        found.insert(rest);
      }
    };
    for (const auto& entry : fs::directory_iterator(root)) add(entry.path());
    for (const char* folder : kTopFolders) {
      for (const auto& entry : fs::recursive_directory_iterator(root / folder)) add(entry.path());
    }
    return found;
  }();
  return known;
}

// A word in capitals stands for a name that the reader chooses, as in NAME_test.cpp.
bool has_placeholder(const std::string& path) {
  static const std::regex capitals("(^|[^A-Za-z])[A-Z]+([^A-Za-z]|$)");
  return std::regex_search(path, capitals) && !path.ends_with("README.md") && !path.ends_with("CHANGELOG.md") &&
         !path.ends_with("ARCHITECTURE.md");
}

// Files that are no part of the tree, each with the reason.
const std::map<std::string, std::string> kElsewhere = {{"report.md", "what ./get-started leaves"},
                                                       {"Python.h", "what Python installs"}};

bool is_path(const std::string& word) {
  if (word.starts_with('.') && !word.starts_with(".ci/")) return false;  // an ending
  if (word.find('*') != std::string::npos) return false;                 // stands for many
  const bool below_top = std::ranges::any_of(
      kTopFolders, [&](const std::string& top) { return word.starts_with(top + "/") && word.size() > top.size() + 1; });
  const bool source = std::ranges::any_of(std::array{".hpp", ".cpp", ".h", ".md", ".cmake"},
                                          [&](const char* ending) { return word.ends_with(ending); });
  return (below_top || source) && !has_placeholder(word) && !kElsewhere.contains(word) && !word.starts_with("build/");
}

// Of a page all of it; of a source the comments.
std::string prose_of(const std::string& line, bool page) {
  if (page) return line;
  const auto comment = line.find("//");
  const bool in_text =
      std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(std::min(comment, line.size())), '"') % 2 !=
      0;
  return comment == std::string::npos || in_text ? "" : line.substr(comment + 2);
}

Findings missing_paths(const Source& source) {
  static const std::regex pattern(R"([A-Za-z0-9_./*-]+)");
  const bool page = source.path.ends_with(".md");
  Findings found;
  if (source.path == "CHANGELOG.md") return found;  // it tells of what was
  for (std::size_t i = 0; i < source.lines.size(); ++i) {
    const std::string prose = prose_of(source.lines[i], page);
    for (std::sregex_iterator word(prose.begin(), prose.end(), pattern), end; word != end; ++word) {
      std::string path = word->str();
      while (path.starts_with("../")) path.erase(0, 3);
      while (path.ends_with('.') || path.ends_with('/')) path.pop_back();
      if (is_path(path) && !known_paths().contains(path))
        found.push_back(source.path + ":" + std::to_string(i + 1) + " names " + path + ", which does not exist");
    }
  }
  return found;
}

TEST(Pages, NameOnlyPathsThatExist) {
  std::vector<Source> pages;
  std::ranges::copy_if(other_texts(), std::back_inserter(pages),
                       [](const Source& text) { return text.path.ends_with(".md"); });
  EXPECT_GT(pages.size(), 30U);
  expect_none(pages, missing_paths);
}

TEST(Pages, CommentsNameOnlyPathsThatExist) { expect_none(sources(), missing_paths); }

TEST(PagesFind, APathThatDoesNotExist) {
  const auto find = [](const std::string& line) { return missing_paths({"core/README.md", {line}}).size(); };
  EXPECT_EQ(find("see `core/base/words.hpp`, base/words.hpp, words.hpp and ../tests/architecture."), 0U);
  EXPECT_EQ(find("`core/NAME.hpp`, `tests/core/PART_test.cpp`, `.cpp`, `build/default/words.hpp`, and/or"), 0U);
  EXPECT_EQ(find("see `core/base/wordz.hpp`"), 1U);
  EXPECT_EQ(find("see wordz.hpp."), 1U);
  EXPECT_EQ(find("see tests/campaigns/none.toml or core/none/"), 2U);
  EXPECT_EQ(missing_paths({"core/a.cpp", {"int a;  // see wordz.hpp", "f(\"a//wordz.hpp\"); g(wordz.hpp);"}}).size(),
            1U);
}

}  // namespace
}  // namespace fleetproof::architecture::pages_test
