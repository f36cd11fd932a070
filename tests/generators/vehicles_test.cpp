// The vehicles of plant models and factsheets, as tables of a campaign.
#include "generators/formats/vehicles.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "damage.hpp"
#include "generators/formats/factsheet.hpp"
#include "generators/formats/opentcs_vehicles.hpp"

namespace fleetproof::vehicles_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Fleet {
  std::string text, sentences;
};

Fleet import_model(const std::string& vehicles) {
  std::vector<std::string> warnings;
  const auto fleet = parse_opentcs_vehicles("<model version=\"7.0.0\">\n" + vehicles + "\n</model>", "m.xml", warnings);
  return {fleet_text(fleet, "m.xml"), fmt::format("{}", fmt::join(warnings, "\n"))};
}

Fleet import_sheet(const std::string& text) {
  std::vector<std::string> warnings;
  const auto vehicle = parse_factsheet(text, "f.json", warnings);
  return {fleet_text({vehicle}, "f.json"), fmt::format("{}", fmt::join(warnings, "\n"))};
}

std::string vehicle(const std::string& name, const std::string& box, const std::string& more = "") {
  return fmt::format("<vehicle name=\"{}\" maxVelocity=\"1500\" maxReverseVelocity=\"500\" {}>{}</vehicle>", name, more,
                     box);
}

const std::string kBox =
    R"(<boundingBox length="2100" width="900" height="1000" referenceOffsetX="-300" referenceOffsetY="0"/>)";

TEST(OpenTcsVehicles, HaveTheirBodiesAndVelocities) {
  const auto fleet = import_model(vehicle("Gabel &quot;1&quot;", kBox) + vehicle("林 2", kBox) +
                                  vehicle("tug", R"(<boundingBox length="3000" width="1000" height="1"/>)"));
  EXPECT_EQ(fleet.text,
            "# vehicles of m.xml\n\n[[vehicle]]\nname = \"Gabel \\\"1\\\"\"\nshare = 2  # Gabel \"1\", 林 2\n"
            "length_m = 2.1\nwidth_m = 0.9\ncentre_ahead_m = 0.3\nspeed_mps = 1.5\nreverse_speed_mps = 0.5\n"
            "\n[[vehicle]]\nname = \"tug\"\nlength_m = 3\nwidth_m = 1\nspeed_mps = 1.5\nreverse_speed_mps = 0.5\n");
}

TEST(OpenTcsVehicles, OfTwoLengthsThatOfTheBoxCounts) {
  const auto with = [](const char* length) { return import_model(vehicle("a", kBox, length)); };
  const auto differs = with("length=\"9000\"");
  EXPECT_THAT(differs.text, HasSubstr("length_m = 2.1\n"));
  EXPECT_THAT(differs.sentences,
              HasSubstr("1 vehicles have another length beside that of their bounding box (\"a\"); the box counts"));
  EXPECT_THAT(with("length=\"2100\"").sentences, Not(HasSubstr("another length")));
}

TEST(OpenTcsVehicles, SayWhatIsGuessedAndLeftOut) {
  const auto old =
      import_model(R"(<vehicle name="a" length="1000" maxVelocity="0" energyLevelGood="90" envelopeKey="e"/>)");
  EXPECT_EQ(old.text, "# vehicles of m.xml\n\n[[vehicle]]\nname = \"a\"\nlength_m = 1\n");
  EXPECT_THAT(old.sentences, AllOf(HasSubstr("m.xml:2: 1 vehicles have no width (\"a\")"),
                                   HasSubstr("1 vehicles have no velocity above 0 (\"a\")"),
                                   HasSubstr("1 vehicles cannot drive backward (\"a\")"),
                                   HasSubstr("1 vehicles have an envelope key (\"a\")"),
                                   HasSubstr("1 kinds of vehicle details are left out (\"energyLevelGood\")")));
  const auto aside =
      import_model(vehicle("b", R"(<boundingBox length="1" width="1" height="1" referenceOffsetY="5"/>)"));
  EXPECT_THAT(aside.sentences, HasSubstr("1 vehicles have their reference point beside their middle line (\"b\")"));
}

TEST(OpenTcsVehicles, AreRefusedWithTheirPlace) {
  EXPECT_EQ(independent::refusal(import_model, ""),
            "m.xml: has no <vehicle>; write the [[vehicle]] tables of the campaign by hand");
  EXPECT_THAT(independent::refusal(import_model, vehicle("a", R"(<boundingBox length="0" width="1"/>)")),
              HasSubstr("m.xml:2: length is 0 m; expected 1 to 100000 mm"));
  const auto two = vehicle("a", kBox) + vehicle("b", kBox);
  independent::bear_cuts(import_model, two, 100);
  independent::bear_damage(import_model, two, 300, "<>\"= -.0");
}

