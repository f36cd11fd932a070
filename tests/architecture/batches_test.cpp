// The sources of a folder are compiled together, in batches: what is local to a source has a name of its own in its
// folder. So a batch compiles whichever sources it has, and a new source breaks no other one.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>

#include "tests/architecture/source_outline.hpp"
#include "tests/architecture/source_tree.hpp"

namespace fleetproof::architecture::batches_test {
namespace {

// The types and constants in anonymous namespaces. A function that is defined twice does not compile in one batch; two
// that differ in their parameters may share a name.
std::vector<std::string> local_names(const Source& source) {
  static const std::regex pattern(R"(\b(k[A-Z]\w*)(\[\w*\])?( =|\{))");
  std::vector<std::string> found;
  for (const NamedType& type : outline_of(source.lines).types) {
    if (type.local) found.push_back(type.name);
  }
  bool local = false;
  for (const std::string& line : source.lines) {
    if (line == "namespace {") local = true;
    if (line.starts_with("}  // namespace")) local = false;
    if (!local || !(line.starts_with("constexpr ") || line.starts_with("const "))) continue;
    for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match)
      found.push_back((*match)[1]);
  }
  return found;
}

std::vector<std::string> used_twice(const std::vector<Source>& files) {
  std::map<std::string, std::string> first;  // folder and name
  std::vector<std::string> found;
  for (const Source& source : files) {
    if (source.path.starts_with("tests/") || !source.path.ends_with(".cpp")) continue;
    const std::string folder = std::filesystem::path(source.path).parent_path().generic_string();
    for (const std::string& name : local_names(source)) {
      const auto [at, fresh] = first.emplace(folder + " " + name, source.path);
      if (!fresh && at->second != source.path) found.push_back(name + " in " + at->second + " and in " + source.path);
    }
  }
  return found;
}

TEST(Batches, LocalNamesAreUniqueInTheirFolder) { EXPECT_EQ(used_twice(sources()), std::vector<std::string>{}); }

// Tests share many short names: each of their files has a namespace of its own.
TEST(Batches, ATestFileHasANamespaceOfItsOwn) {
  expect_none(sources(), [](const Source& source) -> std::vector<std::string> {
    if (!source.path.starts_with("tests/") || !source.path.ends_with("_test.cpp")) return {};
    const std::string name = std::filesystem::path(source.path).stem().string();
    for (const std::string& line : source.lines) {
      if (line.starts_with("namespace fleetproof") && line.ends_with("::" + name + " {")) return {};
    }
    return {source.path + " has no namespace " + name};
  });
}

TEST(BatchesFind, ANameOfTwoSources) {
  const auto find = [](const std::vector<std::string>& lines) {
    const Source one{"core/base/a.cpp",
                     {"namespace {", "constexpr int kA = 1, kB[2] = {1, 2};", "struct C {", "};", "}"}};
    return used_twice({one, {"core/base/b.cpp", lines}, {"core/motion/b.cpp", lines}}).size();
  };
  EXPECT_EQ(find({"namespace {", "constexpr double kA = 1;", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "constexpr double kD = 1, kB = 2;", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "class C {", "};", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "constexpr double kD = kA;", "}"}), 0U);
  EXPECT_EQ(find({"void f() {", "  constexpr double kA = 1;", "}"}), 0U);
}

}  // namespace
}  // namespace fleetproof::architecture::batches_test
