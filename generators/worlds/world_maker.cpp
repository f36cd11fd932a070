#include "generators/worlds/world_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/random.hpp"
#include "core/scenario/lane_rules.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/families/mutated_import.hpp"
#include "generators/map/permitted_types.hpp"
#include "generators/scenario_file/validator.hpp"
#include "generators/text/text_file.hpp"
#include "generators/worlds/encounter_pairs.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/transports.hpp"
#include "generators/worlds/world_fields.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kAttempts = 32;
constexpr std::uint32_t kTypeTopic = 0x74000000;  // of the placement stream, beyond any attempt

using SharedMap = std::shared_ptr<const LogicalMap>;

void check(const WorldSpec& spec) {
  if (spec.vehicles.empty()) throw InputError("vehicle", "a fleet needs at least one type of vehicle");
  if (spec.fleet_size == 0) throw InputError("fleet_size", "0 AGVs are no fleet; ask for at least 1");
  visit_fields(spec.demand, [](const Field& field, double value) {
    if (const auto fault = fault_of(field, value); !fault.empty())
      throw InputError(field.key, fmt::format("{} is refused: {}", value, fault));
  });
  if (spec.horizon <= Duration::zero())
    throw InputError("horizon_s", fmt::format("{} is not above 0", to_seconds(spec.horizon)));
  if (spec.orders != nullptr) {
    if (spec.mutate || std::holds_alternative<std::string>(spec.layout)) {
      throw InputError(
          "orders",
          "a list of orders names stations, but this layout is drawn anew for every world; use a layout file as it is");
    }
    if (spec.placement != Placement::Random && spec.placement != Placement::ChargerBank) {
      throw InputError("orders", fmt::format("placement {} chooses the first orders itself; drop one of the two",
                                             in_quotes(name_of(spec.placement))));
    }
  }
}

// How far footprints reach from their reference points.
struct Extent {
  double front_m = -1e9, back_m = 1e9, width_m = 0.0;

  void add(const Footprint& footprint) {
    front_m = std::max(front_m, footprint.centre_ahead_m + 0.5 * footprint.length_m);
    back_m = std::min(back_m, footprint.centre_ahead_m - 0.5 * footprint.length_m);
    width_m = std::max(width_m, footprint.width_m);
  }
};

// The first type, with the largest body of all types, unloaded and loaded. A start that has room for this body has room
// for every type, whatever load the AGV picks there.
VehicleType envelope(const std::vector<VehicleShare>& vehicles) {
  VehicleType type = vehicles.front().type;
  Extent empty, loaded;
  for (const auto& [other, share] : vehicles) {
    empty.add(other.footprint);
    loaded.add(other.footprint_with(true));
  }
  const double centre_m = 0.5 * (empty.front_m + empty.back_m);
  type.footprint = {empty.front_m - empty.back_m, empty.width_m, centre_m};
  const double loaded_length_m = 2.0 * std::max(loaded.front_m - centre_m, centre_m - loaded.back_m);
  type.loaded.extra_length_m = loaded_length_m - type.footprint.length_m;
  type.loaded.extra_width_m = loaded.width_m - empty.width_m;
  return type;
}

std::vector<std::string> names_of(const std::vector<VehicleShare>& vehicles) {
  std::vector<std::string> names;
  for (const auto& [type, share] : vehicles) names.push_back(type.name);
  return names;
}

// The worlds of one seed, one after the other until one is sound.
class WorldMaker {
 public:
  // `held_attempt`: of which attempt the held streams are.
  WorldMaker(const WorldSpec& spec, std::uint64_t seed, std::uint32_t held_attempt)
      : spec_(spec), held_attempt_(held_attempt), family_(std::get_if<std::string>(&spec.layout)) {
    scenario_.vehicle_types = {envelope(spec.vehicles)};
    scenario_.law = spec.law;
    scenario_.horizon = spec.horizon;
    scenario_.seed = seed;
    if (spec.held.seed != seed) {
      for (const Stream stream : spec.held.streams) scenario_.stream_seeds.push_back({stream, spec.held.seed});
    }
    if (family_ != nullptr || spec.mutate) return;
    set_map(std::get<SharedMap>(spec.layout));
    set_types();
    // No other draw mends a fixed layout.
    for (const auto& problem : world_problems(scenario_, *reachability_))
      throw InputError(scenario_.map->layout().name, problem.sentence);
    const auto idle = type_without_transports();
    if (!idle) return;
    throw InputError(
        scenario_.map->layout().name,
        fmt::format(
            "no AGV of type {} can pick a load at one station and drop it at another by what the layout permits "
            "(turns, headings, loads and types{}); change that, or ask for no transports "
            "(transports_per_agv_hour = 0)",
            in_quotes(spec.vehicles[*idle].type.name),
            foreign_types_hint(scenario_.map->layout(), names_of(spec.vehicles))));
  }