TEST(OpenTcsVehicles, EachMalformedValueHasOneError) {
  const auto with = [](const std::string& attributes, const std::string& box = "") {
    return independent::refusal(import_model, "<vehicle name=\"a\" " + attributes + ">" + box + "</vehicle>");
  };
  const std::string speeds = "expected 1 to 100000 mm/s, or 0";
  EXPECT_THAT(with("maxVelocity=\"-5\""), AllOf(HasSubstr("m.xml:2: maxVelocity is -0.005 m/s"), HasSubstr(speeds)));
  EXPECT_THAT(with("maxReverseVelocity=\"1e9\""),
              AllOf(HasSubstr("maxReverseVelocity is 1000000 m/s"), HasSubstr(speeds)));
  EXPECT_THAT(with("maxVelocity=\"NaN\""), HasSubstr("maxVelocity of <vehicle> is \"NaN\"; expected a finite number"));
  EXPECT_EQ(with("maxVelocity=\"\""), "accepted") << "an attribute without a text is none";
  EXPECT_THAT(with("length=\"1e308\""), HasSubstr("expected 1 to 100000 mm"));
  EXPECT_THAT(with("", "<boundingBox length=\"1000\" width=\"inf\"/>"), HasSubstr("width of <boundingBox> is \"inf\""));
  EXPECT_THAT(with("", "<boundingBox referenceOffsetX=\"200000\"/>"),
              HasSubstr("referenceOffsetX is 200 m; expected -100000 to 100000 mm"));
  EXPECT_THAT(with("", "<boundingBox referenceOffsetY=\"-1e200\"/>"), HasSubstr("referenceOffsetY is -1"));
  EXPECT_THAT(with("", "<boundingBox/>\n<boundingBox/>"), HasSubstr("m.xml:3: is the second boundingBox"));
  EXPECT_EQ(independent::refusal(import_model, vehicle("a", kBox) + "\n" + vehicle("a", "")),
            "m.xml:3: name \"a\" is there twice; rename one vehicle");
  EXPECT_THAT(independent::refusal(import_model, "<vehicle name=\"\"/>"), HasSubstr("name"));
  EXPECT_THAT(independent::refusal(import_model, "<vehicle/>"), HasSubstr("name"));
  EXPECT_THAT(independent::refusal(import_model, "<vehicle name=\"\xff\"/>"), HasSubstr("m.xml:2"));
}

const std::string kSheet = R"({"headerId": 1, "typeSpecification": {"seriesName": "Hauler 7", "agvClass": "TUGGER"},
"physicalParameters": {"speedMin": 0.1, "speedMax": 1.8, "accelerationMax": 0.6, "decelerationMax": 0.9, "width": 0.8,
"length": 2.0, "heightMax": 1}, "agvGeometry": {"envelopes2d": [{"set": "s", "polygonPoints": [{"x": -0.5, "y": -0.4},
{"x": 1.5, "y": -0.4}, {"x": 1.5, "y": 0.4}, {"x": -0.5, "y": 0.4}]}]}})";

TEST(Factsheet, IsAVehicle) {
  const auto fleet = import_sheet(kSheet);
  EXPECT_EQ(fleet.text,
            "# vehicles of f.json\n\n[[vehicle]]\nname = \"Hauler 7\"\nlength_m = 2\nwidth_m = 0.8\n"
            "centre_ahead_m = 0.5\nspeed_mps = 1.8\nacceleration_mps2 = 0.6\ndeceleration_mps2 = 0.9\n");
  EXPECT_THAT(fleet.sentences,
              AllOf(HasSubstr("f.json:2: gives no maximumAngularSpeed; turn_speed_radps stays 1"),
                    HasSubstr("5 parts of the factsheet are left out (\"headerId\", \"typeSpecification.agvClass\", "
                              "\"physicalParameters.speedMin\" and 2 more)")));
  EXPECT_THAT(fleet.sentences, testing::Not(HasSubstr("gives no envelope")));
}

TEST(Factsheet, WithoutAnEnvelopeSaysWhereTheBodyIsTakenToBe) {
  const std::string size = R"({"physicalParameters": {"length": 2, "width": 1})";
  const auto sentence = HasSubstr(
      "f.json:1: gives no envelope; the reference point is taken to be the middle of the body (centre_ahead_m 0)");
  EXPECT_THAT(import_sheet(size + "}").sentences, sentence);
  EXPECT_THAT(import_sheet(size + R"(, "agvGeometry": {"envelopes2d": []}})").sentences, sentence);
}

