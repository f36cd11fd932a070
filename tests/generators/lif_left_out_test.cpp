// Nothing in a LIF file is dropped silently: each key of LIF 1.0 and of its successor changes the import or yields a
// sentence.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif.hpp"

namespace fleetproof::lif_left_out_test {
namespace {

const std::string kFile = R"({"layouts": [{"layoutId": "L",
"nodes": [{"nodeId": "a", "nodePosition": {"x": 0, "y": 1}, "vehicleTypeNodeProperties": [{"at": "a"}]},
{"nodeId": "b", "nodePosition": {"x": 6, "y": 0}},
{"nodeId": "c", "nodePosition": {"x": 9, "y": 3}}],
"edges": [{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": [{"at": "ab"}]},
{"edgeId": "bc", "startNodeId": "b", "endNodeId": "c"}],
"stations": [{"interactionNodeIds": ["b"], "stationId": "S"}]}]})";

struct Thing {
  const char* before;  // the key is put before this text
  const char* key;

  friend void PrintTo(const Thing& t, std::ostream* out) { *out << t.key; }
};

constexpr const char* kLayout = R"("nodes": [)";
constexpr const char* kNode = R"("nodePosition": {"x": 0)";
constexpr const char* kNodeType = R"("at": "a")";
constexpr const char* kEdge = R"("startNodeId": "a")";
constexpr const char* kEdgeType = R"("at": "ab")";
constexpr const char* kStation = R"("interactionNodeIds")";

