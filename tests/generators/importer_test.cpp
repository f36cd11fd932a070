#include "generators/formats/importer.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif_text.hpp"
#include "independent_check.hpp"

namespace fleetproof::importer_test {
namespace {

class ImporterTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("fleetproof-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
               std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    std::vector<std::string> warnings;
    crossdock_ = read_opentcs(independent::source_file("tests/layouts/crossdock.xml"), warnings);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) const {
    const auto path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  static Layout read(const std::string& path) {
    std::vector<std::string> warnings;
    return import_layout(path, {}, warnings);
  }

  static std::string refusal(const std::string& path) {
    try {
      read(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
  Layout crossdock_;
};

TEST_F(ImporterTest, TheExtensionChooses) {
  EXPECT_EQ(read(independent::source_file("tests/layouts/crossdock.xml")).segments.size(), 31U);
  EXPECT_EQ(read(file("a.lif.json", to_lif(crossdock_))).segments.size(), 31U);
  EXPECT_EQ(read(file("b.json", to_lif(crossdock_))).segments.size(), 31U);
  EXPECT_EQ(to_text(read(file("c.json", to_text(crossdock_)))), to_text(crossdock_));
  EXPECT_EQ(read(file("d.csv", to_csv(crossdock_))).segments.size(), 31U);
  EXPECT_EQ(read(file("e.map", "height 1\nwidth 3\nmap\n...\n")).segments.size(), 2U);
  const std::string nav_graph = "levels: {L1: {vertices: [[0, 0, {}], [4, 0, {}]], lanes: [[0, 1, {}]]}}\n";
  EXPECT_EQ(read(file("f.yaml", nav_graph)).segments.size(), 1U);
  EXPECT_EQ(read(file("g.yml", nav_graph)).segments.size(), 1U);
  EXPECT_EQ(read(file("D.CSV", to_csv(crossdock_))).segments.size(), 31U);
  EXPECT_EQ(read(file("A.LIF.json", to_lif(crossdock_))).segments.size(), 31U);
  const std::string graph = R"({"type": "FeatureCollection", "features": [
{"properties": {"id": 1}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
{"properties": {"id": 2}, "geometry": {"type": "Point", "coordinates": [4, 0]}},
{"properties": {"id": 3, "startid": 1, "endid": 2}, "geometry": {"type": "LineString", "coordinates": []}}]})";
  const std::string map =
      R"({"advancedPointList": [
{"instanceName": "a", "pos": {}}, {"instanceName": "b", "pos": {"x": 4}}],
"advancedCurveList": [
{"className": "StraightPath", "startPos": {"instanceName": "a"}, "endPos": {"instanceName": "b"}}]})";
  for (const char* name : {"k.geojson", "k.json"}) EXPECT_EQ(read(file(name, graph)).segments.size(), 1U) << name;
  for (const char* name : {"l.smap", "l.json"}) EXPECT_EQ(read(file(name, map)).segments.size(), 1U) << name;
  EXPECT_EQ(importer_of_file("PLANT.Xml"), "opentcs");
  EXPECT_EQ(importer_of_file(file("h.json", R"({"origins": [{"originId": "o", "layouts": []}]})")), "lif");
  EXPECT_EQ(importer_of_file(file("i.json", R"({"layouts": []})")), "lif");
}

TEST_F(ImporterTest, UnknownNamesAreExplained) {
  EXPECT_EQ(
      refusal("plant.dwg"),
      "plant.dwg: has no extension of a layout file; known: .xml .json .yaml .yml .geojson .smap .map .csv; or name "
      "its format (fleetproof import FORMAT FILE, in a campaign { file = ..., format = ... })");
  EXPECT_EQ(refusal("none.json"), "none.json: there is no such file");
  EXPECT_FALSE(is_layout_file("aisle-grid"));
  try {
    importer("opentsc");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "import: there is no importer \"opentsc\"; did you mean \"opentcs\"?");
  }
}

TEST_F(ImporterTest, JsonThatIsNoLayoutIsCalledNeitherLifNorOurs) {
  for (const char* text : {R"({"name": "app", "version": "1.0.0"})", "[1, 2]", "\"text\"", "{}"})
    EXPECT_THAT(refusal(file("package.json", text)),
                testing::HasSubstr("package.json: is JSON, but no layout: it has none of the keys"))
        << text;
  EXPECT_THAT(refusal(file("o.json", R"({"headerId": 1, "orderId": "a"})")), testing::HasSubstr("is a VDA 5050 order"));
}

TEST_F(ImporterTest, APackedFileOfAnyNameIsUnpackedFirst) {
  const std::string packed("\x1f\x8b\x08\x00", 4);
  for (const char* name : {"plant.csv.gz", "plant.gz", "plant.csv"})
    EXPECT_THAT(refusal(file(name, packed)), testing::HasSubstr("is packed with gzip; unpack it with gunzip"));
}

TEST_F(ImporterTest, SpeedLimitsInAnotherUnitAreQuestioned) {
  const auto warnings = [&](const std::string& limit) {
    std::vector<std::string> sentences;
    import_layout(
        file("s.csv", "id,x,y\na,0,0\nb,9,0\nfrom,to,bidirectional,speed_limit_mps\na,b,true," + limit + "\n"), {},
        sentences);
    return sentences;
  };
  EXPECT_THAT(warnings("2"), testing::Not(testing::Contains(testing::HasSubstr("speed limit"))));
  EXPECT_THAT(warnings("72"), testing::Contains(testing::HasSubstr(
                                  "1 segments have a speed limit above 10 m/s, the highest of 72 m/s at "
                                  "\"a-b\": is that in km/h or m/min?")));
}

TEST_F(ImporterTest, EveryImporterRefusesWhatIsNoLayout) {
  const auto empty = file("empty", ""), noise = file("noise", std::string("\x00\xff{[<a,\n:-", 10));
  for (const auto& entry : importers()) {
    std::vector<std::string> warnings;
    EXPECT_FALSE(entry.description.empty());
    EXPECT_THROW(entry.make(empty, {}, warnings), InputError) << entry.name;
    EXPECT_THROW(entry.make(noise, {}, warnings), InputError) << entry.name;
    EXPECT_THROW(entry.make("/nowhere/at.all", {}, warnings), InputError) << entry.name;
  }
}

}  // namespace
}  // namespace fleetproof::importer_test
