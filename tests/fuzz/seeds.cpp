#include "tests/fuzz/seeds.hpp"

#include <fstream>
#include <iterator>

#include "core/base/random.hpp"
#include "core/bridges/mqtt/broker.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif_text.hpp"
#include "generators/scenario_file/scenario_file.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::fuzz {
namespace {

std::string text_of(const std::string& relative) {
  std::ifstream in(source_file(relative), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// One station of every purpose, a straight segment, a curve and two curves in a row.
Layout small_layout() {
  Layout layout;
  layout.name = "small";
  layout.floor_low_m = Vec2(-3.0, -3.0);
  layout.floor_high_m = Vec2(13.0, 13.0);
  layout.stations = {{"a", Vec2(0.0, 0.0), Purpose::Routing},
                     {"b, \"#2\"", Vec2(10.0, 0.0), Purposes(Purpose::Storage) | Purpose::Routing},
                     {"c", Vec2(10.0, 10.0), Purposes(Purpose::Charging) | Purpose::Parking},
                     {"\xc3\xa9", Vec2(0.0, 10.0), Purpose::Storage}};
  const auto id = [](std::uint32_t index) { return StationId{index}; };
  layout.segments = {
      {"ab", id(0), id(1), true, {}},
      {"bc", id(1), id(2), false, {Vec2(12.0, 3.0), Vec2(12.0, 7.0)}},
      {"cd", id(2), id(3), true, {Vec2(9.0, 11.0), Vec2(7.0, 12.0), Vec2(5.0, 12.0), Vec2(3.0, 12.0), Vec2(1.0, 11.0)}},
      {"da", id(3), id(0), false, {}}};
  return layout;
}

// With everything that a layout may say about a station or a segment.
Layout ruled_layout() {
  Layout layout = small_layout();
  layout.name = "ruled";
  layout.stations[2].turning = false;
  layout.stations[1].heading = Vec2(-1.0, 0.0);
  layout.blocks = {{"exit | 1", BlockKind::OneVehicle}, {"no segment", BlockKind::SameDirection}};
  Segment &there_and_back = layout.segments[0], &curve = layout.segments[2];
  there_and_back.speed_limit_mps = 1.5;
  there_and_back.back_speed_limit_mps = 0.5;
  there_and_back.width_m = 2.5;
  there_and_back.blocks = {0};
  there_and_back.travel = Travel::Backward;
  there_and_back.permissions = {{"tugger", LoadState::Loaded}, {"cart:2", LoadState::Any}};
  curve.back_travel = Travel::Either;
  curve.permissions = {{"", LoadState::Empty}};
  return layout;
}

// A layout of a family that has curves.
Layout drawn_layout() {
  Draws draws(3);
  return draw_layout(family_range("loop-spurs"), draws);
}

std::string busy_scenario() {
  WorldSpec spec;
  spec.layout = std::string("corridor-sidings");
  spec.fleet_size = 2;
  spec.faults.breakdowns_per_agv_hour = 20.0;
  spec.faults.load_drops_per_transport = 0.5;
  spec.faults.obstacles_per_hour = 30.0;
  spec.faults.position_error_m = 0.1;
  RejectionCounts counts;
  auto scenario = generate_world(spec, 5, counts);
  scenario.radio.outages.mean_outage_s = 2.0;
  scenario.radio.trace = std::make_shared<const RadioTrace>(
      RadioTrace{{AgvId{0U}, AgvId{1U}, Duration{0}, Duration{5}}, {AgvId{1U}, AgvId{0U}, Duration{7}, std::nullopt}});
  scenario.scanner.on = true;
  scenario.operator_help.on = true;
  return to_text(scenario);
}

constexpr const char* kModel = R"(<model version="6.0.0" name="tiny">
 <point name="a" positionX="0" positionY="0" type="HALT_POSITION"/>
 <point name="b" positionX="4000" positionY="0" type="PARK_POSITION"/>
 <point name="c" xPosition="4000" yPosition="4000" type="REPORT_POSITION"/>
 <path name="ab" sourcePoint="a" destinationPoint="b" length="4000" locked="false"><pathLayout connectionType="DIRECT"/></path>
 <path name="ba" sourcePoint="b" destinationPoint="a" length="4000" maxReverseVelocity="1"><pathLayout connectionType="ELBOW"/></path>
 <path name="bc" sourcePoint="b" destinationPoint="c" length="4000"><pathLayout connectionType="BEZIER">
  <controlPoint x="50" y="-20"/><controlPoint x="50" y="-50"/></pathLayout></path>
 <path name="ca" sourcePoint="c" destinationPoint="a" length="6000"><pathLayout connectionType="BEZIER_3">
  <controlPoint x="30" y="-80"/><controlPoint x="25" y="-60"/><controlPoint x="20" y="-40"/><controlPoint x="15" y="-20"/><controlPoint x="5" y="-5"/>
 </pathLayout></path>
 <path name="ac" sourcePoint="a" destinationPoint="c" length="1" locked="true"/>
 <locationType name="Storage rack"/>
 <location name="r" type="Storage rack" positionX="0" positionY="2000"><link point="a"/></location>
 <visualLayout name="v" scaleX="100.0" scaleY="50.0"/>
</model>
)";

constexpr const char* kLif =
    R"({"metaInformation": {"lifVersion": "1.0.0"}, "origins": [{"layouts": [{"layoutId": "L", "nodes": [
{"nodeId": "a", "nodePosition": {"x": 0, "y": 0}, "mobileRobotTypeNodeProperties": [{"actions": [{"actionType": "pick"}]}]},
{"nodeId": "b", "nodePosition": {"x": 6, "y": 0}, "nodeDescription": "purposes: parking"},
{"nodeId": "c", "nodePosition": {"x": 6, "y": 0}}],
"edges": [
{"edgeId": "bc", "startNodeId": "b", "endNodeId": "c", "vehicleTypeEdgeProperties": [{"rotationAllowed": true}]},
{"edgeId": "ab", "startNodeId": "a", "endNodeId": "b", "mobileRobotTypeEdgeProperties": [{"maxSpeed": 1, "trajectory":
 {"degree": 2, "knotVector": [0,0,0,0.5,1,1,1], "controlPoints": [{"x":0,"y":0},{"x":2,"y":1,"weight":2},{"x":4,"y":1},{"x":6,"y":0}]}}]},
{"edgeId": "ba", "startNodeId": "b", "endNodeId": "a", "vehicleTypeEdgeProperties": [{"trajectory":
 {"degree": 3, "knotVector": [0,0,0,0,1,1,1,1], "controlPoints": [{"x":0,"y":0},{"x":2,"y":-1},{"x":4,"y":-1},{"x":6,"y":0}]}}]}],
"stations": [{"stationId": "s", "interactionNodeIds": ["b"]}]}]}]}
)";

