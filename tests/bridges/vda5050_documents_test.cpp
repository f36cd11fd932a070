// The messages of VDA 5050: what is read, what is refused with which reason, and what is written.
#include "core/bridges/vda5050/documents.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/vda5050_rules.hpp"

namespace fleetproof::vda5050_documents_test {
namespace {

using namespace bridges::vda5050;
using test::broken_rules;
using testing::HasSubstr;
using testing::IsEmpty;

const Version& k2_0 = *find_version("2.0");
const Version& k2_1 = *find_version("2.1");

constexpr std::string_view kHeaderText =
    R"("headerId":7,"timestamp":"2026-01-01T00:00:03.12Z","version":"2.1.0","manufacturer":"fp","serialNumber":"agv2")";

std::string order_text(const std::string& nodes, const std::string& edges, const std::string& rest = "") {
  return "{" + std::string(kHeaderText) + R"(,"orderId":"o3","orderUpdateId":2,"nodes":[)" + nodes + R"(],"edges":[)" +
         edges + "]" + rest + "}";
}

const std::string kNodeText = R"({"nodeId":"n1","sequenceId":0,"released":true,"actions":[]})";

std::string why_refused(const std::string& text, const Version& version = k2_1) {
  Order order;
  std::string why;
  return read_document(text, version, order, why) ? "accepted" : why;
}

Header header() { return {7, timestamp_of(0, 0), "2.1.0", "fp", "agv2"}; }

Order full_order() {
  Order order;
  order.header = header();
  order.order_id = "o \"3\"\n\xc3\xa4";
  order.order_update_id = 4294967295u;
  order.zone_set_id = "z";
  Action pick{"pick", "a1", "first", BlockingType::Hard, std::vector<ActionParameter>{}};
  pick.action_parameters->push_back({"loadId", "17", true});
  pick.action_parameters->push_back({"heights", "[0.1,2]", false});
  order.nodes.push_back({"n1", 0, "start", true, NodePosition{0.1, -1e-300, 3.14, 0.5, 0.0, "m", "hall"}, {pick}});
  order.nodes.push_back({"n2", 2, {}, false, {}, {}});
  Edge edge{"e1",   1,    "way", false, "n1", "n2", 1.5, 2.0, 0.1, -3.0, OrientationType::Global,
            "left", true, 0.2,   {},    {},   {},   {}};
  edge.trajectory = Trajectory{1.0, {0.0, 0.0, 1.0, 1.0}, {{0.1, 0.2, 0.5}, {1.0 / 3.0, 4.0, {}}}};
  edge.length = 12.5;
  edge.corridor = Corridor{0.1, 0.2, CorridorReference::Contour};
  edge.actions.push_back({"beep", "a2", {}, BlockingType::None, {}});
  order.edges.push_back(edge);
  return order;
}

State full_state() {
  State state;
  state.header = header();
  state.maps = {{"m", "1", "hall", MapStatus::Disabled}};
  state.order_id = "o3";
  state.node_states = {{"n2", 2, true}};
  state.edge_states = {{"e1", 1, false}};
  state.agv_position = AgvPosition{true, 0.25, -3.0, -1.5, "m"};
  state.loads = std::vector<Load>{{"17", "EPAL", "front", 12.0}, {}};
  state.paused = true;
  state.new_base_request = false;
  state.action_states = {{"a1", "pick", ActionStatus::Paused, "done"}, {"a2", {}, ActionStatus::Failed, {}}};
  state.battery_state = {81.25, true};
  state.operating_mode = OperatingMode::Teachin;
  state.errors = {{"orderError", {{"topic", "order"}}, "why", "hint", ErrorLevel::Fatal}, {}};
  state.information = std::vector<Info>{{"note", {{"k", "v"}}, "text", InfoLevel::Debug}};
  state.safety_state = {EmergencyStop::Remote, true};
  return state;
}

Factsheet full_factsheet() {
  Factsheet sheet;
  sheet.header = header();
  sheet.type_specification = {"series", "DIFF", "FORKLIFT", 1000.0, {"NATURAL"}, {"VIRTUAL_LINE_GUIDED"}};
  sheet.physical_parameters = {0.1, 2.0, 0.5, 0.6, 0.3, 2.1, 0.8, 1.2};
  sheet.protocol_limits = {{1u << 20, 128, 32, 64}, {100, 99, 8, 4, 8, 500, 32}, {0.5, 0.1, 30.0}};
  sheet.protocol_features.optional_parameters = {{"order.nodes.nodePosition", Support::Required}};
  sheet.protocol_features.agv_actions = {{"pick",
                                          {ActionScope::Node, ActionScope::Instant},
                                          std::vector<DescribedParameter>{{"loadId", ValueType::String, true}},
                                          std::vector<BlockingType>{BlockingType::Hard}}};
  sheet.agv_geometry.envelopes2d = {{"empty", {{0.0, 0.1}, {1.0, 2.0}}}};
  sheet.load_specification.load_positions = {"front"};
  sheet.vehicle_config = VehicleConfig{std::vector<VersionInfo>{{"software", "1.2"}}};
  return sheet;
}

template <class Document>
void expect_reads_back(const Document& document, std::string_view topic) {
  for (const Version& version : versions()) {
    const std::string text = write_document(document, version);
    EXPECT_THAT(broken_rules(text, topic, version.number), IsEmpty()) << text;
    Document again;
    std::string why;
    ASSERT_TRUE(read_document(text, version, again, why)) << why << ' ' << text;
    EXPECT_EQ(write_document(again, version), text);
  }
}

// ---- writing

TEST(Vda5050Documents, WrittenOnesKeepTheRulesOfTheirVersionAndReadBackTheSame) {
  expect_reads_back(full_order(), "order");
  expect_reads_back(InstantActions{header(), full_order().nodes[0].actions}, "instantActions");
  expect_reads_back(full_state(), "state");
  expect_reads_back(State{header(), {}, {}, 0, {}, 0, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}, "state");
  expect_reads_back(Connection{header(), ConnectionState::ConnectionBroken}, "connection");
  expect_reads_back(full_factsheet(), "factsheet");
}

TEST(Vda5050Documents, FieldsOfLaterVersionsAreNeitherWrittenNorRead) {
  const std::string text = write_document(full_order(), k2_1);
  EXPECT_THAT(text, HasSubstr("corridor"));
  EXPECT_THAT(write_document(full_order(), k2_0), testing::Not(HasSubstr("corridor")));
  EXPECT_THAT(write_document(full_state(), k2_0), testing::Not(HasSubstr("maps")));
  Order order;
  std::string why;
  ASSERT_TRUE(read_document(text, k2_0, order, why));
  EXPECT_FALSE(order.edges[0].corridor);
  EXPECT_THAT(broken_rules(text, "order", "2.0.0"), testing::ElementsAre("edges[0].corridor: is no field"));
}

TEST(Vda5050Documents, TextIsEscapedAndNumbersKeepTheirBits) {
  const std::string text = write_document(full_order(), k2_1);
  EXPECT_THAT(text, HasSubstr(R"("orderId":"o \"3\"\u000a)"));
  EXPECT_THAT(text, HasSubstr(R"("orderUpdateId":4294967295)"));
  EXPECT_THAT(text, HasSubstr(R"("y":-1e-300)"));
  Order order;
  std::string why;
  ASSERT_TRUE(read_document(text, k2_1, order, why));
  EXPECT_EQ(order.order_id, full_order().order_id);
  EXPECT_EQ(order.edges[0].trajectory->control_points[1].x, 1.0 / 3.0);
}

TEST(Vda5050Documents, ParametersOfActionsKeepAnyValue) {
  Order order;
  std::string why;
  ASSERT_TRUE(read_document(write_document(full_order(), k2_1), k2_1, order, why));
  const Action& pick = order.nodes[0].actions[0];
  EXPECT_EQ(pick.parameter("loadId")->value, "17");
  EXPECT_TRUE(pick.parameter("loadId")->is_string);
  EXPECT_EQ(pick.parameter("heights")->value, "[0.1,2]");
  EXPECT_EQ(pick.parameter("side"), nullptr);
}

TEST(Vda5050Documents, TimestampsAreUtcWithHundredthsOfASecond) {
  EXPECT_EQ(timestamp_of(0, 0), "1970-01-01T00:00:00.00Z");
  EXPECT_EQ(timestamp_of(1'767'225'600, 3'129'999'999), "2026-01-01T00:00:03.12Z");
  EXPECT_EQ(timestamp_of(1'709'164'800, 86'399'990'000'000), "2024-02-29T23:59:59.99Z");
  EXPECT_EQ(timestamp_of(4'107'542'399, 1'000'000'000), "2100-03-01T00:00:00.00Z");  // no leap year
  EXPECT_EQ(timestamp_of(0, -1), "1969-12-31T23:59:59.99Z");
}

TEST(Vda5050Documents, TopicsHaveTheMajorVersion) {
  EXPECT_EQ(topic_name(k2_0, "fp", "agv2", Topic::InstantActions), "uagv/v2/fp/agv2/instantActions");
  EXPECT_EQ(k2_0.number, "2.0.0");
  EXPECT_EQ(find_version("2.1.0"), &k2_1);
  EXPECT_EQ(find_version("1.1"), nullptr);
}

TEST(Vda5050Documents, LevelsOfTopicsHaveNoSlashes) {
  EXPECT_TRUE(is_topic_level("AGV-1_a.b:c"));
  for (const char* wrong : {"", "a/b", "$a", "a b", "+", "#", "\xc3\xa4"}) EXPECT_FALSE(is_topic_level(wrong)) << wrong;
}

// ---- reading

TEST(Vda5050Documents, UnknownFieldsAreIgnored) {
  EXPECT_EQ(why_refused(order_text(kNodeText, "", R"(,"vendor":{"x":[1,{"y":null}]})")), "accepted");
}

TEST(Vda5050Documents, EveryRequiredFieldThatIsMissingIsNamed) {
  for (const std::string field : {"headerId", "timestamp", "version", "manufacturer", "serialNumber", "orderId",
                                  "orderUpdateId", "nodes", "edges"}) {
    std::string text = order_text(kNodeText, "");
    text.replace(text.find('"' + field + '"'), field.size() + 2, "\"other\"");
    EXPECT_EQ(why_refused(text), field + " is missing");
  }
  for (const std::string field : {"nodeId", "sequenceId", "released", "actions"}) {
    std::string node = kNodeText;
    node.replace(node.find(field), field.size(), "other");
    EXPECT_EQ(why_refused(order_text(node, "")), "nodes[0]." + field + " is missing");
  }
}

TEST(Vda5050Documents, WrongTypesAndRangesAreRefusedWithTheirPlace) {
  const auto with_node = [](const std::string& field) {
    return why_refused(order_text(R"({"nodeId":"n1","sequenceId":0,"released":true,"actions":[],)" + field + "}", ""));
  };
  EXPECT_EQ(why_refused(order_text(R"({"nodeId":1,"sequenceId":0,"released":true,"actions":[]})", "")),
            "nodes[0].nodeId must be a string");
  EXPECT_EQ(why_refused(order_text(R"({"nodeId":"n","sequenceId":-1,"released":true,"actions":[]})", "")),
            "nodes[0].sequenceId must be a whole number from 0 to 4294967295");
  EXPECT_EQ(why_refused(order_text(R"({"nodeId":"n","sequenceId":0.5,"released":true,"actions":[]})", "")),
            "nodes[0].sequenceId must be a whole number from 0 to 4294967295");
  EXPECT_EQ(why_refused(order_text(R"({"nodeId":"n","sequenceId":0,"released":"true","actions":[]})", "")),
            "nodes[0].released must be true or false");
  EXPECT_EQ(with_node(R"("nodeDescription":null)"), "nodes[0].nodeDescription must be a string");
  EXPECT_EQ(with_node(R"("nodePosition":{"x":0,"y":0,"mapId":"m","theta":4})"),
            "nodes[0].nodePosition.theta is out of its range");
  EXPECT_EQ(with_node(R"("nodePosition":{"x":"0","y":0,"mapId":"m"})"), "nodes[0].nodePosition.x must be a number");
  EXPECT_EQ(why_refused(order_text(
                R"({"nodeId":"n","sequenceId":0,"released":true,"actions":[{"actionType":"a","actionId":"1",)"
                R"("blockingType":"hard"}]})",
                "")),
            R"(nodes[0].actions[0].blockingType must be "NONE" or "SOFT" or "HARD")");
}

TEST(Vda5050Documents, TimestampsMustBeInstants) {
  const auto with_time = [](const std::string& time) {
    std::string text = order_text(kNodeText, "");
    const std::string right = "2026-01-01T00:00:03.12Z";
    return why_refused(text.replace(text.find(right), right.size(), time));
  };
  for (const char* right : {"2026-01-01T00:00:03Z", "2026-01-01T00:00:03.123456789Z", "2026-01-01T01:00:03.1+01:00"})
    EXPECT_EQ(with_time(right), "accepted") << right;
  for (const char* wrong : {"", "now", "2026-01-01", "2026-01-01T00:00:03", "2026-01-01T00:00:03.Z",
                            "2026-01-01 00:00:03Z", "2026-01-01T00:00:03.1", "2026-01-01T00:00:03+0100"})
    EXPECT_EQ(with_time(wrong), "timestamp must be an instant of ISO 8601 in UTC") << wrong;
}

TEST(Vda5050Documents, WholeNumbersMayHaveAPoint) {
  EXPECT_EQ(why_refused(order_text(R"({"nodeId":"n","sequenceId":2.0,"released":true,"actions":[]})", "")), "accepted");
}

// ---- hostile

TEST(Vda5050Documents, DeepNestingIsRefused) {
  const std::string deep = std::string(400'000, '[') + std::string(400'000, ']');
  EXPECT_EQ(why_refused(deep), "more than 32 objects and arrays within each other");
  EXPECT_EQ(why_refused(order_text(kNodeText, "", ",\"x\":" + deep)),
            "more than 32 objects and arrays within each other");
}

TEST(Vda5050Documents, RepeatedKeysAreRefused) {
  EXPECT_EQ(why_refused(order_text(kNodeText, "", R"(,"orderId":"o4")")),
            R"(the key "orderId" stands twice in one object)");
  EXPECT_EQ(why_refused(order_text(kNodeText, "", R"(,"x":{"a":1,"a":1})")),
            R"(the key "a" stands twice in one object)");
}

TEST(Vda5050Documents, TenMegabytesAreRefusedUnread) {
  EXPECT_EQ(why_refused(std::string(10'000'000, ' ')), "the message has more than 1048576 bytes");
  EXPECT_EQ(why_refused(order_text(kNodeText, "", ",\"x\":\"" + std::string(10'000'000, 'x') + "\"")),
            "the message has more than 1048576 bytes");
}

TEST(Vda5050Documents, HugeNumbersAreRefused) {
  EXPECT_THAT(why_refused(order_text(kNodeText, "", ",\"x\":1e999")), HasSubstr("this is no JSON: number overflow"));
  for (const std::string huge : {"4294967296", "18446744073709551616", "1e300"})
    EXPECT_EQ(
        why_refused(order_text(R"({"nodeId":"n","sequenceId":)" + huge + R"(,"released":true,"actions":[]})", "")),
        "nodes[0].sequenceId must be a whole number from 0 to 4294967295");
}

TEST(Vda5050Documents, BrokenTextIsRefusedWithAReasonThatCanBePrinted) {
  const std::string whole = order_text(kNodeText, "");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THAT(why_refused(whole.substr(0, size)), HasSubstr("this is no JSON: ")) << size;
  for (const std::string& text :
       {std::string("\xff\xfe"), std::string("{\"\x01\":1}"), std::string(1, '\0'), whole + "x",
        "{\"" + std::string(500'000, '\xc3') + "\":1}", order_text("\"\xed\xa0\x80\"", "")}) {
    const std::string why = why_refused(text);
    EXPECT_THAT(why, HasSubstr("this is no JSON: "));
    EXPECT_LE(why.size(), 200u);
    for (const char c : why) EXPECT_TRUE(c >= ' ' && c <= '~') << why;
  }
  EXPECT_EQ(why_refused("[]"), "the message must be an object");
  EXPECT_EQ(why_refused("null"), "the message must be an object");
}

}  // namespace
}  // namespace fleetproof::vda5050_documents_test
