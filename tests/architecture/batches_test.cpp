// The sources of a room are compiled together, in batches: what is local to a source has a name of its own in its room.
// So a batch compiles whichever sources it has, and a new source breaks no other one.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

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

std::string room_of(const std::string& path) { return path.substr(0, path.find('/')); }

std::vector<std::string> used_twice(const std::vector<Source>& files) {
  std::map<std::string, std::string> first;  // room and name
  std::vector<std::string> found;
  for (const Source& source : files) {
    if (source.path.starts_with("tests/") || !source.path.ends_with(".cpp")) continue;
    for (const std::string& name : local_names(source)) {
      const auto [at, fresh] = first.emplace(room_of(source.path) + " " + name, source.path);
      if (!fresh && at->second != source.path) found.push_back(name + " in " + at->second + " and in " + source.path);
    }
  }
  return found;
}

// The types and constants of a header that every source can name which sees the header.
std::vector<std::string> shared_names(const Source& header) {
  static const std::regex pattern(R"(\b(k[A-Z]\w*)(\[\w*\])?( =|\{))");
  std::vector<std::string> found;
  for (const NamedType& type : outline_of(header.lines).types) found.push_back(type.name);
  for (const std::string& line : header.lines) {
    if (!line.starts_with("inline constexpr ")) continue;
    for (std::sregex_iterator match(line.begin(), line.end(), pattern), end; match != end; ++match)
      found.push_back("fleetproof::" + (*match)[1].str());
  }
  return found;
}

// The headers that the files include, and those that these include.
std::set<const Source*> headers_of(const std::vector<const Source*>& files,
                                   const std::map<std::string, const Source*>& by_path) {
  std::set<const Source*> seen;
  std::vector<const Source*> left = files;
  while (!left.empty()) {
    const Source& file = *left.back();
    left.pop_back();
    if (!seen.insert(&file).second) continue;
    for (const std::string& line : file.lines) {
      if (!line.starts_with("#include \"")) continue;
      const auto found = by_path.find(line.substr(10, line.rfind('"') - 10));
      if (found != by_path.end()) left.push_back(found->second);
    }
  }
  std::erase_if(seen, [](const Source* file) { return !file->is_header(); });
  return seen;
}

// The name by which its own source knows it: "fleetproof::A" for "fleetproof::::A" and for "A".
std::string without_anonymous(const std::string& name) {
  const auto anonymous = name.find("::::");
  if (anonymous != std::string::npos) return name.substr(0, anonymous) + name.substr(anonymous + 2);
  return name.starts_with("fleetproof::") ? name : "fleetproof::" + name;
}

// A local name that is also the name of something in a header: in a batch with a source that includes the header, it
// means two things.
std::vector<std::string> hides_a_shared_name(const std::vector<Source>& files) {
  std::map<std::string, const Source*> by_path;
  std::map<std::string, std::vector<const Source*>> rooms;
  for (const Source& source : files) {
    if (source.path.starts_with("tests/")) continue;
    by_path[source.path] = &source;
    rooms[room_of(source.path)].push_back(&source);
  }
  std::vector<std::string> found;
  for (const auto& [room, members] : rooms) {
    std::map<std::string, std::string> shared;
    for (const Source* header : headers_of(members, by_path)) {
      for (const std::string& name : shared_names(*header)) shared.emplace(name, header->path);
    }
    for (const Source* source : members) {
      if (source->is_header()) continue;
      for (const std::string& name : local_names(*source)) {
        const auto at = shared.find(without_anonymous(name));
        if (at != shared.end()) found.push_back(name + " in " + source->path + " and in " + at->second);
      }
    }
  }
  return found;
}

TEST(Batches, LocalNamesAreUniqueInTheirRoom) { EXPECT_EQ(used_twice(sources()), std::vector<std::string>{}); }

TEST(Batches, ALocalNameIsNoNameOfAHeaderInReach) {
  EXPECT_EQ(hides_a_shared_name(sources()), std::vector<std::string>{});
}

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
    return used_twice({one, {"core/base/b.cpp", lines}, {"laws/b.cpp", lines}}).size();
  };
  EXPECT_EQ(find({"namespace {", "constexpr double kA = 1;", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "constexpr double kD = 1, kB = 2;", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "class C {", "};", "}"}), 1U);
  EXPECT_EQ(find({"namespace {", "constexpr double kD = kA;", "}"}), 0U);
  EXPECT_EQ(find({"void f() {", "  constexpr double kA = 1;", "}"}), 0U);
}

TEST(BatchesFind, ALocalNameOfAHeaderInReach) {
  const Source header{"core/base/a.hpp",
                      {"namespace fleetproof {", "inline constexpr int kA = 1;", "struct C {", "};", "}"}};
  const auto find = [&](const std::vector<std::string>& lines, const std::string& include) {
    return hides_a_shared_name({header, {"laws/a.cpp", lines}, {"laws/b.cpp", {"#include \"" + include + "\""}}})
        .size();
  };
  const std::vector<std::string> type{
      "namespace fleetproof {", "namespace {", "struct C {", "};", "}  // namespace", "}"};
  const std::vector<std::string> constant{"namespace fleetproof {", "namespace {", "constexpr int kA = 2;",
                                          "}  // namespace", "}"};
  EXPECT_EQ(find(type, "core/base/a.hpp"), 1U);
  EXPECT_EQ(find(constant, "core/base/a.hpp"), 1U);
  EXPECT_EQ(find(type, "core/base/b.hpp"), 0U);
  EXPECT_EQ(
      find({"namespace fleetproof {", "namespace {", "struct D {", "};", "}  // namespace", "}"}, "core/base/a.hpp"),
      0U);
}

}  // namespace
}  // namespace fleetproof::architecture::batches_test
