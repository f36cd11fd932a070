// Reports that the model of an AGV judges, and the sequences that are drawn for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/support/vda5050_model.hpp"
#include "tests/support/vda5050_sequences.hpp"

namespace fleetproof::test::vda5050_model::vda5050_sequences_test {
namespace {

using enum Status;
using Kind = Input::Kind;

VehicleTraits at_f() {
  VehicleTraits traits;
  traits.start_node = "f";
  return traits;
}

Input order_of_two_nodes() {
  Input input;
  input.text =
      write_order({"1234", 0, {{"f", 0, true, {}, {}}, {"d", 2, true, {}, {}}}, {{"e", "f", "d", 1, true, {}}}}, {});
  return input;
}

Input instant_action(const std::string& type, const std::string& id) {
  Input input;
  input.kind = Kind::InstantActions;
  input.text = write_instant_actions({{id, type, Blocking::None}}, {});
  return input;
}

Input action_begun(const std::string& id) {
  Input input;
  input.kind = Kind::ActionBegun;
  input.action_id = id;
  return input;
}

using Choose = std::function<Status(const StatusSet&)>;

// What an AGV says that takes one alternative, and for each action one of its statuses.
Report report_of(const Alternative& state, const Choose& choose) {
  Report report;
  report.order_id = state.order_id;
  report.order_update_id = state.order_update_id;
  report.last = state.last;
  report.nodes = state.nodes;
  report.edges = state.edges;
  for (const auto& [id, statuses] : state.actions) report.actions[id] = choose(statuses);
  for (const ExpectedError& error : state.errors) {
    if (error.must) report.errors.push_back({*error.types.begin(), "WARNING", error.references});
    if (error.must && error.any_reference) report.errors.back().references["actionType"] = "fly";
  }
  report.paused = *state.paused.begin();
  report.drives = state.drivable_edges;
  report.published = report.sent_factsheet = report.announced_online = true;
  return report;
}

Status first_of(const StatusSet& statuses) { return *statuses.begin(); }

TEST(Vda5050Judge, FollowsTheChoiceThatAReportShows) {
  VehicleModel model(at_f());
  const Expectation said = model.apply(order_of_two_nodes());
  const auto at_once = std::ranges::find_if(said.alternatives, [](const auto& a) { return a.nodes.size() == 1; });
  ASSERT_NE(at_once, said.alternatives.end());
  EXPECT_TRUE(model.judge(report_of(*at_once, first_of)).empty());
  EXPECT_EQ(model.plain_state().order.nodes.front().id, "d");
}

TEST(Vda5050Judge, FindsEveryFieldThatDiffers) {
  const std::vector<std::function<void(Report&)>> faults{
      [](Report& r) { r.order_id = "5678"; },
      [](Report& r) { r.order_update_id = 1; },
      [](Report& r) { r.last.sequence = 8; },
      [](Report& r) { r.nodes.pop_back(); },
      [](Report& r) { r.edges.front().released = false; },
      [](Report& r) { r.actions["ghost"] = Running; },
      [](Report& r) {
        r.errors.push_back({"orderError", "WARNING", {}});
      },
      [](Report& r) { r.paused = true; },
      [](Report& r) {
        r.drives = std::vector<std::uint32_t>{1, 3};
      },
      [](Report& r) { r.published = false; },
  };
  for (const auto& fault : faults) {
    VehicleModel model(at_f());
    Report report = report_of(model.apply(order_of_two_nodes()).alternatives.front(), first_of);
    VehicleModel untouched = model;
    EXPECT_TRUE(untouched.judge(report).empty());
    fault(report);
    EXPECT_EQ(model.judge(report).size(), 1U) << &fault - faults.data();
  }
}

TEST(Vda5050Judge, FindsAMissingError) {
  VehicleModel model(at_f());
  Report report = report_of(model.apply(instant_action("cancelOrder", "c")).alternatives.front(), first_of);
  report.errors.clear();
  EXPECT_EQ(model.judge(report), std::vector<std::string>{"no error noOrderToCancel actionId=c"});
}

TEST(Vda5050Judge, FindsAStatusThatGoesBack) {  // Figure 16
  VehicleModel model(at_f());
  const Expectation said = model.apply(instant_action("beep", "i"));
  Report report = report_of(said.alternatives.front(), [](const StatusSet&) { return Running; });
  EXPECT_TRUE(model.judge(report).empty());
  model.apply(action_begun("i"));
  report.actions["i"] = Initializing;
  EXPECT_FALSE(model.judge(report).empty());
}

TEST(Vda5050Judge, FindsAnActionThatWaitsAgain) {  // Figure 16: no arrow leads to WAITING
  VehicleModel model(at_f());
  Input soft = instant_action("beep", "i");
  soft.text = write_instant_actions({{"i", "beep", Blocking::Soft}}, {});
  Report report = report_of(model.apply(soft).alternatives.front(), first_of);
  ASSERT_EQ(report.actions["i"], Waiting);
  report.actions["i"] = Initializing;
  EXPECT_TRUE(model.judge(report).empty());
  model.apply(instant_action("stateRequest", "s"));
  report.actions["s"] = Finished;
  report.actions["i"] = Waiting;
  EXPECT_FALSE(model.judge(report).empty());
}

TEST(Vda5050Judge, TakesAnActionAsBegunThatIsReportedAsRunning) {  // so a cancel cannot fail it (6.6.3)
  VehicleModel model(at_f());
  Input order;
  order.text = write_order({"1234", 0, {{"f", 0, true, {}, {{"a", "pick", Blocking::Hard}}}}, {}}, {});
  const Expectation said = model.apply(order);
  const auto at_once = std::ranges::find_if(said.alternatives, [](const auto& a) { return a.nodes.empty(); });
  ASSERT_NE(at_once, said.alternatives.end());
  EXPECT_TRUE(model.judge(report_of(*at_once, [](const StatusSet&) { return Running; })).empty());
  const Expectation cancelled = model.apply(instant_action("cancelOrder", "c"));
  EXPECT_EQ(cancelled.alternatives.front().actions.at("a"), StatusSet{Running});
}

TEST(Vda5050Judge, FindsACancelThatFinishesTooEarly) {  // 6.6.3
  VehicleModel model(at_f());
  model.apply(order_of_two_nodes());
  Report report = report_of(model.apply(instant_action("cancelOrder", "c")).alternatives.front(), first_of);
  report.actions["c"] = Finished;
  EXPECT_FALSE(model.judge(report).empty());
}

TEST(Vda5050Judge, FindsAPauseThatFinishesWithoutEffect) {  // 6.8.2
  VehicleModel model(at_f());
  Report report = report_of(model.apply(instant_action("startPause", "p")).alternatives.front(), first_of);
  report.actions["p"] = Finished;
  report.paused = false;
  EXPECT_EQ(model.judge(report), std::vector<std::string>{"startPause has finished without effect"});
}

TEST(Vda5050Judge, FindsAChangeWithoutAMessage) {  // 6.10: "change in the nodeStates, edgeStates or actionStates"
  VehicleModel model(at_f());
  Report report = report_of(model.apply(instant_action("beep", "i")).alternatives.front(), first_of);
  EXPECT_TRUE(model.judge(report).empty());
  Input nothing;
  nothing.kind = Kind::Stopped;
  nothing.node_id = "f";
  EXPECT_FALSE(model.apply(nothing).alternatives.front().must_publish);
  report.actions["i"] = Running;
  report.published = false;
  EXPECT_EQ(model.judge(report), std::vector<std::string>{"states changed without a message"});
}

TEST(Vda5050Judge, ReadsAStateMessage) {  // 6.10.6
  const Report report = read_report(R"({"orderId":"o","orderUpdateId":2,"lastNodeId":"f","lastNodeSequenceId":4,
    "nodeStates":[{"nodeId":"d","sequenceId":6,"released":true}],
    "edgeStates":[{"edgeId":"e","sequenceId":5,"released":true}],
    "actionStates":[{"actionId":"a","actionStatus":"RUNNING"}],
    "errors":[{"errorType":"orderError","errorLevel":"WARNING",
               "errorReferences":[{"referenceKey":"nodeId","referenceValue":"d"}]}],
    "paused":true})");
  EXPECT_EQ(report.last, (LastNode{"f", 4}));
  EXPECT_EQ(report.actions.at("a"), Running);
  EXPECT_EQ(report.errors.front().references.at("nodeId"), "d");
  EXPECT_EQ(report.paused, true);
  EXPECT_THROW(read_report("{}"), std::runtime_error);
}

// ---- drawn sequences

struct Tally {
  std::map<std::string, int> inputs, choices, statuses;
  std::size_t most_alternatives = 0;
};

// An AGV that takes any alternative and any status that is allowed.
class FickleVehicle {
 public:
  explicit FickleVehicle(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) {
    random_ = random_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(random_ >> 33U) % n;
  }

