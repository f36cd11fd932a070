// What a master tells a vehicle, step by step, against the rules of the standard.
#include "core/bridges/vda5050/dialog.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/agents/drawn_map.hpp"
#include "tests/support/vda5050_rules.hpp"

namespace fleetproof::vda5050_dialog_test {
namespace {

using namespace bridges::vda5050;
using agents::central::Step;
using agents::testing::DrawnMap;
using testing::ElementsAre;

// A, B and C in a row: lanes 0 from A to B, 1 back, 2 from B to C.
struct Row {
  DrawnMap drawn = [] {
    DrawnMap row;
    for (const char* name : {"A", "B", "C"}) row.station(8.0 * (name[0] - 'A'), 0, FP_STORAGE, name);
    for (std::uint32_t i = 0; i < 2; ++i) row.segment(i, i + 1);
    return row;
  }();
  const agents::MapView map{drawn.map()};
  const char* segment_names[2] = {"ab", ""};
  fp_briefing briefing = [this] {
    fp_briefing told{};
    told.segment_names = segment_names;
    return told;
  }();
  PlantNames names{map, briefing};
  Dialog dialog{map, names};
};

Step drive(std::uint32_t lane) { return {Step::Kind::Drive, lane}; }
Step pick(std::uint32_t order) { return {Step::Kind::Pick, order}; }

State standing(const std::string& node) {
  State state;
  state.last_node_id = node;
  state.agv_position = AgvPosition{true, 0.0, 0.0, 0.0, kMapId};
  return state;
}
State joined(const std::string& node, const std::string& way = "join 0.1") {
  State state = standing(node);
  state.action_states = {{way, {}, ActionStatus::Failed, {}}};
  return state;
}
State under_way(const std::string& order, std::uint32_t update, const std::string& node, std::uint32_t sequence) {
  State state = standing(node);
  state.order_id = order;
  state.order_update_id = update;
  state.last_node_sequence_id = sequence;
  return state;
}

// "A, ab, B pick": nodes and edges with their actions. The order keeps the rules of the standard.
std::string text_of(const std::optional<Order>& order) {
  if (!order) return "none";
  Order whole = *order;
  whole.header = {1, "2026-01-01T00:00:00.00Z", "2.1.0", kManufacturer, "agv0"};
  EXPECT_THAT(test::broken_rules(write_document(whole, versions().back()), "order", "2.1.0"), ElementsAre());
  std::string text = order->order_id + " update " + std::to_string(order->order_update_id) + ":";
  for (std::size_t i = 0; i < order->nodes.size(); ++i) {
    const Node& node = order->nodes[i];
    text += " " + std::to_string(node.sequence_id) + " " + node.node_id;
    for (const Action& action : node.actions) text += " " + action.action_type + " " + action.action_id;
    if (i < order->edges.size())
      text += ", " + std::to_string(order->edges[i].sequence_id) + " " + order->edges[i].edge_id + ",";
  }
  return text;
}

struct JoinedRow : Row {
  JoinedRow() {
    agents::central::State told;
    dialog.begin({0, 1});
    EXPECT_EQ(dialog.hear(joined("A"), told), Dialog::Heard::OfWay);
  }
  agents::central::State hear(const State& state) {
    agents::central::State told;
    EXPECT_EQ(dialog.hear(state, told), Dialog::Heard::OfWay);
    return told;
  }
  Dialog::Heard heard(const State& state) {
    agents::central::State told;
    return dialog.hear(state, told);
  }
};

TEST(Vda5050Dialog, AWayBeginsBehindABarrier) {
  Row row;
  row.dialog.begin({0, 1});
  agents::central::State told;
  EXPECT_EQ(row.dialog.hear(standing("A"), told), Dialog::Heard::Nothing) << "an order may be under way to it";
  EXPECT_FALSE(row.dialog.send(0, {drive(0)}));
  InstantActions barrier = row.dialog.barrier().value();
  EXPECT_EQ(barrier.actions.front().action_type, "cancelOrder");
  barrier.header = {1, "2026-01-01T00:00:00.00Z", "2.1.0", kManufacturer, "agv0"};
  EXPECT_THAT(test::broken_rules(write_document(barrier, versions().back()), "instantActions", "2.1.0"), ElementsAre());
  State moving = joined("A");
  moving.driving = true;
  EXPECT_EQ(row.dialog.hear(moving, told), Dialog::Heard::Nothing);
  State with_order = joined("A");
  with_order.node_states = {{"B", 2, true}};
  EXPECT_EQ(row.dialog.hear(with_order, told), Dialog::Heard::Nothing);
  EXPECT_EQ(row.dialog.hear(joined("A", "join 0.0"), told), Dialog::Heard::Nothing) << "of a way before";
  EXPECT_EQ(row.dialog.hear(joined("A"), told), Dialog::Heard::OfWay);
  EXPECT_EQ(std::tuple(told.stands, told.station, told.way.agv_boot), std::tuple(true, 0U, 1U));
  EXPECT_FALSE(row.dialog.barrier().has_value());
}

TEST(Vda5050Dialog, TheBaseGrowsByUpdatesOneAtATime) {
  JoinedRow row;
  EXPECT_TRUE(row.dialog.send(0, {drive(0), pick(7)}));
  EXPECT_EQ(text_of(row.dialog.order()), "0.1.1 update 0: 0 A, 1 ab, 2 B pick 0.1.1/1");
  EXPECT_FALSE(row.dialog.send(2, {drive(2)})) << "the vehicle may not have it";
  EXPECT_EQ(row.hear(standing("A")).known, 0U);
  EXPECT_EQ(row.hear(under_way("0.1.1", 0, "A", 0)).known, 2U);
  EXPECT_EQ(text_of(row.dialog.order()), "none");
  EXPECT_TRUE(row.dialog.send(2, {drive(2)}));
  EXPECT_EQ(text_of(row.dialog.order()), "0.1.1 update 1: 2 B pick 0.1.1/1, 3 segment 1, 4 C")
      << "the last node of the base, as it was sent";
  State at_b = under_way("0.1.1", 0, "B", 2);
  EXPECT_EQ(row.hear(at_b).done, 1U);
  at_b.action_states = {{"0.1.1/1", {}, ActionStatus::Running, {}}};
  EXPECT_EQ(row.hear(at_b).done, 1U);
  at_b.action_states = {{"0.1.1/1", {}, ActionStatus::Finished, {}}};
  EXPECT_EQ(row.hear(at_b).done, 2U);
  EXPECT_EQ(row.hear(under_way("0.1.1", 1, "C", 4)).known, 3U);
}

TEST(Vda5050Dialog, TransfersWhereItStandsBeginALeg) {
  JoinedRow row;
  EXPECT_TRUE(row.dialog.send(0, {drive(0)}));
  row.hear(under_way("0.1.1", 0, "A", 0));
  EXPECT_FALSE(row.dialog.send(1, {pick(7), drive(1)})) << "it has to be there first";
  row.hear(under_way("0.1.1", 0, "B", 2));
  EXPECT_TRUE(row.dialog.send(1, {pick(7), drive(1)}));
  EXPECT_EQ(text_of(row.dialog.order()), "0.1.2 update 0: 0 B pick 0.1.2/0, 1 ab, 2 A");
  EXPECT_EQ(row.hear(under_way("0.1.1", 0, "B", 2)).known, 1U) << "it has the leg before";
  EXPECT_EQ(row.hear(under_way("0.1.2", 0, "B", 0)).known, 3U);
}

TEST(Vda5050Dialog, AVehicleThatHasForgottenItsOrderBeginsAgain) {
  JoinedRow row;
  EXPECT_EQ(row.heard(standing("A")), Dialog::Heard::OfWay);
  row.dialog.send(0, {drive(0)});
  EXPECT_EQ(row.heard(standing("A")), Dialog::Heard::OfWay) << "it may not have it yet";
  EXPECT_EQ(row.heard(standing("B")), Dialog::Heard::BeganAgain) << "it had it";
  row.hear(under_way("0.1.1", 0, "B", 2));
  EXPECT_EQ(row.heard(standing("B")), Dialog::Heard::BeganAgain);
  row.dialog.send(1, {pick(7)});
  EXPECT_EQ(row.heard(standing("B")), Dialog::Heard::BeganAgain);
  EXPECT_EQ(row.heard(under_way("other", 0, "B", 2)), Dialog::Heard::BeganAgain) << "of another master";
  EXPECT_EQ(row.heard(standing("elsewhere")), Dialog::Heard::Nothing);
}

TEST(Vda5050Dialog, ANewSelfOfTheMasterGoesOnWithTheLeg) {
  JoinedRow row;
  row.dialog.send(0, {drive(0), pick(7)});
  row.hear(under_way("0.1.1", 0, "A", 0));
  row.dialog.send(2, {drive(2)});
  Dialog next(row.map, row.names);
  next.recall({0, 1}, row.dialog.leg(), 0);
  EXPECT_EQ(text_of(next.order()), text_of(row.dialog.order())) << "the update is sent again";
  agents::central::State told;
  EXPECT_EQ(next.hear(under_way("0.1.1", 1, "B", 2), told), Dialog::Heard::OfWay);
  EXPECT_EQ(std::pair(told.known, told.done), std::pair(3U, 1U));
}

TEST(PlantNames, LeadBack) {
  Row row;
  for (std::uint32_t station = 0; station < 3; ++station)
    EXPECT_EQ(row.names.station_of(row.names.node_id(station)), station);
  for (std::uint32_t lane = 0; lane < row.map.lane_count(); ++lane)
    EXPECT_EQ(row.names.lane_of(row.names.edge_id(lane), row.names.node_id(row.map.lane(lane).from),
                                row.names.node_id(row.map.lane(lane).to)),
              lane);
  EXPECT_EQ(row.names.lane_of("ab", "A", "C"), std::nullopt);
  EXPECT_EQ(agv_of(serial_number(7), 8), 7U);
  for (const char* wrong : {"agv8", "agv", "agv-1", "agv1x", "AGV1"})
    EXPECT_EQ(agv_of(wrong, 8), std::nullopt) << wrong;
}

TEST(Headings, AreAnglesAndBack) {
  for (int i = -720; i <= 720; ++i) {
    const double angle = i * std::numbers::pi / 720.0;
    const agents::Vec heading = heading_of(angle);
    EXPECT_NEAR(heading.x, std::cos(angle), 1e-14) << i;
    EXPECT_NEAR(heading.y, std::sin(angle), 1e-14) << i;
    if (std::abs(i) < 720) {
      EXPECT_NEAR(theta_of({std::cos(angle), std::sin(angle)}), angle, 1e-14) << i;
    }
  }
  EXPECT_EQ(std::abs(theta_of({-1.0, 0.0})), std::numbers::pi);
  EXPECT_EQ(theta_of({0.0, 1.0}), std::numbers::pi / 2.0);
}

}  // namespace
}  // namespace fleetproof::vda5050_dialog_test