constexpr const char* kBuilding = R"(name: depot
coordinate_system: reference_image
levels:
  L1:
    lanes:
      - [0, 1, {bidirectional: [4, true], graph_idx: [2, 0], speed_limit: [3, 0]}]
      - [1, 2, {bidirectional: [4, false], graph_idx: [2, 0]}]
      - [2, 0, {graph_idx: [2, 1]}]
    measurements:
      - [3, 4, {distance: [3, 5]}]
    vertices:
      - [0, 0, 0, dock, {is_charger: [4, true], is_parking_spot: [4, true]}]
      - [40, 10, 0, ""]
      - [40, 60, 0, dock, {pickup_dispenser: [1, rack]}]
      - [0, 0, 0, ""]
      - [100, 0, 0, ""]
)";

constexpr const char* kNavGraph = R"(building_name: depot
levels:
  L1:
    lanes:
      - [0, 1, {speed_limit: 0}]
      - [1, 0, &words {speed_limit: 0}]
      - [1, 2, *words]
    vertices:
      - [0.0, 0.0, {name: dock, is_charger: true}]
      - [4.0, -1.0, {name: ""}]
      - [4.0, -6.0, {name: end, is_parking_spot: false}]
)";

constexpr const char* kCampaign = R"(kind = "search"
seed = 9
replicates = 2
agent_config = "x=1"
[factors]
agents = ["reckless", "hull-lock"]
layouts = ["aisle-grid", "fishbone/stress"]
fleet_sizes = [1, 2]
loss = [0, 0.4]
delay_s = [0.5]
mean_outage_s = [0, 2]
[world]
placement = "charger-bank"
hot_spot_skew = 1.5
[[vehicle]]
name = "small"
share = 2
length_m = 1.2
[[vehicle]]
name = "large"
[faults]
breakdowns_per_agv_hour = 1
[scanner]
[operator]
on = false
[radio]
delay_model = "heavy-tail"
contention_window = 31
[agent_clock]
call_cost_s = 0.001
[law]
reaction_s = 5
leave_out = ["congestion"]
[coverage]
probes = ["encounter"]
[[gate]]
agent = "reckless"
region = "contract"
kind = "rate"
limit = 0.1
)";

}  // namespace

