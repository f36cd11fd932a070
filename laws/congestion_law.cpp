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
constexpr std::int64_t kInterference_ppm = 100'000;
constexpr std::uint64_t kFewestInterfered = 5;

class CongestionLaw final : public Law {
 public:
  explicit CongestionLaw(const Scenario& scenario) : radio_(scenario.radio) {}

  void piece_ended(const Piece&) override {}
  TraceKinds reads() const override { return kMessageKinds; }
  bool hears_messages_together() const override { return true; }
  void messages(std::span<const TraceRecord> records) override {
    for (const TraceRecord& record : records) {
      if (record.at >= window_ + kWindow) windows_before(record.at);
      if (record.kind == TraceKind::Sent) {
        offered_ += air_time(read<traced::Sent>(record).bytes);
      } else {
        ++receptions_;
        destroyed_ += record.kind == TraceKind::LostByInterference ? 1 : 0;
      }
    }
  }
  void finish(SimTime end) override { windows_before(end + kWindow); }
  LawFindings findings() const override {
    LawFindings findings;
    findings.incidents = incidents_;
    return findings;
  }

 private:
  // Messages often have the length of the one before.
  Duration air_time(std::uint32_t bytes) {
    if (bytes != last_bytes_) last_air_time_ = radio_.air_time(bytes);
    last_bytes_ = bytes;
    return last_air_time_;
  }

  // Closes every window that ends at or before `t`.
  void windows_before(SimTime t) {
    for (; window_ + kWindow <= t; window_ += kWindow) {
      judge(IncidentKind::ChannelSaturated, saturated_, kWhole_ppm * offered_.count() / kWindow.count(), kSaturated_ppm,
            true);
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

  const RadioSetup& radio_;
  SimTime window_ = kStart;
  Duration offered_{}, last_air_time_{};
  std::uint32_t last_bytes_ = ~0U;
  std::uint64_t receptions_ = 0, destroyed_ = 0;
  std::optional<std::size_t> saturated_, interfered_;
  std::vector<Incident> incidents_;
};

}  // namespace

std::unique_ptr<Law> make_congestion_law(const Scenario& scenario) { return std::make_unique<CongestionLaw>(scenario); }

}  // namespace fleetproof