TEST(Factsheet, HasTheSpellingOfVersion3) {
  const auto fleet = import_sheet(R"({"physicalParameters": {"maximumSpeed": 1.2, "maximumAcceleration": 0.3,
    "maximumDeceleration": 0.4, "maximumAngularSpeed": 0.7, "length": 1.5, "width": 0.75}})");
  EXPECT_EQ(
      fleet.text,
      "# vehicles of f.json\n\n[[vehicle]]\nname = \"pallet-agv\"\nlength_m = 1.5\nwidth_m = 0.75\nspeed_mps = 1.2\n"
      "acceleration_mps2 = 0.3\ndeceleration_mps2 = 0.4\nturn_speed_radps = 0.7\n");
}

TEST(Factsheet, TheLargerOfBodyAndEnvelopeCounts) {
  auto text = kSheet;
  const auto fleet = import_sheet(text.replace(text.find("\"y\": 0.4"), 8, "\"y\": 0.6"));
  EXPECT_THAT(fleet.text, HasSubstr("width_m = 1.2\n"));
  EXPECT_THAT(fleet.sentences, HasSubstr("width_m is 0.8 m, and the envelope has 1.2 m; the larger counts"));
}

TEST(Factsheet, OneSideAndOtherShapesAreTold) {
  auto text = kSheet;
  text.replace(text.find("\"width\": 0.8,\n\"length\": 2.0, "), 28, "");
  const auto both = [&](const std::string& from, const std::string& to) {
    auto other = text;
    for (auto at = other.find(from); at != std::string::npos; at = other.find(from, at + to.size()))
      other.replace(at, from.size(), to);
    return import_sheet(other);
  };
  EXPECT_THAT(import_sheet(text).text, HasSubstr("length_m = 2\nwidth_m = 0.8\n"));
  EXPECT_THAT(import_sheet(text).sentences, AllOf(Not(HasSubstr("length_m")), Not(HasSubstr("width_m"))))
      << "the envelope gives them";
  const auto left = both("\"y\": 0.4", "\"y\": 0.9");
  EXPECT_THAT(left.text, HasSubstr("width_m = 1.8\n"));
  EXPECT_THAT(left.sentences,
              HasSubstr("the envelope reaches from -0.4 m to 0.9 m across; here the body reaches 0.9 m to both sides"));
  EXPECT_THAT(left.sentences, Not(HasSubstr("no rectangle")));
  EXPECT_THAT(both("\"y\": 0.4", "\"y\": 0.40000001").sentences, Not(HasSubstr("envelope")));
  EXPECT_THAT(both(R"({"x": 1.5, "y": 0.4})", R"({"x": 1.5, "y": 0.4}, {"x": 0.5, "y": 0.4})").sentences,
              Not(HasSubstr("rectangle")))
      << "a point in the middle of a side";
  for (const char* corner : {R"({"x": 0.5, "y": 0.4})", R"({"x": -0.5, "y": -0.4})"})
    EXPECT_THAT(both(R"({"x": -0.5, "y": 0.4})", corner).sentences,
                HasSubstr("the envelope is no rectangle; the rectangle around it counts"));
}

TEST(Factsheet, NothingIsDroppedSilently) {
  const auto with = [&](const std::string& before, const std::string& key) {
    auto text = kSheet;
    return import_sheet(text.insert(text.find(before), key + ", ")).sentences;
  };
  const auto plain = import_sheet(kSheet).sentences;
  for (const auto& [before, key] :
       std::vector<std::pair<std::string, std::string>>{{"\"headerId\"", R"("protocolLimits": {})"},
                                                        {"\"seriesName\"", R"("seriesDescription": "d")"},
                                                        {"\"speedMin\"", R"("angularSpeedMin": 1)"},
                                                        {"\"envelopes2d\"", R"("wheelDefinitions": [])"},
                                                        {"\"set\"", R"("description": "d")"},
                                                        {"\"x\": -0.5, \"y\": -0.4", R"("z": 1)"}})
    EXPECT_NE(with(before, key), plain) << key;
}

TEST(Factsheet, IsCalledAsThePermissionsOfALayoutCallIt) {
  Layout layout;
  layout.segments.resize(2);
  const auto name = [&](const std::string& series, const std::string& manufacturer = "") {
    ForeignVehicle vehicle;
    vehicle.type.name = series;
    vehicle.manufacturer = manufacturer;
    return name_as_permitted(vehicle, layout);
  };
  EXPECT_EQ(name("S"), "S");
  layout.segments[0].permissions = {{"m.S", LoadState::Any}};
  EXPECT_EQ(name("S"), "m.S");
  EXPECT_EQ(name("S", "m"), "m.S");
  EXPECT_EQ(name("S", "k"), "S") << "another one makes it";
  EXPECT_EQ(name("T"), "T");
  layout.segments[1].permissions = {{"k.S", LoadState::Any}};
  EXPECT_EQ(name("S"), "S") << "either may be meant";
  EXPECT_EQ(name("S", "k"), "k.S");
  layout.segments[1].permissions = {{"S", LoadState::Any}};
  EXPECT_EQ(name("S", "m"), "S");
  const auto made_by = [](const std::string& maker) { return R"({"manufacturer": )" + maker + "," + kSheet.substr(1); };
  std::vector<std::string> told;
  EXPECT_EQ(parse_factsheet(made_by("\"k\""), "f.json", told).manufacturer, "k");
  EXPECT_THAT(told,
              testing::Contains("f.json:1: the manufacturer only serves to find the vehicle in the permissions of "
                                "a layout"));
  EXPECT_THAT(import_sheet(made_by("7")).sentences,
              HasSubstr("6 parts of the factsheet are left out (\"manufacturer\""));
}