  bool attempt(std::uint32_t number) {
    scenario_.vehicle_types = {envelope(spec_.vehicles)};
    scenario_.obstacles.clear();
    scenario_.faults.clear();
    scenario_.open_orders.clear();
    draw_types(number);
    if (!draw_map(number) || !place(number)) return false;
    set_types();
    const bool stored = assign_orders(number);
    withdraw_transports(scenario_, spec_.order_setup.withdrawn_share, key_of(Stream::Transports),
                        attempt_of(Stream::Transports, number));
    draw_faults(scenario_, spec_.faults, key_of(Stream::Faults));
    if (spec_.order_setup.transports == OrderKind::Open) open_transports(scenario_);
    if (const auto problems = unusable_problems(scenario_); !problems.empty())
      throw InputError(problems[0].pointer, problems[0].sentence);
    const auto problems = world_problems(scenario_, *reachability_);
    for (const auto& problem : problems) ++counts.of(problem.kind);
    if (!problems.empty()) return false;
    if (!stored && spec_.demand.transports_per_agv_hour > 0.0) ++counts.worlds_without_storage;
    return true;
  }

  Scenario take() { return std::move(scenario_); }

  // The size of a fleet that found room in at least half of the draws; 0 if that was no AGV.
  std::uint32_t fleet_that_fits() {
    std::ranges::sort(placed_);
    return placed_.empty() ? 0 : static_cast<std::uint32_t>(placed_[(placed_.size() - 1) / 2]);
  }
  // With more than one AGV for two stations, a fleet may stand still.
  std::uint32_t fleet_that_moves() const {
    return std::max(1U, static_cast<std::uint32_t>(scenario_.map->station_count() / 2));
  }

  RejectionCounts counts;

 private:
  bool draw_map(std::uint32_t number) {
    Draws draws(key_of(Stream::Layout), attempt_of(Stream::Layout, number));
    if (family_ != nullptr) {
      set_map(::fleetproof::draw_map(family_range(*family_), draws, spec_.fleet_size));
    } else if (spec_.mutate) {
      auto map = draw_mutated_map(std::get<SharedMap>(spec_.layout)->layout(), draws, counts);
      if (map == nullptr) return false;
      set_map(std::move(map));
      if (!type_without_transports()) return true;
      ++counts.of(ProblemKind::WeakCore);
      return false;
    }
    return true;
  }

  bool place(std::uint32_t attempt) {
    const bool all = place_agvs(attempt);
    placed_.push_back(scenario_.agvs.size());
    return all;
  }

  bool place_agvs(std::uint32_t attempt) {
    const auto key = key_of(Stream::Placement);
    const auto number = attempt_of(Stream::Placement, attempt);
    const auto placement = placement_of_world(spec_.placement, key);
    scenario_.agvs.clear();
    pairs_.clear();
    if (placement == Placement::ChargerBank)
      return place_at_charger_bank(scenario_, types_, *reachability_, key, number, counts);
    if (placement != Placement::Random)
      pairs_ = place_pairs(scenario_, types_, placement, *reachability_, key, number, counts);
    return place_fleet(scenario_, types_, *reachability_, key, number, counts);
  }

  // False if transports lead between any stations, because there are too few storage stations.
  bool assign_orders(std::uint32_t number) {
    if (spec_.orders != nullptr) {
      assign_listed_orders(scenario_, *spec_.orders, *reachability_);
      return true;
    }
    const Demand& demand = spec_.demand;
    const bool stored = assign_transports(scenario_, demand, *reachability_, key_of(Stream::Transports),
                                          attempt_of(Stream::Transports, number));
    if (!pairs_.empty()) send_to_meet(scenario_, pairs_, order_ends_by_type(scenario_, *reachability_));
    return stored;
  }

  void draw_types(std::uint32_t number) {
    types_.assign(spec_.fleet_size, 0);
    if (spec_.vehicles.size() == 1) return;
    double total = 0.0;
    for (const auto& [type, share] : spec_.vehicles) total += share;
    for (std::uint32_t i = 0; i < spec_.fleet_size; ++i) {
      Draws draws(key_of(Stream::Placement), kTypeTopic + attempt_of(Stream::Placement, number), i);
      double left = draws.uniform(0.0, total);
      while (types_[i] + 1 < spec_.vehicles.size() && left >= spec_.vehicles[types_[i]].share)
        left -= spec_.vehicles[types_[i]++].share;
    }
  }

