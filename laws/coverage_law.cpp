#include "laws/coverage_law.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/clearance/clearance_over_time.hpp"
#include "core/clearance/swept_region.hpp"
#include "core/outcome/trace_records.hpp"
#include "laws/driven_ways.hpp"
#include "laws/episode.hpp"

namespace fleetproof {
namespace {

constexpr double kNearMiss_m = 0.3;
constexpr Duration kSameNearMiss = std::chrono::seconds(1);

class CoverageLaw final : public Law {
 public:
  explicit CoverageLaw(const Scenario& scenario)
      : margin_m_(violation_threshold_m(scenario.law)),
        agv_count_(scenario.agvs.size()),
        ways_(*scenario.map, scenario.agvs.size(), margin_m_) {
    for (const Fault& fault : scenario.faults) words_.push_back(fault.word);
  }

  double looks_within_m() const override { return kNearMiss_m; }
  void had_company(const Piece& piece, std::span<const Piece* const> others) override;
  Pieces hears_pieces() const override { return Pieces::Beginnings; }
  void piece_started(const Piece& piece) override {
    if (piece.entity.index() >= agv_count_) return;
    piece.manner == Manner::Drive ? ways_.begins(piece) : ways_.ends(piece.entity, piece.begin);
  }
  TraceKinds reads() const override { return {TraceKind::FaultStrikes}; }
  void happened(const TraceRecord& record) override {
    const auto [kind, number] = read<traced::FaultStrikes>(record);
    ++faults_[{kind, kind == Fault::Kind::Named ? words_.at(number) : ""}];
  }
  void finish(SimTime end) override;
  LawResults findings() const override;

 private:
  // The nearness of a pair under way, or the last one.
  struct Near {
    SimTime until = kStart;
    bool is_miss = true;  // they have kept the safety distance
  };
  void look_closer(const Piece& a, const Piece& b, Interval within);
  void close(const Near& near) { near_misses_ += near.is_miss; }

  double margin_m_;
  std::size_t agv_count_;
  DrivenWays ways_;
  std::map<std::pair<EntityId, EntityId>, Near> near_;
  std::uint64_t near_misses_ = 0;
  std::vector<std::string> words_;                                       // of the faults of the scenario
  std::map<std::pair<Fault::Kind, std::string>, std::uint64_t> faults_;  // and words
  EvaluationCount evaluations_;
};

void CoverageLaw::had_company(const Piece& piece, std::span<const Piece* const> others) {
  const std::size_t mine = piece.entity.index();
  if (mine >= agv_count_) return;
  const Box near = piece.planned_box.grown(kNearMiss_m);
  for (const Piece* const other : others) {
    const std::size_t its = other->entity.index();
    if (its >= agv_count_ || !near.overlaps(other->planned_box)) continue;
    const Interval common{std::max(piece.begin, other->begin), piece.end};
    if (common.begin >= common.end || (piece.manner == Manner::Rest && other->manner == Manner::Rest)) continue;
    if (mine < its) {
      look_closer(piece, *other, common);
    } else {
      look_closer(*other, piece, common);
    }
  }
}

void CoverageLaw::look_closer(const Piece& a, const Piece& b, Interval within) {
  const auto part = near_part(a, b, within, kNearMiss_m);
  const auto from = part ? comes_below(a, b, *part, kNearMiss_m, evaluations_) : std::nullopt;
  if (!from) return;
  Near& near = near_.try_emplace({a.entity, b.entity}, Near{within.end}).first->second;
  if (within.begin - near.until > kSameNearMiss) {
    close(near);
    near = {};
  }
  near.until = std::max(near.until, within.end);
  near.is_miss = near.is_miss && !comes_below(a, b, {*from, part->end}, margin_m_, evaluations_);
}

void CoverageLaw::finish(SimTime) {
  for (const auto& [pair, near] : near_) close(near);
}

LawResults CoverageLaw::findings() const {
  LawResults findings;
  findings.met.reserve(kEncounterKinds + kSceneKinds + 1 + faults_.size());
  const auto met = [&](std::string name, std::uint64_t count) {
    findings.met.push_back({ProbeSource::World, std::move(name), count});
  };
  const auto [encounters, scenes] = ways_.meetings();
  for (std::size_t i = 0; i < kEncounterKinds; ++i) met(name_of(static_cast<EncounterKind>(i)), encounters[i]);
  for (std::size_t i = 0; i < kSceneKinds; ++i) {
    if (scenes[i] > 0) met(name_of(static_cast<SceneKind>(i)), scenes[i]);
  }
  met(std::string(kNearMissProbe), near_misses_);
  for (const auto& [fault, count] : faults_) met(probe_name(fault.first, fault.second), count);
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_coverage_law(const Scenario& scenario) { return std::make_unique<CoverageLaw>(scenario); }

}  // namespace fleetproof
