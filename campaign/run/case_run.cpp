#include "campaign/run/case_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/engine/simulation.hpp"
#include "core/outcome/note_records.hpp"
#include "laws/laws.hpp"

namespace fleetproof {
namespace {

// What each agent declared, with the instants.
class Declarations {
 public:
  void record(const TraceRecord& record, std::string_view text) {
    if (record.kind == TraceKind::AgentState) {
      auto& past = states_[record.entity];
      if (past.empty() || past.back().second != text) past.emplace_back(record.at, text);
    }
    if (record.kind == TraceKind::AgentState || record.kind == TraceKind::Probe)
      first_.try_emplace({record.entity, std::string(text)}, record.at);
  }

  // States and probes until `t`.
  std::vector<std::string> words(const std::vector<EntityId>& agvs, SimTime t) const {
    std::set<std::string> said;
    for (const auto& [key, at] : first_) {
      const bool counts = agvs.empty() || std::ranges::find(agvs, key.first) != agvs.end();
      if (counts && at <= t && !key.second.empty()) said.insert(key.second);
    }
    return {said.begin(), said.end()};
  }

  std::vector<Declared> first() const {
    std::vector<Declared> first;
    for (const auto& [key, at] : first_) {
      if (!key.second.empty()) first.push_back({key.first, key.second, at});
    }
    return first;
  }

  // Empty if it had declared nothing.
  std::string state(EntityId agv, SimTime t) const {
    const auto found = states_.find(agv);
    if (found == states_.end()) return {};
    std::string state;
    for (const auto& [at, word] : found->second) {
      if (at <= t) state = word;
    }
    return state;
  }

 private:
  std::map<EntityId, std::vector<std::pair<SimTime, std::string>>> states_;
  std::map<std::pair<EntityId, std::string>, SimTime> first_;
};

// What each AGV does, with the instants.
class Doings {
 public:
  explicit Doings(const LogicalMap& map) : map_(map) {}

  void record(const TraceRecord& record) {
    if (record.kind == TraceKind::ActivityBegins) {
      past_[record.entity].push_back({record.at, kForever, read<traced::ActivityBegins>(record)});
    } else if (record.kind == TraceKind::ActivityEnds && !past_[record.entity].empty()) {
      past_[record.entity].back().end = record.at;
    }
  }

  std::string at(EntityId agv, SimTime t) const {
    const auto found = past_.find(agv);
    if (found == past_.end()) return kStanding;
    std::string doing = kStanding;
    for (const auto& [begin, end, activity] : found->second) {
      if (begin <= t && t <= end) doing = word_of(activity);
    }
    return doing;
  }

 private:
  struct Doing {
    SimTime begin, end;
    traced::ActivityBegins activity;
  };

  const char* word_of(const traced::ActivityBegins& begins) const {
    switch (begins.activity) {
      case ActivityKind::Turn:
        return kTurning;
      case ActivityKind::Drive:
        if (begins.backward()) return kBackward;
        return segment_curve(map_.layout(), map_.segment(begins.segment())).is_straight() ? kDriving : kOnABend;
      case ActivityKind::Pick:
      case ActivityKind::Drop:
        return kTransferring;
      default:
        return kStanding;
    }
  }

  const LogicalMap& map_;
  std::map<EntityId, std::vector<Doing>> past_;
};

class CaseSink final : public TraceSink {
 public:
  CaseSink(const Scenario& scenario, Deliveries wanted)
      : doings(*scenario.map), deliveries(scenario), itinerary(scenario), wanted_(wanted) {}
  void record(const TraceRecord& record, std::string_view text) override {
    declared.record(record, text);
    doings.record(record);
    if (wanted_ != Deliveries::Kept) return;
    deliveries.record(record, text);
    notes.record(record, text);
    itinerary.record(record, text);
  }
  void piece_started(const Piece& piece) override {
    if (wanted_ == Deliveries::Kept) itinerary.piece_started(piece);
  }

  Declarations declared;
  Doings doings;
  DeliveryKeeper deliveries;
  NoteKeeper notes;
  ItineraryKeeper itinerary;

 private:
  Deliveries wanted_;
};

}  // namespace

CaseRun run_case(const Scenario& scenario, const FleetSoftware& software, const std::vector<std::string>& laws_left_out,
                 Deliveries deliveries, const RunWatch& watch, FailureChoice choice) {
  CaseRun run;
  run.choice = choice;
  CaseSink sink(scenario, deliveries);
  const auto laws = make_default_laws(scenario, laws_left_out);
  run.outcome = simulate(scenario, software, laws, &sink, watch);
  if (deliveries == Deliveries::Kept) {
    run.deliveries = sink.deliveries.deliveries();
    run.itinerary = sink.itinerary.take();
  }
  run.all_words = sink.declared.words({}, kForever);
  run.first_said = sink.declared.first();
  const auto cause = chosen_failure(run.outcome, choice);
  if (!cause) return run;
  std::vector<EntityId> agvs;
  for (const EntityId body : {cause->a, cause->b}) {
    if (!body.valid() || body.index() >= scenario.agvs.size()) continue;
    agvs.push_back(body);
    run.doing.push_back(sink.doings.at(body, cause->at));
    std::string state = sink.declared.state(body, cause->at);
    if (!state.empty()) run.states.push_back(std::move(state));
  }
  run.words = sink.declared.words(agvs, cause->at);
  if (deliveries == Deliveries::Kept) run.notes = sink.notes.until(cause->at);
  return run;
}

std::string text_of(const FailureKind& kind) {
  return kind.states.empty() ? kind.what : fmt::format("{} ({})", kind.what, fmt::join(kind.states, ", "));
}

ExpectedOutcome expectation_of(const CaseRun& run) {
  const auto failure = failure_of(run);
  return {failure ? text_of(failure->kind) : "none", run.outcome.digest};
}

std::optional<Failure> failure_of(const CaseRun& run) {
  auto chosen = chosen_failure(run.outcome, run.choice);
  if (!chosen) return std::nullopt;
  Failure failure{{std::move(chosen->what), run.states}, chosen->at, chosen->seen, chosen->a, chosen->b};
  failure.is_violation = chosen->is_violation;
  std::ranges::sort(failure.kind.states);
  return failure;
}

}  // namespace fleetproof