std::string source_file(const std::string& relative) { return std::string(FLEETPROOF_SOURCE_DIR) + "/" + relative; }

std::vector<std::string> opentcs_seeds() { return {kModel, text_of("tests/layouts/crossdock.xml")}; }

std::vector<std::string> lif_seeds() {
  return {kLif, to_lif(small_layout()), to_lif(ruled_layout()), to_lif(drawn_layout())};
}

std::vector<std::string> rmf_building_seeds() { return {kBuilding}; }

std::vector<std::string> rmf_nav_graph_seeds() { return {kNavGraph}; }

std::vector<std::string> geojson_seeds() {
  return {R"({"type": "FeatureCollection", "features": [
{"properties": {"id": 0, "metadata": {"name": "dock", "type": "pick"}}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
{"properties": {"id": 1}, "geometry": {"type": "Point", "coordinates": [4, 0]}},
{"properties": {"id": 2, "startid": 0, "endid": 1, "cost": 1}, "geometry": {"type": "LineString", "coordinates": [[0, 0], [2, 2], [4, 0]]}},
{"properties": {"id": 3, "startid": 1, "endid": 0}, "geometry": {"type": "MultiLineString", "coordinates": []}}]})",
          R"({"type": "FeatureCollection", "site_name": "s", "features": [
{"feature_type": "rmf_vertex", "properties": {"name": "a", "is_charger": true}, "geometry": {"type": "Point", "coordinates": [103.8, 1.3]}},
{"feature_type": "rmf_vertex", "properties": {}, "geometry": {"type": "Point", "coordinates": [103.8001, 1.3]}},
{"feature_type": "rmf_lane", "properties": {"bidirectional": true, "graph_idx": 0, "speed_limit": 0.5, "level_idx": 0},
 "geometry": {"type": "LineString", "coordinates": [[103.8, 1.3], [103.8001, 1.3]]}}]})"};
}

std::vector<std::string> smap_seeds() {
  return {R"({"header": {"mapName": "m"}, "normalPosList": [{"x": 1}], "advancedPointList": [
{"className": "ActionPoint", "instanceName": "AP1", "pos": {}, "property": [{"key": "allowrotate", "value": "ZmFsc2U="}]},
{"className": "ChargePoint", "instanceName": "CP2", "pos": {"x": 4}, "dir": 1.5, "ignoreDir": true}],
"binLocationsList": [{"binLocationList": [{"instanceName": "b", "pointName": "CP2"}]}], "advancedCurveList": [
{"className": "BezierPath", "instanceName": "AP1-CP2", "startPos": {"instanceName": "AP1"}, "endPos": {"instanceName": "CP2"},
 "controlPos1": {"x": 1, "y": 1}, "controlPos2": {"x": 3, "y": 1}, "property": [{"key": "maxspeed", "doubleValue": 0.5}]},
{"className": "StraightPath", "instanceName": "AP1-CP2", "startPos": {"instanceName": "CP2"}, "endPos": {"instanceName": "AP1"},
 "property": [{"key": "direction", "int32Value": 1}]}]})"};
}

