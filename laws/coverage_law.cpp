#include "laws/coverage_law.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <string>

#include "core/clearance/clearance_over_time.hpp"
#include "core/outcome/trace_records.hpp"
#include "laws/encounter.hpp"
#include "laws/map_places.hpp"
#include "laws/side_by_side.hpp"
#include "laws/stretch.hpp"
#include "laws/whereabouts.hpp"

namespace fleetproof {
namespace {

constexpr Duration kLookAhead = std::chrono::seconds(10);
constexpr double kNearMiss_m = 0.3;
constexpr Duration kSameNearMiss = std::chrono::seconds(1);

class CoverageLaw final : public Law {
 public:
  explicit CoverageLaw(const Scenario& scenario)
      : margin_m_(violation_threshold_m(scenario.law)),
        map_(*scenario.map),
        places_(map_),
        bodies_(scenario),
        swept_(scenario.agvs.size()),
        drives_(scenario.agvs.size()) {}

  void piece_started(const Piece& piece) override;
  void piece_ended(const Piece& piece) override;
  TraceKinds reads() const override { return {TraceKind::FaultStrikes}; }
  void happened(const TraceRecord& record) override { ++faults_[read<traced::FaultStrikes>(record).fault]; }
  void finish(SimTime end) override;
  LawFindings findings() const override;

 private:
  // The nearness of a pair under way, or the last one.
  struct Near {
    SimTime until = kStart;
    double clearance_m = 0.0;
  };
  // A drive as planned, and the station at which its segment ends; none if it drives no segment of the map.
  struct Drive {
    Track track;
    SegmentId segment;
    StationId to;
  };
  Drive drive_of(const Piece& piece) const;
  void meet(Drive drive);
  void meet(const Drive& earlier, const Drive& later);
  void look_closer(const Piece& a, const Piece& b, Interval within);
  void close(const Near& near) { near_misses_ += near.clearance_m >= margin_m_; }

  double margin_m_;
  const LogicalMap& map_;
  MapPlaces places_;
  Whereabouts bodies_;
  std::vector<Box> swept_;                 // by AGV, as planned; empty between a piece and the next
  std::vector<std::deque<Drive>> drives_;  // by AGV: the drives that ended recently or are under way
  std::array<std::uint64_t, kEncounterKinds> encounters_{};
  std::array<std::uint64_t, kSceneKinds> scenes_{};
  std::map<std::pair<EntityId, EntityId>, Near> near_;
  std::uint64_t near_misses_ = 0;
  std::map<Fault::Kind, std::uint64_t> faults_;
  EvaluationCount evaluations_;
};

void CoverageLaw::piece_started(const Piece& piece) {
  bodies_.note(piece);
  if (piece.entity.index() >= swept_.size()) return;
  swept_[piece.entity.index()] = piece.planned_box;
  if (piece.manner == Manner::Drive) meet(drive_of(piece));
}

CoverageLaw::Drive CoverageLaw::drive_of(const Piece& piece) const {
  Drive drive{Track::of(piece), piece.segment, {}};
  if (!piece.segment.valid() || piece.segment.index() >= map_.segment_count()) return drive;
  const Segment& segment = map_.segment(piece.segment);
  const Vec2 end_m = piece.curve->pose_at(piece.curve->length_m()).position_m;
  const auto apart = [&](StationId station) { return (map_.station(station).position_m - end_m).squaredNorm(); };
  drive.to = apart(segment.to) <= apart(segment.from) ? segment.to : segment.from;
  return drive;
}

void CoverageLaw::meet(Drive drive) {
  const Track& track = drive.track;
  for (std::size_t other = 0; other < drives_.size(); ++other) {
    if (other == track.agv.index()) continue;
    auto& drives = drives_[other];
    while (!drives.empty() && drives.front().track.end + kLookAhead < track.begin) drives.pop_front();
    for (const Drive& earlier : drives) meet(earlier, drive);
  }
  drives_[track.agv.index()].push_back(std::move(drive));
}

void CoverageLaw::meet(const Drive& earlier, const Drive& later) {
  const auto kind = encounter_of(earlier.track, later.track, margin_m_);
  if (kind) ++encounters_[static_cast<std::size_t>(*kind)];
  const auto scene = [&](SceneKind met, bool holds) { scenes_[static_cast<std::size_t>(met)] += holds ? 1 : 0; };
  scene(SceneKind::BackIn, kind && (earlier.track.tail_first || later.track.tail_first));
  const SideBySide passing = side_by_side(earlier.track, later.track, margin_m_);
  scene(SceneKind::TightGap, passing.tight_gap);
  scene(SceneKind::CurveBesideLane, passing.curve_beside_lane);
  scene(SceneKind::OverhangPass, passing.overhang_pass);
  if (!later.to.valid() || earlier.to != later.to || earlier.segment == later.segment) return;
  scene(SceneKind::Bottleneck, places_.bottleneck[later.to.index()]);
  scene(SceneKind::FourWay, places_.four_way[later.to.index()]);
}

void CoverageLaw::piece_ended(const Piece& piece) {
  const std::size_t mine = piece.entity.index();
  if (mine >= swept_.size()) return;
  const Box near = swept_[mine].grown(kNearMiss_m);
  swept_[mine] = Box{};
  for (std::size_t i = 0; i < swept_.size(); ++i) {
    if (!near.overlaps(swept_[i])) continue;
    const Piece& other = bodies_.of(EntityId{i});
    const Interval common{std::max(piece.begin, other.begin), piece.end};
    if (common.begin >= common.end || (piece.manner == Manner::Rest && other.manner == Manner::Rest)) continue;
    if (mine < i) {
      look_closer(piece, other, common);
    } else {
      look_closer(other, piece, common);
    }
  }
}

void CoverageLaw::look_closer(const Piece& a, const Piece& b, Interval within) {
  const auto approach = closest_approach(a, b, within, kNearMiss_m, evaluations_);
  if (!approach) return;
  const auto [at, is_new] = near_.try_emplace({a.entity, b.entity}, Near{within.end, approach->clearance_m});
  if (is_new) return;
  Near& near = at->second;
  if (within.begin - near.until > kSameNearMiss) {
    close(near);
    near = {within.end, approach->clearance_m};
  } else {
    near = {std::max(near.until, within.end), std::min(near.clearance_m, approach->clearance_m)};
  }
}

void CoverageLaw::finish(SimTime) {
  for (const auto& [pair, near] : near_) close(near);
}

LawFindings CoverageLaw::findings() const {
  LawFindings findings;
  const auto met = [&](std::string name, std::uint64_t count) {
    findings.met.push_back({ProbeSource::World, std::move(name), count});
  };
  for (std::size_t i = 0; i < kEncounterKinds; ++i) met(name_of(static_cast<EncounterKind>(i)), encounters_[i]);
  for (std::size_t i = 0; i < kSceneKinds; ++i) {
    if (scenes_[i] > 0) met(name_of(static_cast<SceneKind>(i)), scenes_[i]);
  }
  met(std::string(kNearMissProbe), near_misses_);
  for (const auto& [fault, count] : faults_) met(probe_name(fault), count);
  return findings;
}

}  // namespace

std::unique_ptr<Law> make_coverage_law(const Scenario& scenario) { return std::make_unique<CoverageLaw>(scenario); }

}  // namespace fleetproof