  // After every AGV has a place that is large enough for the largest type.
  void set_types() {
    scenario_.vehicle_types.clear();
    for (const auto& [type, share] : spec_.vehicles) scenario_.vehicle_types.push_back(type);
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) scenario_.agvs[i].type = types_[i];
  }

  // A type of the fleet that cannot carry anything, though transports are drawn for it; none without rules.
  std::optional<std::size_t> type_without_transports() const {
    const bool drawn = spec_.orders == nullptr && spec_.demand.transports_per_agv_hour > 0.0;
    if (!drawn || !has_rules(scenario_.map->layout())) return std::nullopt;
    for (std::uint32_t type = 0; type < spec_.vehicles.size(); ++type) {
      if (order_ends(*scenario_.map, *reachability_, type).picks.empty()) return type;
    }
    return std::nullopt;
  }

  std::uint64_t key_of(Stream stream) const { return stream_key(scenario_.seed_of(stream), stream); }

  // A held stream keeps the attempt that made the world from which it is held. If another stream causes one more
  // attempt, the held stream does not change.
  std::uint32_t attempt_of(Stream stream, std::uint32_t number) const {
    return std::ranges::find(scenario_.stream_seeds, stream, &StreamSeed::stream) == scenario_.stream_seeds.end()
               ? number
               : held_attempt_;
  }

  void set_map(SharedMap map) {
    scenario_.map = std::move(map);
    reachability_.emplace(*scenario_.map, names_of(spec_.vehicles));
    scenario_.name = fmt::format("{}, {} AGVs", scenario_.map->layout().name, spec_.fleet_size);
  }

  const WorldSpec& spec_;
  std::uint32_t held_attempt_;
  const std::string* family_;
  Scenario scenario_;
  std::optional<Reachability> reachability_;
  std::vector<std::uint32_t> types_;  // by AGV, also before it has a place
  std::vector<EncounterPair> pairs_;
  std::vector<std::size_t> placed_;  // AGVs, by draw
};

struct MadeWorld {
  Scenario scenario;
  std::uint32_t attempt = 0;
};

// As the plan has it: a family and its range, or the name of the layout.
std::string called(const WorldSpec& spec) {
  const auto* family = std::get_if<std::string>(&spec.layout);
  return family != nullptr ? *family : std::get<std::shared_ptr<const LogicalMap>>(spec.layout)->layout().name;
}

MadeWorld make_world(const WorldSpec& spec, std::uint64_t seed, std::uint32_t held_attempt, RejectionCounts& counts) {
  WorldMaker maker(spec, seed, held_attempt);
  for (std::uint32_t number = 0; number < kAttempts; ++number) {
    if (maker.attempt(number)) {
      ++maker.counts.worlds;
      counts.add(maker.counts);
      return {maker.take(), number};
    }
    ++maker.counts.worlds_rejected;
  }
  counts.add(maker.counts);
  const std::uint32_t fits = std::min(maker.fleet_that_fits(), spec.fleet_size);
  const std::string found = fmt::format("cannot place {} AGVs on {} in {} draws ({})", spec.fleet_size,
                                        in_quotes(called(spec)), kAttempts, rejection_text(maker.counts));
  if (fits == 0 || fits == spec.fleet_size)  // something else is wrong
    throw NoRoom(found + "; ask for fewer or for a larger layout", 0);
  const std::uint32_t moves = std::min(fits, maker.fleet_that_moves());
  throw NoRoom(
      fmt::format("{}; {} fit on {}{}: ask for {} or fewer, or for a larger layout", found, fits,
                  in_quotes(called(spec)),
                  moves < fits ? ", but with more than one for two stations a fleet may stand still" : "", moves),
      fits);
}

bool shapes_world(Stream stream) {
  return stream == Stream::Layout || stream == Stream::Placement || stream == Stream::Transports;
}

}  // namespace

Scenario generate_world(const WorldSpec& spec, std::uint64_t seed, RejectionCounts& counts) {
  check(spec);
  std::uint32_t held_attempt = 0;
  if (spec.held.seed != seed && std::ranges::any_of(spec.held.streams, shapes_world)) {
    WorldSpec unheld = spec;
    unheld.held = {};
    RejectionCounts ignored;
    held_attempt = make_world(unheld, spec.held.seed, 0, ignored).attempt;
  }
  return make_world(spec, seed, held_attempt, counts).scenario;
}

std::string rejection_text(const RejectionCounts& counts) {
  std::string text;
  const auto add = [&](const char* what, std::uint64_t times) {
    if (times > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", what, times);
  };
  add("out of stations", counts.fleets_without_room);
  for (std::size_t i = 0; i < kProblemKinds; ++i) add(name_of(static_cast<ProblemKind>(i)), counts.reasons[i]);
  return text;
}

}  // namespace fleetproof
