#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "tests/support/vda5050_model.hpp"

// What a report says against what the model allows.
namespace fleetproof::test::vda5050_model {
namespace {

using enum Status;
using Findings = std::vector<std::string>;

constexpr std::array<std::string_view, 12> kKindNames{
    "order",           "instant actions", "node reached",        "edge entered",
    "stopped",         "action begun",    "action finished",     "action failed",
    "pause effective", "connection lost", "connection restored", "restarted"};

// Errors of these types say something about an order, so they must be expected. The AGV may report others.
const std::set<std::string> kOrderErrors{"validationError", "orderError", "orderUpdateError", "noOrderToCancel",
                                         "noRouteError"};

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string shown(const StatusSet& set) {
  std::string text;
  for (const Status status : set) text += (text.empty() ? "" : "|") + std::string(name_of(status));
  return text;
}

std::string shown(const LastNode& node) { return node.id + "#" + std::to_string(node.sequence); }

template <class Element>
std::string shown_path(const Element& elements) {
  std::string text;
  for (const auto& element : elements) {
    text += " " + element.id + "#" + std::to_string(element.sequence) + (element.released ? "" : "?");
  }
  return "[" + text + " ]";
}

template <class Expected, class Reported>
bool same_path(const Expected& expected, const Reported& reported) {
  return std::ranges::equal(expected, reported, [](const auto& a, const auto& b) {
    return a.id == b.id && a.sequence == b.sequence && a.released == b.released;
  });
}

void compare_order(const Alternative& allowed, const Report& report, Findings& findings) {
  if (allowed.order_id != report.order_id)
    findings.push_back("orderId " + in_quotes(report.order_id) + ", not " + in_quotes(allowed.order_id));
  if (allowed.order_update_id != report.order_update_id)
    findings.push_back("orderUpdateId " + std::to_string(report.order_update_id) + ", not " +
                       std::to_string(allowed.order_update_id));
  if (!(allowed.last == report.last))
    findings.push_back("last node " + shown(report.last) + ", not " + shown(allowed.last));
  if (!same_path(allowed.nodes, report.nodes))
    findings.push_back("nodeStates " + shown_path(report.nodes) + ", not " + shown_path(allowed.nodes));
  if (!same_path(allowed.edges, report.edges))
    findings.push_back("edgeStates " + shown_path(report.edges) + ", not " + shown_path(allowed.edges));
}

void compare_actions(const Alternative& allowed, const Report& report, Findings& findings) {
  for (const auto& [id, statuses] : allowed.actions) {
    const auto found = report.actions.find(id);
    if (found == report.actions.end()) {
      if (!allowed.actions_that_may_be_absent.contains(id)) findings.push_back("no actionState of " + in_quotes(id));
    } else if (!statuses.contains(found->second)) {
      findings.push_back("action " + in_quotes(id) + " is " + std::string(name_of(found->second)) + ", not " +
                         shown(statuses));
    }
  }
  for (const auto& [id, status] : report.actions) {
    if (!allowed.actions.contains(id)) findings.push_back("unexpected actionState of " + in_quotes(id));
  }
}

bool matches(const ExpectedError& expected, const ReportedError& reported) {
  if (!expected.types.contains(reported.type)) return false;
  if (expected.any_reference && reported.references.empty()) return false;
  return std::ranges::all_of(expected.references, [&](const auto& reference) {
    const auto found = reported.references.find(reference.first);
    return found != reported.references.end() && found->second == reference.second;
  });
}

void compare_errors(const Alternative& allowed, const Report& report, Findings& findings) {
  for (const ExpectedError& expected : allowed.errors) {
    if (!expected.must) continue;
    if (std::ranges::none_of(report.errors, [&](const auto& error) { return matches(expected, error); })) {
      std::string types;
      for (const std::string& type : expected.types) types += (types.empty() ? "" : "|") + type;
      for (const auto& [key, value] : expected.references) types += " " + key + "=" + value;
      findings.push_back("no error " + types);
    }
  }
  for (const ReportedError& error : report.errors) {
    if (!kOrderErrors.contains(error.type)) continue;
    if (error.level != "WARNING") findings.push_back(error.type + " has the level " + error.level);
    if (std::ranges::none_of(allowed.errors, [&](const auto& expected) { return matches(expected, error); }))
      findings.push_back("unexpected error " + error.type);
  }
}

void compare_flags(const Alternative& allowed, const Report& report, Findings& findings) {
  if (report.paused && !allowed.paused.contains(*report.paused))
    findings.push_back(*report.paused ? "paused" : "not paused");
  if (report.new_base_request.value_or(false) && !allowed.new_base_request_allowed)
    findings.push_back("requests a new base without an order");
  if (allowed.must_publish && !report.published) findings.push_back("no state message");
  for (const std::uint32_t edge : report.drives.value_or(std::vector<std::uint32_t>{})) {
    if (std::ranges::find(allowed.drivable_edges, edge) == allowed.drivable_edges.end())
      findings.push_back("would drive on edge #" + std::to_string(edge));
  }
}

bool is_over_in(const Report& report, const std::string& id) {
  const auto found = report.actions.find(id);
  return found == report.actions.end() || found->second == Finished || found->second == Failed;
}

// What a FINISHED promises: after a cancel, that nothing of the order is left (6.6.3); after a pause, that it is in
// force (6.8.2).
void check_promises(const State& state, const Report& report, Findings& findings) {
  for (const TrackedAction& control : state.actions) {
    const auto found = report.actions.find(control.action.id);
    if (control.scope != Scope::Control || is_over(control) || found == report.actions.end()) continue;
    if (found->second != Finished) continue;
    if (control.action.type == kCancelOrder) {
      if (!report.nodes.empty() || !report.edges.empty())
        findings.push_back("cancelOrder has finished before node and edge states are deleted");
      for (const TrackedAction& action : state.actions) {
        if (is_order_action(action) && !is_over_in(report, action.action.id))
          findings.push_back("cancelOrder has finished before action " + in_quotes(action.action.id));
      }
    } else if (report.paused && state.pause.requested == (control.action.type == kStartPause)) {
      const bool promised = control.action.type == kStartPause;
      if (*report.paused != promised) findings.push_back(control.action.type + " has finished without effect");
    }
  }
}

bool differs(const Report& a, const Report& b) {
  return !same_path(a.nodes, b.nodes) || !same_path(a.edges, b.edges) || a.actions != b.actions;
}

// What a reported status says of the phase. A status may run ahead of the facts.
void keep_status(State& state, TrackedAction& action, Status status) {
  action.seen = status;
  if (status == Finished || status == Failed) {
    action.phase = Phase::Over;
    action.may_be = {status};
    return;
  }
  if (action.scope == Scope::Control || (status != Running && status != Initializing)) return;
  if (action.phase == Phase::Untriggered) action.trigger = ++state.triggers;
  if (status == Running) action.phase = Phase::Begun;
  if (action.phase == Phase::Untriggered) action.phase = Phase::Triggered;
}

void keep_choices(State& state, const Report& report) {
  std::erase_if(state.actions, [&](const TrackedAction& action) { return !report.actions.contains(action.action.id); });
  bool cancelled = false;
  std::optional<bool> paused;
  for (TrackedAction& action : state.actions) {
    const Status status = report.actions.at(action.action.id);
    const std::string& type = action.action.type;
    const bool ends = action.scope == Scope::Control && !is_over(action) && status == Finished;
    cancelled |= ends && type == kCancelOrder && state.order.cancel == Cancel::Running;
    if (ends && (type == kStartPause || type == kStopPause)) paused = type == kStartPause;
    keep_status(state, action, status);
  }
  if (cancelled) {
    state.order.cancel = Cancel::Done;
    state.body.motion = Motion::Standing;
  }
  if (paused && state.pause.requested == paused) settle_pause(state, *paused);
  if (report.paused && !state.pause.known) {
    state.pause.paused = *report.paused;
    state.pause.known = true;
  }
}

// Choices that a report has not told apart and that allow the same from now on are one.
void add_if_new(std::vector<VehicleModel::Possible>& list, VehicleModel::Possible possible) {
  const auto same = [&](const VehicleModel::Possible& other) {
    return other.must_publish == possible.must_publish && is_same(other.state, possible.state);
  };
  if (std::ranges::none_of(list, same)) list.push_back(std::move(possible));
}

Alternative alternative_of(const VehicleModel::Possible& possible, const VehicleTraits& traits) {
  const State& state = possible.state;
  Alternative allowed;
  allowed.order_id = state.order.id;
  allowed.order_update_id = state.order.update;
  allowed.last = state.order.last;
  allowed.nodes.assign(state.order.nodes.begin(), state.order.nodes.end());
  allowed.edges.assign(state.order.edges.begin(), state.order.edges.end());
  for (const TrackedAction& action : state.actions) {
    allowed.actions[action.action.id] = allowed_statuses(state, action);
    if (action.may_be_absent) allowed.actions_that_may_be_absent.insert(action.action.id);
  }
  allowed.errors = state.errors;
  allowed.paused = {state.pause.paused};
  if (!state.pause.known || state.pause.requested) allowed.paused = {false, true};
  // 6.10.6: "false": no base update required; without nodes ahead there is no base that runs low.
  allowed.new_base_request_allowed = !state.order.nodes.empty() && state.order.cancel == Cancel::No;
  allowed.drivable_edges = drivable_edges(state, traits);
  allowed.must_publish = possible.must_publish;
  allowed.why = state.why;
  return allowed;
}

using nlohmann::json;

std::map<std::string, std::string> references_of(const json& error) {
  std::map<std::string, std::string> references;
  for (const json& reference : error.value("errorReferences", json::array())) {
    const json& value = reference.at("referenceValue");
    references[reference.at("referenceKey").get<std::string>()] =
        value.is_string() ? value.get<std::string>() : value.dump();
  }
  return references;
}

Report report_of(const json& state) {
  Report report;
  report.order_id = state.at("orderId").get<std::string>();
  report.order_update_id = state.at("orderUpdateId").get<std::uint32_t>();
  report.last = {state.at("lastNodeId").get<std::string>(), state.at("lastNodeSequenceId").get<std::uint32_t>()};
  for (const json& node : state.at("nodeStates")) {
    report.nodes.push_back({node.at("nodeId").get<std::string>(), node.at("sequenceId").get<std::uint32_t>(),
                            node.at("released").get<bool>()});
  }
  for (const json& edge : state.at("edgeStates")) {
    report.edges.push_back({edge.at("edgeId").get<std::string>(), "", edge.at("sequenceId").get<std::uint32_t>(),
                            edge.at("released").get<bool>()});
  }
  for (const json& action : state.at("actionStates")) {
    const auto status = status_of(action.at("actionStatus").get<std::string>());
    if (!status) throw std::runtime_error("actionStatus " + action.at("actionStatus").dump());
    if (!report.actions.emplace(action.at("actionId").get<std::string>(), *status).second)
      throw std::runtime_error("two actionStates of " + action.at("actionId").dump());
  }
  for (const json& error : state.at("errors")) {
    report.errors.push_back(
        {error.at("errorType").get<std::string>(), error.at("errorLevel").get<std::string>(), references_of(error)});
  }
  if (state.contains("paused")) report.paused = state.at("paused").get<bool>();
  if (state.contains("newBaseRequest")) report.new_base_request = state.at("newBaseRequest").get<bool>();
  return report;
}

}  // namespace

std::string_view name_of(Input::Kind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

Report read_report(std::string_view state_document) {
  try {
    return report_of(json::parse(state_document));
  } catch (const json::exception& broken) {
    throw std::runtime_error(std::string("no state message: ") + broken.what());
  }
}

VehicleModel::VehicleModel(VehicleTraits traits) : traits_(std::move(traits)) {
  State state;
  state.body.on_node = traits_.start_node;
  state.body.position = traits_.start_position;
  state.why = "at the beginning";
  // 6.10.6: lastNodeId is the current node if the AGV stands on one; "" if none is available.
  State located = state;
  located.order.last = {traits_.start_node, 0};
  possible_.push_back({located, false});
  if (!traits_.start_node.empty()) possible_.push_back({state, false});
  for (const Possible& possible : possible_) expected_.alternatives.push_back(alternative_of(possible, traits_));
}

Expectation VehicleModel::apply(const Input& input) {
  std::vector<Possible> after;
  expected_ = {};
  for (const Possible& possible : possible_) {
    Consequence consequence = consequence_of(possible.state, input, traits_);
    for (Possible& one : consequence.possible) add_if_new(after, std::move(one));
    expected_.must_send_factsheet |= consequence.must_send_factsheet;
    expected_.must_announce_online |= consequence.must_announce_online;
  }
  possible_ = std::move(after);
  for (const Possible& possible : possible_) expected_.alternatives.push_back(alternative_of(possible, traits_));
  return expected_;
}

std::vector<std::string> VehicleModel::judge(const Report& report) {
  std::vector<Possible> agreeing;
  std::vector<Findings> all_findings;
  for (std::size_t i = 0; i < possible_.size(); ++i) {
    const Alternative& allowed = expected_.alternatives[i];
    const State& state = possible_[i].state;
    Findings findings;
    compare_order(allowed, report, findings);
    compare_actions(allowed, report, findings);
    compare_errors(allowed, report, findings);
    compare_flags(allowed, report, findings);
    check_promises(state, report, findings);
    if (expected_.must_send_factsheet && !report.sent_factsheet) findings.push_back("no factsheet");
    if (expected_.must_announce_online && !report.announced_online) findings.push_back("no connection message");
    // 6.10: "change in the nodeStates, edgeStates or actionStates".
    if (before_ && state.body.online && !report.published && differs(*before_, report))
      findings.push_back("states changed without a message");
    if (findings.empty()) agreeing.push_back(possible_[i]);
    all_findings.push_back(std::move(findings));
  }
  before_ = report;
  if (agreeing.empty()) {
    const auto nearest = std::ranges::min_element(all_findings, {}, &Findings::size);
    const auto index = static_cast<std::size_t>(nearest - all_findings.begin());
    possible_ = {possible_[index]};
    expected_.alternatives = {expected_.alternatives[index]};
    return *nearest;
  }
  possible_.clear();
  expected_.alternatives.clear();
  for (Possible& possible : agreeing) {
    keep_choices(possible.state, report);
    add_if_new(possible_, std::move(possible));
  }
  for (const Possible& possible : possible_) expected_.alternatives.push_back(alternative_of(possible, traits_));
  return {};
}

void VehicleModel::assume_plain_reading() {
  possible_.resize(1);
  expected_.alternatives.resize(1);
}

}  // namespace fleetproof::test::vda5050_model