std::vector<std::string> mqtt_seeds() {
  using namespace mqtt;
  const auto connect = encode(Connect{
      .client = "agv1", .is_clean = false, .keep_alive_s = 15, .will = Will{"c/agv1", "CONNECTIONBROKEN", 1, true}});
  return {
      connect + encode(Subscribe{1, {{"order", 1}, {"v/+/state", 0}, {"#", 2}}}) + encode(Pingreq{}),
      connect + encode(Publish{.topic = "c/agv1", .payload = "{}", .qos = 1, .retain = true, .id = 7}) +
          encode(Publish{.topic = "c/agv1", .payload = "{}", .qos = 1, .is_again = true, .id = 7}) +
          encode(Publish{.topic = "s", .payload = std::string(200, '7')}),
      encode(Connect{.client = ""}) + encode(Unsubscribe{2, {"#", "order"}}) + encode(Puback{1}) + encode(Disconnect{}),
      encode(Connack{true}) + encode(Suback{1, {0, 1, kRefused}}) + encode(Unsuback{2}) + encode(Pingresp{}) +
          encode(Publish{.topic = "order", .payload = "x", .qos = 1, .id = 1})};
}

std::vector<std::string> mqtt_disk_seeds() {
  using namespace mqtt;
  Broker broker({[](std::uint32_t, std::string_view, std::string_view) {}, [](std::uint32_t, std::string_view) {}});
  const auto nothing = broker.saved();
  broker.opened(1, 0);
  broker.received(1,
                  encode(Connect{.client = "agv1", .is_clean = false}) +
                      encode(Subscribe{1, {{"order", 1}, {"#", 1}}}) +
                      encode(Publish{.topic = "c", .payload = "ONLINE", .qos = 1, .retain = true, .id = 1}),
                  0);
  return {broker.saved(), nothing};
}

std::vector<std::string> grid_map_seeds() {
  return {"type octile\nheight 3\nwidth 4\nmap\n..@.\n.TS.\n@...\n", "width 2\nheight 1\nmap\r\nEG\r\n"};
}

std::vector<std::string> csv_layout_seeds() {
  return {to_csv(small_layout()), to_csv(ruled_layout()), to_csv(drawn_layout())};
}

std::vector<std::string> layout_seeds() {
  return {to_text(small_layout()), to_text(ruled_layout()), to_text(drawn_layout())};
}

std::vector<std::string> scenario_seeds() {
  return {text_of("tests/scenarios/figure4.json"), text_of("tests/scenarios/parked_then_leaves.json"), busy_scenario()};
}

std::vector<std::string> factsheet_seeds() {
  return {R"({"headerId": 1, "typeSpecification": {"seriesName": "H"}, "physicalParameters": {"speedMax": 1.8,
"accelerationMax": 0.6, "decelerationMax": 0.9, "width": 0.8, "length": 2.0}, "agvGeometry": {"envelopes2d": [{"set":
"s", "polygonPoints": [{"x": -0.5, "y": -0.4}, {"x": 1.5, "y": 0.4}, {"x": 0.5, "y": 0.5}]}]}, "loadSpecification":
{"loadSets": [{"setName": "pallet", "loadType": "EPAL", "boundingBoxReference": {"x": 0.5, "y": 0, "z": 0, "theta":
1.5708}, "loadDimensions": {"length": 1.2, "width": 0.8}, "maxWeight": 900, "agvSpeedLimit": 1.2,
"agvAccelerationLimit": 0.3, "agvDecelerationLimit": 0.5, "pickTime": 7, "dropTime": 6.5}]}})",
          R"({"physicalParameters": {"maximumSpeed": 1, "length": 1.5, "width": 1}, "mobileRobotGeometry": {},
"loadSpecification": {"loadSets": [{"loadDimensions": {"length": 2, "width": 1}}, {"maximumSpeed": 0.01}]}})"};
}

