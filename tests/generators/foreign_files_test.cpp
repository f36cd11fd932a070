#include "generators/formats/foreign_files.hpp"

#include <gmock/gmock.h>

namespace fleetproof::foreign_files_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(ForeignFiles, MessagesOfVda5050AreNamed) {
  EXPECT_THAT(named_foreign(R"({"headerId": 1, "orderId": "o", "orderUpdateId": 0, "nodes": [], "edges": []})"),
              AllOf(HasSubstr("a VDA 5050 order"), HasSubstr("as LIF")));
  EXPECT_THAT(named_foreign(R"({"headerId": 1, "orderId": "o", "nodeStates": [], "batteryState": {}})"),
              HasSubstr("a VDA 5050 state"));
  EXPECT_THAT(named_foreign(R"({"headerId": 1, "connectionState": "ONLINE"})"), HasSubstr("connection message"));
  EXPECT_THAT(named_foreign(R"({"headerId": 1, "actions": []})"), HasSubstr("instant actions"));
  EXPECT_THAT(named_foreign(R"({"headerId": 1, "agvPosition": {}})"), HasSubstr("visualization"));
  EXPECT_THAT(named_foreign(R"({"typeSpecification": {}, "physicalParameters": {}})"), HasSubstr("--factsheet"));
}

TEST(ForeignFiles, PlantsInOtherFormsAreNamedWithTheWayOut) {
  EXPECT_THAT(named_foreign(R"({"name": "p", "points": [], "paths": [], "vehicles": []})"),
              AllOf(HasSubstr("web interface of openTCS"), HasSubstr("as XML")));
  EXPECT_THAT(named_foreign("image: hall.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"),
              AllOf(HasSubstr("occupancy map of ROS"), HasSubstr(".geojson")));
  EXPECT_THAT(named_foreign("rmf_fleet:\n  name: tiny\n"), HasSubstr("configuration of a fleet"));
  EXPECT_THAT(named_foreign("<?xml version=\"1.0\"?>\n<!-- <net> -->\n<sdf version=\"1.6\"/>"), HasSubstr("Gazebo"));
  EXPECT_THAT(named_foreign("<svg:svg xmlns:svg=\"x\"/>"), HasSubstr("SVG"));
  EXPECT_THAT(named_foreign("P5\n10 10\n255\n"), HasSubstr("PGM"));
  EXPECT_THAT(named_foreign(R"({"mapFile": "a.map", "agentFile": "b"})"), HasSubstr("League of Robot Runners"));
}

TEST(ForeignFiles, LayoutsAndDamagedFilesAreNotNamed) {
  EXPECT_EQ(named_foreign(""), "");
  EXPECT_EQ(named_foreign("{"), "");
  EXPECT_EQ(named_foreign(R"({"metaInformation": {}, "layouts": []})"), "");
  EXPECT_EQ(named_foreign(R"({"version": 1, "layout": {}})"), "");
  EXPECT_EQ(named_foreign("<model version=\"6.0.0\"/>"), "");
  EXPECT_EQ(named_foreign("levels:\n  L1: {}\n"), "");
  EXPECT_EQ(named_foreign("id,x,y\n"), "");
  EXPECT_EQ(named_foreign("<"), "");
  EXPECT_EQ(named_foreign("<!--"), "");
  EXPECT_EQ(named_foreign("<?xml"), "");
}

}  // namespace
}  // namespace fleetproof::foreign_files_test