TEST(Factsheet, EachMalformedValueHasOneError) {
  const auto size = [](const std::string& more) {
    return independent::refusal(import_sheet, R"({"physicalParameters": {"length": 2, "width": 1)" + more + "}}");
  };
  EXPECT_EQ(size(""), "accepted");
  EXPECT_THAT(size(R"(, "speedMax": NaN)"), HasSubstr("f.json:1"));
  EXPECT_THAT(size(R"(, "speedMax": 1e999)"), HasSubstr("f.json:1"));
  EXPECT_THAT(size(R"(, "speedMax": null)"), HasSubstr("f.json:1: /physicalParameters/speedMax: null is refused"));
  EXPECT_THAT(size(R"(, "speedMax": "2")"), HasSubstr("/physicalParameters/speedMax"));
  EXPECT_THAT(size(R"(, "speedMax": 2, "speedMax": 2)"), HasSubstr("speedMax"));
  EXPECT_THAT(size(R"(, "speedMax": 2, "maximumSpeed": 2)"),
              HasSubstr("/physicalParameters/maximumSpeed: 2 is refused: speedMax is there, too; remove one of them"));
  const auto root = [](const std::string& more) {
    return independent::refusal(import_sheet, R"({"physicalParameters": {"length": 2, "width": 1},)" + more + "}");
  };
  EXPECT_THAT(independent::refusal(import_sheet, R"({"physicalParameters": []})"),
              HasSubstr("/physicalParameters: [] is refused: expected an object {...}"));
  EXPECT_THAT(root(R"("typeSpecification": 3)"), HasSubstr("/typeSpecification: 3 is refused: expected an object"));
  EXPECT_THAT(root(R"("typeSpecification": {"seriesName": 3})"), HasSubstr("/typeSpecification/seriesName"));
  EXPECT_THAT(root(R"("typeSpecification": {"seriesName": ""})"), HasSubstr("the name is empty"));
  EXPECT_THAT(root(R"("agvGeometry": {}, "mobileRobotGeometry": {})"), HasSubstr("agvGeometry is there, too"));
  EXPECT_THAT(root(R"("agvGeometry": {"envelopes2d": {}})"), HasSubstr("/agvGeometry/envelopes2d"));
  EXPECT_THAT(root(R"("agvGeometry": {"envelopes2d": [{}]})"), HasSubstr("has no polygonPoints"));
  EXPECT_THAT(root(R"("agvGeometry": {"envelopes2d": [{"polygonPoints": [{"x": 1e9, "y": 0}]}]})"),
              HasSubstr("/agvGeometry/envelopes2d/0/polygonPoints/0/x"));
  EXPECT_THAT(root(R"("loadSpecification": [])"), HasSubstr("/loadSpecification"));
  EXPECT_THAT(independent::refusal(import_sheet, std::string(100'000, '[')), HasSubstr("f.json:1"));
  EXPECT_THAT(independent::refusal(import_sheet, std::string("\xff\xfe{\0}\0", 6)), HasSubstr("is in UTF-16"));
  EXPECT_THAT(import_sheet(R"({"physicalParameters": {"length": 2, "width": 1}})").sentences,
              HasSubstr("f.json:1: gives no seriesName; the vehicle is called pallet-agv"));
}

TEST(Factsheet, IsRefusedWithItsPlace) {
  EXPECT_THAT(independent::refusal(import_sheet, "{}"), HasSubstr("has no physicalParameters"));
  EXPECT_THAT(independent::refusal(import_sheet, R"({"physicalParameters": {"speedMax": -1}})"),
              HasSubstr("/physicalParameters/speedMax: -1 is refused: expected 0.001 to 100"));
  EXPECT_THAT(independent::refusal(import_sheet, R"({"physicalParameters": {"length": 1}})"),
              HasSubstr("gives no length and width"));
  independent::bear_cuts(import_sheet, kSheet, 100);
  independent::bear_damage(import_sheet, kSheet, 300, "{}[]\",:-.0");
}

}  // namespace
}  // namespace fleetproof::vehicles_test
