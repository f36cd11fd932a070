// Nothing in a plant model is dropped silently: each element and attribute of the schemas 0.0.2 to 7.0.0 changes the
// import or yields a sentence.
#include <gtest/gtest.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "core/base/error.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/opentcs.hpp"

namespace fleetproof::opentcs_left_out_test {
namespace {

constexpr const char* kNew = R"(<model version="7.0.0" name="m">
<point name="a" positionX="0" positionY="0"><outgoingPath name="ab"/><pointLayout/></point>
<point name="b" positionX="9000" positionY="0"/>
<point name="c" positionX="12000" positionY="3000"/>
<path name="ab" sourcePoint="a" destinationPoint="b" length="9000" maxVelocity="1000">
  <pathLayout connectionType="DIRECT"/></path>
<path name="bc" sourcePoint="b" destinationPoint="c" length="4712" maxVelocity="1000">
  <pathLayout connectionType="BEZIER">
  <controlPoint x="213" y="0"/><controlPoint x="240" y="-27"/></pathLayout></path>
<locationType name="T"><allowedOperation name="LOAD"/><locationTypeLayout/></locationType>
<location name="L" type="T"><link point="b"/></location>
<visualLayout scaleX="50" scaleY="50"/>
</model>)";

constexpr const char* kOld = R"(<model version="0.0.2" name="m">
<point name="a" xPosition="0" yPosition="0"/>
<point name="b" xPosition="9000" yPosition="0"/>
<path name="ab" sourcePoint="a" destinationPoint="b" length="9000" maxVelocity="1000"/>
<locationType name="T"><allowedOperation name="LOAD"/></locationType>
<location name="L" type="T"><link point="b"/></location>
<visualLayout scaleX="50" scaleY="50"><modelLayoutElement visualizedObjectName="a"/>
<modelLayoutElement visualizedObjectName="ab"/></visualLayout>
</model>)";

// What one file has and the other has not.
struct Thing {
  const char* model;
  const char* parent;  // XPath
  const char* added;   // a child element; an attribute if it begins with @

  friend void PrintTo(const Thing& t, std::ostream* out) { *out << t.parent << " " << t.added; }
};

