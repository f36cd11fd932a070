#include "laws/congestion_law.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

constexpr Duration kWindow = std::chrono::seconds(1);
constexpr std::int64_t kWhole_ppm = 1'000'000;
constexpr std::int64_t kSaturated_ppm = 500'000;
// The air time that is one millionth of a window.
constexpr Duration kOne_ppm = kWindow / kWhole_ppm;
static_assert(kOne_ppm * kWhole_ppm == kWindow);
constexpr std::int64_t kInterference_ppm = 100'000;
constexpr std::uint64_t kFewestInterfered = 5;

class CongestionLaw final : public Law {
 public:
  explicit CongestionLaw(const Scenario& scenario)
      : scenario_(scenario),
        radio_(scenario.radio),
        interference_(radio_.contention.interference),
        bytes_matter_(radio_.air_time_per_byte_s != 0.0),
        last_air_time_(radio_.air_time(0)) {}

  Pieces hears_pieces() const override { return Pieces::None; }
  bool hears_together() const override { return true; }
  void together(const TracePart& part) override {
    if (interference_ || bytes_matter_ || !scenario_.computers.empty() || !stays_calm(part)) look_at_all(part);
  }
  void finish(SimTime end) override { windows_before(end + kWindow); }
  LawResults findings() const override {
    LawResults findings;
    findings.incidents = incidents_;
    return findings;
  }

 private:
  // Whether all messages of the part together cannot saturate a window. Then only the last window counts on.
  bool stays_calm(const TracePart& part) {
    const auto all = part.block->sent();
    const auto is_before = [](const TraceBlock::Sent& sent, std::uint32_t place) { return sent.place < place; };
    const auto begin = std::lower_bound(all.begin(), all.end(), part.begin, is_before),
               end = std::lower_bound(begin, all.end(), part.end, is_before);
    if (begin == end) return true;
    if (offered_ + (end - begin) * last_air_time_ >= kSaturated_ppm * kOne_ppm) return false;
    const SimTime last = part.block->at((end - 1)->place);
    if (last >= window_ + kWindow) {
      window_ += (last - window_) / kWindow * kWindow;
      offered_ = Duration::zero();
      saturated_.reset();
    }
    for (auto sent = end; sent != begin && part.block->at((sent - 1)->place) >= window_; --sent)
      offered_ += last_air_time_;
    return true;
  }

  void look_at_all(const TracePart& part) {
    std::uint32_t place = part.begin;
    for (const TraceBlock::Sent& sent : part.block->sent()) {
      if (sent.place < part.begin || sent.place >= part.end) continue;
      if (interference_) receptions(*part.block, place, sent.place);
      place = sent.place + 1;
      if (goes_by_wire(part.block->record(sent.place))) continue;
      enters(part.block->at(sent.place));
      offered_ += bytes_matter_ ? air_time(sent.bytes) : last_air_time_;
    }
    if (interference_) receptions(*part.block, place, part.end);
  }

  // Without interference, no transmission can destroy a reception, and their number does not matter.
  void receptions(const TraceBlock& block, std::uint32_t begin, std::uint32_t end) {
    for (; begin < end; ++begin) {
      const TraceKind kind = block.kind(begin);
      if (!kMessageKinds.has(kind) || block.is_copy(begin) || came_by_wire(block.record(begin))) continue;
      enters(block.at(begin));
      ++receptions_;
      destroyed_ += kind == TraceKind::LostByInterference ? 1 : 0;
    }
  }

  // What needs no air.
  bool goes_by_wire(const TraceRecord& record) const {
    return scenario_.is_computer(record.entity) &&
           scenario_.are_wired(record.entity, read<traced::Sent>(record).receiver);
  }
  bool came_by_wire(const TraceRecord& record) const {
    return scenario_.is_computer(record.entity) &&
           scenario_.are_wired(record.entity, read<traced::Reception>(record).sender);
  }

  void enters(SimTime t) {
    if (t >= window_ + kWindow) [[unlikely]]
      windows_before(t);
  }

  // Messages often have the length of the one before.
  Duration air_time(std::uint32_t bytes) {
    if (bytes != last_bytes_) last_air_time_ = radio_.air_time(bytes);
    last_bytes_ = bytes;
    return last_air_time_;
  }

  // Closes every window that ends at or before `t`.
  void windows_before(SimTime t) {
    for (; window_ + kWindow <= t; window_ += kWindow) {
      judge(IncidentKind::ChannelSaturated, saturated_, offered_ / kOne_ppm, kSaturated_ppm, true);
      const std::int64_t share_ppm = receptions_ == 0 ? 0
                                                      : kWhole_ppm * static_cast<std::int64_t>(destroyed_) /
                                                            static_cast<std::int64_t>(receptions_);
      judge(IncidentKind::InterferenceLosses, interfered_, share_ppm, kInterference_ppm,
            destroyed_ >= kFewestInterfered);
      offered_ = Duration::zero();
      receptions_ = destroyed_ = 0;
    }
  }

  void judge(IncidentKind kind, std::optional<std::size_t>& under_way, std::int64_t value_ppm, std::int64_t limit_ppm,
             bool enough) {
    if (value_ppm < limit_ppm || !enough) {
      under_way.reset();
      return;
    }
    if (!under_way) {
      under_way = incidents_.size();
      incidents_.push_back({kind, {}, {}, window_, window_, 0});
    }
    Incident& incident = incidents_[*under_way];
    incident.last = window_ + kWindow;
    incident.value = std::max(incident.value, value_ppm);
  }

  const Scenario& scenario_;
  const RadioSetup& radio_;
  bool interference_, bytes_matter_;
  SimTime window_ = kStart;
  Duration offered_{}, last_air_time_;
  std::uint32_t last_bytes_ = 0;  // to which last_air_time_ belongs
  std::uint64_t receptions_ = 0, destroyed_ = 0;
  std::optional<std::size_t> saturated_, interfered_;
  std::vector<Incident> incidents_;
};

}  // namespace

std::unique_ptr<Law> make_congestion_law(const Scenario& scenario) { return std::make_unique<CongestionLaw>(scenario); }

}  // namespace fleetproof