std::vector<std::string> opentcs_vehicle_seeds() {
  return {R"(<model version="7.0.0"><vehicle name="a" maxVelocity="1500" maxReverseVelocity="500" envelopeKey="e">
<boundingBox length="2100" width="900" height="1" referenceOffsetX="-300" referenceOffsetY="5"/></vehicle>
<vehicle name="b" length="1000"/></model>)"};
}

std::vector<std::string> radio_trace_seeds() {
  return {
      "\xEF\xBB\xBF# hall 3\r\nsender,receiver,t_send_s,t_recv_s\r\n1,0,1700000000.250000001,1700000000.3\r\n0, 1, "
      "1700000000.5, "
      "lost\n0,1,1700000000,\n"};
}

std::vector<std::string> order_seeds() {
  return {"release_s,from,to,agv\n0,a,\"b, \"\"2\"\"\",\n12.5,b,a,1\n# later\n1e3,c,d\n"};
}

std::vector<std::string> vda5050_seeds() {
  const std::string head = R"({"headerId": 1, "timestamp": "2026-01-01T00:00:03.12Z", "version": "2.1.0",
"manufacturer": "fp", "serialNumber": "agv1", )";
  return {head + R"("orderId": "o1", "orderUpdateId": 0, "nodes": [{"nodeId": "n1", "sequenceId": 0, "released": true,
"nodePosition": {"x": 1, "y": 2.5, "theta": 0.1, "mapId": "m", "allowedDeviationXY": 1}, "actions": [{"actionType":
"pick", "actionId": "a1", "blockingType": "HARD", "actionParameters": [{"key": "loadId", "value": "7"}, {"key": "k",
"value": [1, {"x": null}]}]}]}, {"nodeId": "n2", "sequenceId": 2, "released": false, "actions": []}], "edges":
[{"edgeId": "e1", "sequenceId": 1, "released": false, "startNodeId": "n1", "endNodeId": "n2", "length": 3,
"corridor": {"leftWidth": 1, "rightWidth": 2, "corridorRefPoint": "CONTOUR"}, "trajectory": {"degree": 1,
"knotVector": [0, 1], "controlPoints": [{"x": 0, "y": 0}]}, "actions": []}]})",
          head + R"("orderId": "o2", "orderUpdateId": 3, "nodes": [{"nodeId": "n1", "sequenceId": 0, "released": true,
"actions": [{"actionType": "beep", "actionId": "a1", "blockingType": "SOFT"}]}, {"nodeId": "n2", "sequenceId": 2,
"released": true, "actions": []}], "edges": [{"edgeId": "e1", "sequenceId": 1, "released": true, "startNodeId": "n1",
"endNodeId": "n2", "actions": [{"actionType": "beep", "actionId": "a2", "blockingType": "NONE"}]}]})",
          head + R"("actions": [{"actionType": "startPause", "actionId": "i1", "blockingType": "HARD"}, {"actionType":
"cancelOrder", "actionId": "i2", "blockingType": "NONE"}, {"actionType": "beep", "actionId": "i3", "blockingType":
"SOFT", "actionParameters": []}]})",
          head + R"("connectionState": "ONLINE"})",
          head + R"("orderId": "", "orderUpdateId": 0, "lastNodeId": "n1", "lastNodeSequenceId": 0, "driving": false,
"nodeStates": [], "edgeStates": [], "actionStates": [{"actionId": "a", "actionStatus": "PAUSED"}], "batteryState":
{"batteryCharge": 80, "charging": false}, "operatingMode": "MANUAL", "errors": [{"errorType": "orderError",
"errorLevel": "WARNING"}], "safetyState": {"eStop": "NONE", "fieldViolation": false}})"};
}

std::vector<std::string> campaign_seeds() {
  return {kCampaign, text_of("tests/campaigns/families.toml"), text_of("tests/campaigns/soak.toml"),
          text_of("tests/campaigns/demo.toml")};
}

}  // namespace fleetproof::fuzz