const Thing kThings[] = {
    {R"("layouts")",
     R"("metaInformation": {"projectIdentification": "p", "creator": "c", "exportTimestamp": "t", "lifVersion": "1"})"},
    {kLayout, R"("layoutName": "other")"},
    {kLayout, R"("layoutVersion": "1")"},
    {kLayout, R"("layoutLevelId": "1")"},
    {kLayout, R"("layoutDescription": "1")"},
    {kNode, R"("nodeName": "n")"},
    {kNode, R"("nodeDescription": "n")"},
    {kNode, R"("mapId": "m")"},
    {kNodeType, R"("vehicleTypeId": "v")"},
    {kNodeType, R"("theta": 1.57)"},
    {kNodeType, R"("actions": [{"actionType": "pick"}])"},
    {kNodeType, R"("actions": [{"actionType": "dance"}])"},
    {kNodeType, R"("actions": [{"actionType": "drop", "actionDescription": "d"}])"},
    {kNodeType, R"("actions": [{"actionType": "drop", "requirementType": "REQUIRED"}])"},
    {kNodeType, R"("actions": [{"actionType": "drop", "required": true}])"},
    {kNodeType, R"("actions": [{"actionType": "drop", "blockingType": "HARD"}])"},
    {kNodeType, R"("actions": [{"actionType": "drop", "actionParameters": [{"key": "k", "value": "v"}]}])"},
    {kEdge, R"("edgeName": "n")"},
    {kEdge, R"("edgeDescription": "n")"},
    {kEdge, R"("edgeDescription": "back: n")"},
    {kEdgeType, R"("vehicleTypeId": "v")"},
    {kNodeType, R"("vehicleTypeIds": ["v"])"},
    {kEdgeType, R"("vehicleTypeIds": ["v", "w"])"},
    {kEdgeType, R"("mobileRobotTypeIds": [])"},
    {kEdgeType, R"("vehicleOrientation": 3.14)"},
    {kEdgeType, R"("vehicleOrientation": 1)"},
    {kEdgeType, R"("orientationType": "GLOBAL")"},
    {kEdgeType, R"("rotationAllowed": true)"},
    {kEdgeType, R"("rotationAtStartNodeAllowed": "CW")"},
    {kEdgeType, R"("rotationAtEndNodeAllowed": "CW")"},
    {kEdgeType, R"("maxSpeed": 1)"},
    {kEdgeType, R"("maxRotationSpeed": 1)"},
    {kEdgeType, R"("minHeight": 1)"},
    {kEdgeType, R"("maxHeight": 1)"},
    {kEdgeType, R"("loadRestriction": {"unloaded": true, "loaded": false, "loadSetNames": ["pallet"]})"},
    {kEdgeType, R"("actions": [{"actionType": "startCharging"}])"},
    {kEdgeType, R"("actions": [{"actionType": "dance"}])"},
    {kEdgeType, R"("reentryAllowed": false)"},
    {kEdgeType, R"("trajectory": {"degree": 2, "knotVector": [0, 0, 0, 1, 1, 1],
       "controlPoints": [{"x": 0, "y": 0}, {"x": 3, "y": 1, "weight": 2}, {"x": 6, "y": 0}]})"},
    {kStation, R"("stationName": "n")"},
    {kStation, R"("stationDescription": "n")"},
    {kStation, R"("stationHeight": 1)"},
    // the successor of LIF 1.0
    {kNode, R"("mobileRobotTypeNodeProperties": [{"mobileRobotTypes": [{"manufacturer": "m", "seriesName": "s"}]}])"},
    {kNodeType, R"("allowedDeviationXY": {"a": 1, "b": 1, "theta": 0})"},
    {kEdgeType, R"("mobileRobotOrientations": [3.14])"},
    {kEdgeType, R"("mobileRobotOrientations": ["forward"])"},
    {kEdgeType, R"("vehicleOrientations": [0, 3.14])"},
    {kEdgeType, R"("vehicleOrientations": [0, 1])"},
    {kEdgeType, R"("reachOrientationBeforeEntering": false)"},
    {kEdgeType, R"("maximumSpeed": 1)"},
    {kEdgeType, R"("maximumRotationSpeed": 1)"},
    {kEdgeType, R"("corridor": {"maximumLeftWidth": 1, "maximumRightWidth": 1})"},
    {kEdgeType, R"("physicalLineGuidedProperty": {"direction": "left", "length": 1})"},
    {kStation, R"("stationType": "t")"},
    {kLayout, R"("layoutDescriptor": "1")"},
    {kNode, R"("nodeDescriptor": "n")"},
    {kNodeType, R"("loadRestriction": {"unloaded": true, "loaded": false})"},
    {kNodeType, R"("loadRestriction": {"unloaded": true, "loaded": true, "loadSetNames": ["pallet"]})"},
    {kNodeType, R"("requiredActions": [{"actionType": "startCharging", "blockingType": "HARD"}])"},
    {kNodeType, R"("feasibleActions": [{"actionType": "pick"}])"},
    {kNodeType, R"("feasibleActions": [{"actionType": "dance"}])"},
    {kNodeType, R"("forbiddenActionTypes": ["dance"])"},
    {kEdge, R"("edgeDescriptor": "n")"},
    {kEdgeType, R"("mobileRobotTypes": [{"manufacturer": "m", "seriesName": "s"}])"},
    {kEdgeType, R"("minimumLoadHandlingDeviceHeight": 1)"},
    {kEdgeType, R"("maximumMobileRobotHeight": 1)"},
    {kEdgeType, R"("requiredActions": [{"actionType": "startCharging"}])"},
    {kEdgeType, R"("feasibleActions": [{"actionType": "startCharging"}])"},
    {kEdgeType, R"("forbiddenActionTypes": ["pick"])"},
    {kStation, R"("stationDescriptor": "n")"},
    {R"("layouts")", R"("metaInformation": {"lifId": "p", "lifVersion": "2.0.0"})"},
    // neither
    {kEdgeType, R"("orientationType": "TANGENT")"},
    {kEdgeType, R"("vehicleOrientation": 180)"},
    {R"("layouts")", R"("traffic": 1)"},
    {kLayout, R"("traffic": [1])"},
    {kNode, R"("traffic": {"light": 1})"},
    {kEdgeType, R"("traffic": 1)"},
    {kStation, R"("traffic": 1)"},
    {R"("x": 0, "y": 1)", R"("z": 1)"},
};

struct Import {
  std::string layout;
  std::vector<std::string> sentences;
};