const Thing kThings[] = {
    // 6.0.0 and 7.0.0
    {kNew, "/model", "@version=9.1.0"},
    {kNew, "/model", "@name=other"},
    {kNew, "/model", "<property name='k' value='v'/>"},
    {kNew, "//point[1]", "@name=z"},
    {kNew, "//point[2]", "@positionX=9500"},
    {kNew, "//point[2]", "@positionY=50"},
    {kNew, "//point[2]", "@xPosition=9500"},
    {kNew, "//point[2]", "@yPosition=50"},
    {kNew, "//point[2]", "@positionZ=1200"},
    {kNew, "//point[2]", "@vehicleOrientationAngle=90.0"},
    {kNew, "//point[2]", "@type=PARK_POSITION"},
    {kNew, "//point[2]", "@type=REPORT_POSITION"},
    {kNew, "//point[2]", "@type=LAKE_POSITION"},
    {kNew, "//point[2]",
     "<maxVehicleBoundingBox length='1' width='1' height='1' referenceOffsetX='0' referenceOffsetY='0'/>"},
    {kNew, "//point[2]", "<vehicleEnvelope key='k'><vertex x='0' y='0'/></vehicleEnvelope>"},
    {kNew, "//point[2]", "<outgoingPath name='nowhere'/>"},
    {kNew, "//point[2]", "<property name='k' value='v'/>"},
    {kNew, "//point[1]/pointLayout", "@labelOffsetX=-10"},
    {kNew, "//point[1]/pointLayout", "@labelOffsetY=-10"},
    {kNew, "//point[1]/pointLayout", "@layerId=1"},
    {kNew, "//path[1]", "@name=z"},
    {kNew, "//path[1]", "@sourcePoint=c"},
    {kNew, "//path[1]", "@destinationPoint=c"},
    {kNew, "//path[1]", "@length=8000"},
    {kNew, "//path[1]", "@maxVelocity=500"},
    {kNew, "//path[1]", "@maxReverseVelocity=500"},
    {kNew, "//path[1]", "@maxVelocity=1"},
    {kNew, "//path[1]", "@maxVelocity=1e9"},
    {kNew, "//path[1]", "@maxReverseVelocity=1e9"},
    {kNew, "//path[1]", "@locked=true"},
    {kNew, "//path[1]", "@locked=banana"},
    {kNew, "//path[1]",
     "<peripheralOperation name='Open' locationName='L' executionTrigger='AFTER_ALLOCATION' "
     "completionRequired='true'/>"},
    {kNew, "//path[1]", "<vehicleEnvelope key='k'><vertex x='0' y='0'/></vehicleEnvelope>"},
    {kNew, "//path[1]", "<property name='k' value='v'/>"},
    {kNew, "//path[1]/pathLayout", "@layerId=1"},
    {kNew, "//path[1]/pathLayout", "@connectionType=ELBOW"},
    {kNew, "//path[1]/pathLayout", "@connectionType=SLANTED"},
    {kNew, "//path[1]/pathLayout", "@connectionType=POLYPATH"},
    {kNew, "//path[1]/pathLayout", "@connectionType=BEZIER_3"},
    {kNew, "//path[1]/pathLayout", "@connectionType=SPLINE"},
    {kNew, "//path[1]/pathLayout", "<controlPoint x='9' y='9'/>"},
    {kNew, "//controlPoint[1]", "@x=210"},
    {kNew, "//controlPoint[1]", "@y=-3"},
    {kNew, "/model", "<vehicle name='v' maxVelocity='9'><boundingBox/><property/><vehicleLayout/></vehicle>"},
    {kNew, "//locationType", "@name=z"},
    {kNew, "//locationType", "<allowedOperation name='CHARGE'/>"},
    {kNew, "//locationType/allowedOperation", "@name=CHARGE"},
    {kNew, "//locationType", "<allowedOperation name='WASH'/>"},
    {kNew, "//location/link", "<allowedOperation name='WASH'/>"},
    {kNew, "//point[1]/pointLayout", "@positionX=7"},
    {kNew, "//point[1]/pointLayout", "@positionY=7"},
    {kNew, "//locationType", "<allowedPeripheralOperation name='Open'/>"},
    {kNew, "//locationType", "<property name='k' value='v'/>"},
    {kNew, "//locationType[not(allowedOperation)]", "<locationTypeLayout locationRepresentation='WORKING_GENERIC'/>"},
    {kNew, "//locationType/locationTypeLayout", "@locationRepresentation=RECHARGE_GENERIC"},
    {kNew, "//location", "@name=z"},
    {kNew, "/model", "<location name='M' type='T' positionX='1' positionY='1'><link point='c'/></location>"},
    {kNew, "//location", "@positionZ=1"},
    {kNew, "//location", "@type=U"},
    {kNew, "//location", "@locked=true"},
    {kNew, "//location", "@locked=banana"},
    {kNew, "/model", "<location name='L' type='T'><link point='b'/></location>"},
    {kNew, "/model", "<locationType name='T'><allowedOperation name='CHARGE'/></locationType>"},
    {kNew, "/model", "<path name='ab' sourcePoint='b' destinationPoint='a' length='9000'/>"},
    {kNew, "/model", "<point name='c' positionX='0' positionY='5'/>"},
    {kNew, "/", "<model/>"},
    {kNew, "//location", "<link point='c'/>"},
    {kNew, "//location/link", "@point=c"},
    {kNew, "//location/link", "<allowedOperation name='CHARGE'/>"},
    {kNew, "//location", "<property name='k' value='v'/>"},
    {kNew, "//location", "<locationLayout labelOffsetX='1' layerId='1' locationRepresentation='NONE'/>"},
    {kNew, "/model", "<block name='k' type='SAME_DIRECTION_ONLY'><member name='ab'/><blockLayout/></block>"},
    {kNew, "//visualLayout", "@name=v"},
    {kNew, "//visualLayout", "@scaleX=51"},
    {kNew, "//visualLayout", "@scaleY=51"},
    {kNew, "//visualLayout", "<layer id='0' ordinal='0' visible='true' name='x' groupId='0'/>"},
    {kNew, "//visualLayout", "<layerGroup id='0' name='x' visible='true'/>"},
    {kNew, "//visualLayout", "<property name='k' value='v'/>"},
    // 0.0.4 and 0.0.5
    {kOld, "//point[2]", "@xPosition=9500"},
    {kOld, "//point[2]", "@yPosition=50"},
    {kOld, "//point[2]", "@zPosition=1200"},
    {kNew, "//point[1]/pointLayout", "@xLabelOffset=-10"},
    {kNew, "//point[1]/pointLayout", "@yLabelOffset=-10"},
    {kNew, "//point[2]", "<pointLayout xPosition='100' yPosition='200'/>"},
    {kNew, "//point[1]", "<pointLayout xPosition='100' yPosition='200'/>"},
    {kNew, "//point[1]/pointLayout", "<property/>"},
    {kOld, "/model", "<location name='M' type='T' xPosition='1' yPosition='1'><link point='a'/></location>"},
    {kOld, "//location", "@zPosition=1"},
    // 0.0.2 and 0.0.3
    {kOld, "//point[1]", "@id=4"},
    {kOld, "//path[1]", "@id=4"},
    {kOld, "//path[1]", "@routingCost=7"},
    {kOld, "//path[1]", "<typeMaxVelocity vehicleType='t' velocity='3'/>"},
    {kOld, "//path[1]", "<typeMaxReverseVelocity vehicleType='t' velocity='3'/>"},
    {kOld, "//path[1]", "<typeLock vehicleType='t' locked='true'/>"},
    {kOld, "//path[1]", "<typeActions vehicleType='t'><action name='x' distance='1'/></typeActions>"},
    {kOld, "/model", "<vehicleType name='t' id='1'><action name='x'/></vehicleType>"},
    {kOld, "/model", "<vehicle name='v' id='1' type='t' length='1000'/>"},
    {kOld, "//locationType", "@id=4"},
    {kOld, "//locationType", "@locationNamePrefix=Loc"},
    {kOld, "//locationType/allowedOperation", "<property name='k' value='v'/>"},
    {kOld, "//location", "@id=4"},
    {kOld, "//location/link", "<allowedOperation name='CHARGE'><property name='k' value='v'/></allowedOperation>"},
    {kOld, "/model", "<staticRoute name='r' id='4'><hop name='a'/></staticRoute>"},
    {kOld, "/model", "<group name='g' id='4'><member name='a'/></group>"},
    {kOld, "//visualLayout", "@id=4"},
    {kOld, "//visualLayout", "<color name='x' redValue='1' greenValue='1' blueValue='1'/>"},
    {kOld, "//visualLayout", "<shapeLayoutElement layer='0'><property/></shapeLayoutElement>"},
    {kOld, "//visualLayout", "<viewBookmark label='x' centerX='1'/>"},
    {kOld, "//modelLayoutElement[1]", "@layer=1"},
    {kOld, "//modelLayoutElement[1]", "@visualizedObjectName=nothing"},
    {kOld, "//modelLayoutElement[1]", "<property name='LABEL_OFFSET_X' value='1'/>"},
    {kOld, "//modelLayoutElement[1]", "<property name='POSITION_X' value='1'/>"},
    {kOld, "//modelLayoutElement[2]", "<property name='CONN_TYPE' value='Elbow'/>"},
    {kOld, "//modelLayoutElement[2]", "<property name='CONTROL_POINTS' value='1,1'/>"},
    {kOld, "//modelLayoutElement[2]", "<property name='COLOR' value='1'/>"},
    {kOld, "/model", "<visualLayout name='second' scaleX='50' scaleY='50'/>"},
    // no schema
    {kNew, "//path[1]", "@colour=red"},
    {kNew, "//path[1]", "<traffic_light/>"},
    {kNew, "//point[1]/outgoingPath", "@colour=red"},
    {kNew, "/model", "<traffic_light/>"},
    {kNew, "//location/link", "@colour=red"},
    {kNew, "//controlPoint[1]", "@z=4"},
};