  Report report(const Alternative& chosen, const VehicleModel& model) {
    Report drawn = report_of(chosen, [&](const StatusSet& set) {
      return *std::next(set.begin(), static_cast<std::ptrdiff_t>(below(set.size())));
    });
    if (VehicleModel(model).judge(drawn).empty()) return drawn;
    // A FINISHED promised too much: such a choice is none.
    return report_of(chosen, first_of);
  }

 private:
  std::uint64_t random_;
};

void play(const VehicleTraits& traits, std::uint64_t seed, Tally& tally) {
  VehicleModel model(traits);
  SequenceSettings settings;
  settings.seed = seed;
  settings.actions_continue_in_pause = seed % 3 == 0;
  SequenceDrawer drawer(traits, settings);
  FickleVehicle vehicle(seed);
  while (const auto input = drawer.next(model)) {
    ++tally.inputs[std::string(name_of(input->kind))];
    const Expectation said = model.apply(*input);
    tally.most_alternatives = std::max(tally.most_alternatives, said.alternatives.size());
    const Alternative& chosen = said.alternatives[vehicle.below(said.alternatives.size())];
    ++tally.choices[chosen.why];
    for (const auto& [id, statuses] : chosen.actions) ASSERT_FALSE(statuses.empty()) << id << " after " << chosen.why;
    const Report report = vehicle.report(chosen, model);
    for (const auto& [id, status] : report.actions) ++tally.statuses[std::string(name_of(status))];
    const std::vector<std::string> findings = model.judge(report);
    ASSERT_TRUE(findings.empty()) << "seed " << seed << ", " << chosen.why << ": " << findings.front();
  }
}

TEST(Vda5050Sequences, LeaveSomethingAllowedAfterEveryInput) {
  Tally tally;
  for (const Version version : {Version::V2_0_0, Version::V2_1_0}) {
    for (const bool stops_between_nodes : {false, true}) {
      for (std::uint64_t seed = 0; seed < 500; ++seed) play(grid_traits(version, stops_between_nodes), seed, tally);
    }
  }
  EXPECT_EQ(tally.inputs.size(), 12U) << "every kind of input";
  EXPECT_EQ(tally.statuses.size(), 6U) << "every status";
  EXPECT_LE(tally.most_alternatives, 16U);
  for (const char* choice :
       {"new order, first node ahead", "new order, first node counts as traversed", "update accepted",
        "update rejected", "repeated order ignored", "new order rejected: still executing",
        "new order rejected: first node out of reach", "order with an unknown action", "restarted with order",
        "cancelled: states are deleted", "cancelled: drives to the next node, whose edge is kept"}) {
    EXPECT_GE(tally.choices[choice], 50) << choice;
  }
}

TEST(Vda5050Sequences, AreTheSameForOneSeedAndOthersForAnother) {
  const VehicleTraits traits = grid_traits(Version::V2_1_0, true);
  const auto texts = [&](std::uint64_t seed) {
    SequenceSettings settings;
    settings.seed = seed;
    std::vector<std::string> drawn;
    for (const Input& input : draw_sequence(traits, settings)) drawn.push_back(input.text + input.action_id);
    return drawn;
  };
  EXPECT_EQ(texts(7).size(), SequenceSettings{}.steps);
  EXPECT_EQ(texts(7), texts(7));
  EXPECT_NE(texts(7), texts(8));
}

}  // namespace
}  // namespace fleetproof::test::vda5050_model::vda5050_sequences_test