Import import(const std::string& text) {
  Import result;
  try {
    result.layout = to_text(parse_lif(text, "l.json", result.sentences));
  } catch (const InputError& error) {
    result.sentences.emplace_back(error.what());
  }
  return result;
}

class LifThing : public testing::TestWithParam<Thing> {};

TEST_P(LifThing, ChangesTheImportOrYieldsASentence) {
  const Import without = import(kFile);
  ASSERT_NE(without.layout, "") << without.sentences[0];
  auto text = kFile;
  const auto at = text.find(GetParam().before);
  ASSERT_NE(at, std::string::npos);
  const Import with = import(text.insert(at, std::string(GetParam().key) + ", "));
  const bool told = std::ranges::any_of(with.sentences, [&](const std::string& sentence) {
    return std::ranges::find(without.sentences, sentence) == without.sentences.end();
  });
  EXPECT_TRUE(told || with.layout != without.layout) << "dropped silently";
}

INSTANTIATE_TEST_SUITE_P(All, LifThing, testing::ValuesIn(kThings));

TEST(LifThings, ValuesThatSayNothingYieldNoSentence) {
  const auto count = import(kFile).sentences.size();
  for (const char* key :
       {R"("orientationType": "TANGENTIAL")", R"("reentryAllowed": true)", R"("reachOrientationBeforeEntering": true)",
        R"("vehicleOrientation": 0)", R"("vehicleOrientation": 0.0)", R"("mobileRobotOrientations": [0])"}) {
    auto text = kFile;
    text.insert(text.find(kEdgeType), std::string(key) + ", ");
    EXPECT_EQ(import(text).sentences.size(), count) << key;
  }
}

TEST(LifThings, SidewaysTravelAndLeavingTheLaneAreNamed) {
  auto text = kFile;
  text.insert(text.find(kEdgeType), R"("vehicleOrientation": 1.5, "corridor": {}, )");
  const auto sentences = import(text).sentences;
  const auto says = [&](const char* what) {
    return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(says("(\"ab\"); sideways travel is not modelled"));
  EXPECT_TRUE(says("(\"ab\"); leaving the lane is not modelled"));
}

TEST(LifThings, AStationWhereAnAgvMustNotDropIsNotTakenForStorage) {
  const auto sentences_with = [](const std::string& type) {
    auto text = kFile;
    const std::string rule = R"("vehicleTypeNodeProperties": [{"forbiddenActionTypes": [")" + type + R"("]}], )";
    const auto all = import(text.insert(text.find(R"("nodePosition": {"x": 6)"), rule)).sentences;
    std::string joined;
    for (const auto& sentence : all) joined += sentence + "\n";
    return joined;
  };
  EXPECT_NE(sentences_with("drop").find("they forbid to pick or drop, so AGVs only pass"), std::string::npos);
  EXPECT_NE(sentences_with("dance").find("they are taken to be for storage"), std::string::npos);
}

TEST(LifThings, AVersionOfTheFutureAndNotesOfOriginsAreNamed) {
  const auto sentences_with = [](const std::string& version, const std::string& note) {
    const auto text =
        R"({"metaInformation": {"lifVersion": ")" + version + R"("}, "origins": [{)" + note + kFile.substr(1) + "]}";
    return import(text).sentences;
  };
  const auto before = sentences_with("2.0.0", "").size();
  EXPECT_EQ(sentences_with("1.0", "").size(), before);
  for (const char* version : {"3.0.0", "10.0.0", "2026"}) {
    const auto sentences = sentences_with(version, "");
    ASSERT_EQ(sentences.size(), before + 1) << version;
    EXPECT_TRUE(std::ranges::count(
        sentences, "l.json:1: the file says that it is LIF \"" + std::string(version) + "\"; it is read as LIF 2.0"));
  }
  EXPECT_NE(sentences_with("2.0.0", R"("originId": "o", )"), sentences_with("2.0.0", ""));
  EXPECT_NE(sentences_with("2.0.0", R"("scale": 2, )"), sentences_with("2.0.0", ""));
}

}  // namespace
}  // namespace fleetproof::lif_left_out_test