// The layout and the sentences; for a refused file the sentence of the refusal.
struct Import {
  std::string layout;
  std::vector<std::string> sentences;
};

Import import(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw);
  Import result;
  try {
    result.layout = to_text(parse_opentcs(text.str(), "m.xml", result.sentences));
  } catch (const InputError& error) {
    result.sentences.emplace_back(error.what());
  }
  return result;
}

void add(pugi::xml_node parent, const std::string& added) {
  if (added[0] != '@') {
    ASSERT_TRUE(parent.append_buffer(added.data(), added.size())) << added;
    return;
  }
  const auto name = added.substr(1, added.find('=') - 1);
  auto attribute = parent.attribute(name.c_str());
  if (!attribute) attribute = parent.append_attribute(name.c_str());
  attribute.set_value(added.substr(added.find('=') + 1).c_str());
}

class PlantModelThing : public testing::TestWithParam<Thing> {};

TEST_P(PlantModelThing, ChangesTheImportOrYieldsASentence) {
  const auto& [model, parent, added] = GetParam();
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(model));
  // This child says what a location is for only if the operations do not.
  if (std::string(parent).find("not(allowedOperation)") != std::string::npos)
    document.select_node("//locationType/allowedOperation").parent().remove_children();
  const Import without = import(document);
  ASSERT_NE(without.layout, "") << without.sentences[0];
  const auto found = document.select_node(parent);
  ASSERT_TRUE(found);
  add(found.node(), added);
  const Import with = import(document);
  const bool told = std::ranges::any_of(with.sentences, [&](const std::string& sentence) {
    return std::ranges::find(without.sentences, sentence) == without.sentences.end();
  });
  EXPECT_TRUE(told || with.layout != without.layout) << "dropped silently";
}

INSTANTIATE_TEST_SUITE_P(All, PlantModelThing, testing::ValuesIn(kThings));

TEST(PlantModelThings, ASoundModelYieldsOneSentence) {
  for (const char* model : {kNew, kOld}) {
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(model));
    const auto sentences = import(document).sentences;
    ASSERT_EQ(sentences.size(), 1U) << sentences[1];
    EXPECT_NE(sentences[0].find("1 locations stand beside the paths (\"L\")"), std::string::npos);
  }
}

TEST(PlantModelThings, OneSentenceCountsAndNames) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(kNew));
  for (const auto point : document.select_nodes("//point"))
    point.node().append_buffer("<property name='\u8F6C\u5F2F' value='1'/>", 37);
  const auto sentences = import(document).sentences;
  ASSERT_EQ(sentences.size(), 2U);
  EXPECT_EQ(sentences[0], "m.xml:1: 1 properties are left out (keys: \"\u8F6C\u5F2F\")");
}

}  // namespace
}  // namespace fleetproof::opentcs_left_out_test
