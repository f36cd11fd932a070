#include "core/radio/radio_sources.hpp"

namespace fleetproof {
namespace {

// Kinds of draws under the key of external sources.
constexpr std::uint32_t kOnProcess = 1, kLossKey = 2;

OutageLaw on_and_off(const RadioSource& source) {
  return {.sojourn = OutageLaw::Sojourn::Exponential,
          .bad_share = source.mean_on_s / (source.mean_on_s + source.mean_off_s),
          .mean_bad_s = source.mean_on_s};
}

}  // namespace

RadioSources::RadioSources(const std::vector<RadioSource>& sources, std::uint64_t key) {
  for (const RadioSource& source : sources) {
    const auto number = static_cast<std::uint32_t>(sources_.size());
    sources_.push_back({.at_m = Vec2(source.x_m, source.y_m),
                        .range_m = source.range_m,
                        .loss = source.loss,
                        .on = OutageProcess(on_and_off(source), {.key = key, .kind = kOnProcess, .a = number, .b = 0}),
                        .loss_key = word64(philox(key, {0, kLossKey << 1, number, 0}), 0)});
  }
}

bool RadioSources::destroy(const MessageKey& message, const Vec2& receiver_m) {
  for (Source& source : sources_) {
    if ((receiver_m - source.at_m).norm() > source.range_m || !source.on.bad_at(message.sent)) continue;
    if (unit_interval(word64(draw_for(message, source.loss_key), 0)) < source.loss) return true;
  }
  return false;
}

}  // namespace fleetproof
