#include "generators/world.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/error.hpp"
#include "core/random.hpp"
#include "generators/layout_family.hpp"
#include "generators/placement.hpp"
#include "generators/transports.hpp"
#include "generators/validator.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kAttempts = 32;
constexpr double kMostTransports_per_h = 3600.0;

using SharedMap = std::shared_ptr<const LogicalMap>;

void check(const WorldSpec& spec) {
  if (spec.fleet_size == 0) throw InputError("fleet_size", "0 AGVs are no fleet; ask for at least 1");
  if (!(spec.transports_per_agv_hour >= 0.0 && spec.transports_per_agv_hour <= kMostTransports_per_h)) {
    throw InputError("transports_per_agv_hour", fmt::format("{} is outside 0 .. {}", spec.transports_per_agv_hour, kMostTransports_per_h));
  }
  if (spec.horizon <= Duration::zero()) throw InputError("horizon_s", fmt::format("{} is not above 0", to_seconds(spec.horizon)));
  if (const auto* map = std::get_if<SharedMap>(&spec.layout); map != nullptr && spec.fleet_size > (*map)->station_count()) {
    throw InputError("fleet_size",
                     fmt::format("{} AGVs cannot start on the {} stations of this layout; ask for fewer", spec.fleet_size, (*map)->station_count()));
  }
}

std::string reasons(const RejectionCounts& counts) {
  std::string text = fmt::format("out of stations {} times", counts.fleets_without_room);
  for (std::size_t i = 0; i < kProblemKinds; ++i) {
    if (counts.reasons[i] > 0) text += fmt::format(", {} {}", name_of(static_cast<ProblemKind>(i)), counts.reasons[i]);
  }
  return text;
}

// The worlds of one seed, one after the other until one is sound.
class WorldMaker {
 public:
  WorldMaker(const WorldSpec& spec, std::uint64_t seed) : spec_(spec), seed_(seed), family_(std::get_if<std::string>(&spec.layout)) {
    scenario_.vehicle_types = {spec.vehicle};
    scenario_.law = spec.law;
    scenario_.horizon = spec.horizon;
    scenario_.seed = seed;
    if (family_ != nullptr) return;
    set_map(std::get<SharedMap>(spec.layout));
    // No other draw mends a fixed layout.
    for (const auto& problem : world_problems(scenario_, *reachability_)) throw InputError(scenario_.map->layout().name, problem.sentence);
  }

  bool attempt(std::uint32_t number) {
    if (family_ != nullptr) {
      Draws draws(stream_key(seed_, Stream::Layout), number);
      set_map(std::make_shared<const LogicalMap>(layout_family(*family_).make(draws)));
    }
    if (!place_fleet(scenario_, spec_.fleet_size, *reachability_, stream_key(seed_, Stream::Placement), number, counts)) return false;
    const bool stored = assign_transports(scenario_, spec_.transports_per_agv_hour, *reachability_, stream_key(seed_, Stream::Transports), number);
    if (const auto problems = unusable_problems(scenario_); !problems.empty()) throw InputError(problems[0].pointer, problems[0].sentence);
    const auto problems = world_problems(scenario_, *reachability_);
    for (const auto& problem : problems) ++counts.of(problem.kind);
    if (!problems.empty()) return false;
    if (!stored) ++counts.worlds_without_storage;
    return true;
  }

  Scenario take() { return std::move(scenario_); }

  RejectionCounts counts;

 private:
  void set_map(SharedMap map) {
    scenario_.map = std::move(map);
    reachability_.emplace(*scenario_.map);
    scenario_.name = fmt::format("{}, {} AGVs", scenario_.map->layout().name, spec_.fleet_size);
  }

  const WorldSpec& spec_;
  std::uint64_t seed_;
  const std::string* family_;
  Scenario scenario_;
  std::optional<Reachability> reachability_;
};

}  // namespace

Scenario generate_world(const WorldSpec& spec, std::uint64_t seed, RejectionCounts& counts) {
  check(spec);
  WorldMaker maker(spec, seed);
  for (std::uint32_t number = 0; number < kAttempts; ++number) {
    if (maker.attempt(number)) {
      ++maker.counts.worlds;
      counts.add(maker.counts);
      return maker.take();
    }
    ++maker.counts.worlds_rejected;
  }
  counts.add(maker.counts);
  throw InputError("fleet_size", fmt::format("cannot place {} AGVs on this layout in {} draws ({}); ask for fewer or for a larger layout",
                                             spec.fleet_size, kAttempts, reasons(maker.counts)));
}

}  // namespace fleetproof
