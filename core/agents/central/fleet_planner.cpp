#include "core/agents/central/fleet_planner.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/agents/fleet.hpp"
#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents::central {
namespace {

constexpr double kLead_s = 10.0;            // so long before its way ends, an AGV gets more of it
constexpr double kSection_m = 12.0;         // a section that is as long need not be longer
constexpr double kMostOfASection_m = 18.0;  // on the way to a waiting place; then it ends where it blocks least
constexpr double kPlanAgain_s = 2.0;        // after so long, an AGV that waits may find another way
constexpr double kLookAgain_s = 1.0;
// So long others may pass before an AGV that waits; then its floor is kept free.
constexpr double kKeepsFreeAfter_s = 20.0;
// An AGV that waits for so long itself makes way for an older one, and so long it waits before an older one makes way.
constexpr double kYields_s = 4.0, kInsists_s = 15.0;
constexpr std::size_t kMostStates = 300, kMostStatesOfTheOldest = 2000;
constexpr std::int64_t kTryAgain_ns = 2'000'000'000;
constexpr int kMostDoublings = 4;
constexpr double kGivesUp_s = 120.0;  // if nothing of a passing was granted for so long

constexpr double kTransferTakes_s = 5.0, kTurnTakes_s = 3.0;  // expected
// Prices of a station at which another AGV will stand for a while, or for good.
constexpr double kMovingPrice_s = 8.0, kWallPrice_s = 1000.0;
constexpr double kUnsafeChargerPrice_s = 30.0;
constexpr std::uint32_t kCrowdedBurden = 1;

bool contains(std::span<const std::uint32_t> agvs, std::uint32_t agv) {
  return std::ranges::find(agvs, agv) != agvs.end();
}
double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

FleetPlanner::Model::Model(const MapView& map, const HullGeometry& geometry, std::uint32_t agv, std::uint32_t of)
    : rules(map, tells_minor_2(geometry.parts().facts()) ? agv_of(geometry.parts().facts(), agv).vehicle_type : 0),
      routes(map, rules),
      prices(map, rules, lane_costs_s(geometry.parts(), agv), geometry.parts().facts().fleet_count),
      number(of) {}

FleetPlanner::FleetPlanner(const MapView& map, HullGeometry& geometry, FloorBook& book, const Settings& settings,
                           const ServerOptions& options)
    : map_(map),
      geometry_(geometry),
      book_(book),
      settings_(settings),
      options_(options),
      places_(map, geometry),
      has_chargers_(map.has_chargers()),
      tasks_(book.fleet_count()) {
  for (std::uint32_t agv = 0; agv < book.fleet_count(); ++agv) {
    const std::uint32_t number = agents::model_of(geometry.parts().facts(), agv);
    auto& model = models_[number];
    if (!model) model = std::make_unique<Model>(map, geometry, agv, number);
    model_of_.push_back(model.get());
  }
}

// ---- work

// What its former self was to pick, another AGV may pick now. It has waited as long as its former self.
void FleetPlanner::begin(std::uint32_t agv) {
  const std::int64_t since_ns = tasks_[agv].since_ns;
  tasks_[agv] = {};
  tasks_[agv].since_ns = since_ns;
  std::erase_if(passings_, [&](const Passing& passing) { return contains(passing.agvs, agv); });
  for (OpenOrder& open : open_) {
    if (open.agv == agv) open.agv = FP_NONE;
    if (open.order.id != book_.way(agv).first_load) continue;
    open.agv = agv;
    tasks_[agv].goals.push_back({open.order.to, {Step::Kind::Drop, open.order.id}});
  }
}

void FleetPlanner::take_orders(std::uint32_t agv, std::uint32_t first, std::span<const Order> orders) {
  Task& task = tasks_[agv];
  if (task.cancelling && !carries_load(agv)) task.goals.clear();
  task.cancelling = false;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (first + i != task.orders) continue;
    const Order& order = orders[i];
    if (order.id != book_.way(agv).first_load) task.goals.push_back({order.from, {Step::Kind::Pick, order.id}});
    task.goals.push_back({order.to, {Step::Kind::Drop, order.id}});
    ++task.orders;
  }
}

void FleetPlanner::put_work(std::uint32_t agv, AgvRecord& record) const {
  const Task& task = tasks_[agv];
  record.grant.orders = task.orders;
  record.goals.assign(task.goals.begin(), task.goals.end());
  record.charging = task.charging;
}

void FleetPlanner::recall(std::uint32_t agv, const AgvRecord& record) {
  tasks_[agv].orders = record.grant.orders;
  tasks_[agv].goals.assign(record.goals.begin(), record.goals.end());
  tasks_[agv].charging = record.charging;
}

// After a restart of the server, an AGV may be carrying it out.
void FleetPlanner::take_open_order(const Order& order) {
  OpenOrder open{order, 0};
  while (open.agv < book_.fleet_count() && !is_under_way(open)) ++open.agv;
  if (open.agv == book_.fleet_count()) open.agv = FP_NONE;
  open_.push_back(open);
}

void FleetPlanner::withdraw(std::uint32_t order) {
  const auto open = std::ranges::find(open_, order, [](const OpenOrder& o) { return o.order.id; });
  if (open == open_.end()) return;
  if (open->agv != FP_NONE) {
    Task& task = tasks_[open->agv];
    const Step pick{Step::Kind::Pick, order};
    if (std::ranges::find(task.goals, pick, &Goal::step) == task.goals.end()) return;
    std::erase_if(task.goals,
                  [&](const Goal& goal) { return goal.step.what == order && goal.step.kind != Step::Kind::Charge; });
    task.wanted.reset();
    task.cancelling = !options_.cancels_name_an_order;
  }
  open_.erase(open);
}

std::uint32_t FleetPlanner::work_of(std::uint32_t agv) const {
  const auto open = std::ranges::find(open_, agv, &OpenOrder::agv);
  return open == open_.end() ? FP_NONE : open->order.id;
}

std::uint32_t FleetPlanner::waits_for(std::uint32_t agv) const {
  const Task& task = tasks_[agv];
  return task.wanted && book_.way(agv).is_waiting() ? task.obstruction.by : FP_NONE;
}

// The oldest first, each to the AGV that is there first. An AGV has at most the load on board to deliver before.
void FleetPlanner::assign_open_orders() {
  std::erase_if(open_, [&](const OpenOrder& open) { return open.agv != FP_NONE && !is_under_way(open); });
  for (OpenOrder& open : open_) {
    if (open.agv != FP_NONE) continue;
    open.agv = quickest_free_agv(open.order.from);
    if (open.agv == FP_NONE) continue;
    auto& goals = tasks_[open.agv].goals;
    goals.push_back({open.order.from, {Step::Kind::Pick, open.order.id}});
    goals.push_back({open.order.to, {Step::Kind::Drop, open.order.id}});
  }
}

// What is neither a goal nor a granted step is done, or turned out to be impossible.
bool FleetPlanner::is_under_way(const OpenOrder& open) const {
  const auto is_part = [&](const Step& step) {
    return (step.kind == Step::Kind::Pick || step.kind == Step::Kind::Drop) && step.what == open.order.id;
  };
  return std::ranges::any_of(tasks_[open.agv].goals, is_part, &Goal::step) ||
         std::ranges::any_of(book_.way(open.agv).steps, is_part);
}

std::uint32_t FleetPlanner::quickest_free_agv(std::uint32_t station) const {
  std::uint32_t best = FP_NONE;
  double best_s = INFINITY;
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    const Task& task = tasks_[agv];
    const FloorBook::Way& way = book_.way(agv);
    const bool delivers = task.goals.size() == 1 && task.goals.front().step.kind == Step::Kind::Drop;
    if (task.charging || way.out_of_order || settings_.is_low(way.battery) || !(task.is_idle() || delivers)) continue;
    const auto cost_s = [&](std::uint32_t from, std::uint32_t to) {
      return double{remaining_costs_s(geometry_.parts(), model_of_[agv]->number, to)[from]};
    };
    const std::uint32_t end = book_.end_of_way(agv).station, last = delivers ? task.goals.front().station : end;
    const double delivery_s = delivers ? cost_s(end, last) + kTransferTakes_s : 0.0;
    const double takes_s = time_left_s(agv) + delivery_s + cost_s(last, station);
    if (takes_s < best_s) best = agv, best_s = takes_s;
  }
  return best;
}

bool FleetPlanner::carries_load(std::uint32_t agv) const {
  const auto& goals = tasks_[agv].goals;
  const auto next = std::ranges::find_if(goals, [](const Goal& goal) { return goal.step.kind != Step::Kind::Charge; });
  return next != goals.end() && next->step.kind == Step::Kind::Drop;
}

// Those that do not wait are younger than all others.
bool FleetPlanner::is_older(std::uint32_t a, std::uint32_t b) const {
  const auto age = [&](std::uint32_t agv) {
    const Task& task = tasks_[agv];
    return std::tuple(task.since_ns < 0, task.since_ns, agv);
  };
  return age(a) < age(b);
}

std::vector<std::uint32_t> FleetPlanner::by_age() const {
  std::vector<std::uint32_t> agvs;
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) agvs.push_back(agv);
  std::ranges::sort(agvs, [&](std::uint32_t a, std::uint32_t b) { return is_older(a, b); });
  return agvs;
}

void FleetPlanner::plan(std::int64_t now_ns) {
  if (!book_.all_joined()) return;
  now_ns_ = now_ns;
  reserved_.clear();
  assign_open_orders();
  for (UnderWay& passing : passings_) carry_out(passing);
  std::erase_if(passings_, [&](const UnderWay& passing) { return is_over(passing); });
  for (const std::uint32_t agv : by_age()) plan_for(agv);
}

void FleetPlanner::plan_for(std::uint32_t agv) {
  Task& task = tasks_[agv];
  if (book_.way(agv).out_of_order || is_passing(agv) || time_left_s(agv) > kLead_s) return;
  look_at_battery(agv);
  if (task.charging) return;
  transfer_here(agv);
  if (task.charging) return;
  if (task.is_idle() && (!book_.way(agv).is_waiting() || places_.is_safe(book_.end_of_way(agv).station))) return;
  if (task.is_idle() || task.since_ns < 0) task.since_ns = task.is_idle() ? -1 : now_ns_;
  const bool plans_again = !task.wanted || seconds(now_ns_ - task.planned_ns) > kPlanAgain_s;
  if (plans_again || !is_identical(task.wanted->up_to(0), book_.end_of_way(agv))) {
    task.wanted = towards_goals(agv);
    task.planned_ns = now_ns_;
    task.obstruction = {};
  }
  if (task.wanted->ends.empty()) return;
  if ((is_still_obstructed(agv) || !extend(agv, *task.wanted)) && !task.is_idle()) wait(agv);
}

void FleetPlanner::transfer_here(std::uint32_t agv) {
  Task& task = tasks_[agv];
  while (!task.goals.empty()) {
    const Path here = book_.end_of_way(agv);
    const Goal goal = task.goals.front();
    if (goal.station != here.station || !map_.may_stay(here.station, here.heading)) return;
    if (!book_.grant(agv, {&goal.step, 1})) return;
    task.goals.pop_front();
    task.since_ns = -1;
    task.wanted.reset();
    task.charging = goal.step.kind == Step::Kind::Charge;
    if (task.charging) return;
  }
}

void FleetPlanner::look_at_battery(std::uint32_t agv) {
  if (!has_chargers_) return;
  Task& task = tasks_[agv];
  const double level = book_.way(agv).battery;
  if (level >= settings_.charge_to) task.charging = false;
  if (task.charging || !settings_.is_low(level)) return;
  if (!task.goals.empty() && task.goals.front().step.kind == Step::Kind::Charge) return;
  const bool loaded = carries_load(agv), urgent = settings_.is_urgent(level, loaded);
  if (loaded && !urgent) return;
  const std::uint32_t charger = free_charger(agv, urgent);
  if (charger == FP_NONE) return;
  task.goals.push_front({charger, {Step::Kind::Charge, FP_NONE}});
  task.wanted.reset();
}

// As far as the server knows; what the AGV has done since makes it less.
double FleetPlanner::time_left_s(std::uint32_t agv) const {
  const FloorBook::Way& way = book_.way(agv);
  const fp_agv& like = agv_of(geometry_.parts().facts(), agv);
  double sum_s = 0.0;
  Vec heading = way.held.heading;
  for (const Step& step : way.steps) {
    if (!step.drives()) {
      sum_s += kTransferTakes_s;
      continue;
    }
    if (!same_heading(heading, map_.start_heading(step.what))) sum_s += kTurnTakes_s;
    sum_s += map_.lane(step.what).length_m / lane_speed_mps(map_, step.what, like);
    heading = map_.end_heading(step.what);
  }
  return sum_s;
}

// ---- ways

void FleetPlanner::price(Model& model, std::uint32_t agv, bool loaded) {
  model.prices.begin(loaded);
  for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) {
    if (other == agv) continue;
    const FloorBook::Way& way = book_.way(other);
    const Task& task = tasks_[other];
    model.prices.price_station(book_.end_of_way(other).station, way.out_of_order    ? kWallPrice_s
                                                                : !way.is_waiting() ? kMovingPrice_s
                                                                                    : 0.0);
    model.prices.price_meetings(way.held);
    if (task.wanted) model.prices.price_meetings(task.wanted->path);
  }
}

void FleetPlanner::search(Model& model, const Path& from, std::uint32_t goal) {
  const auto remains_s = remaining_costs_s(geometry_.parts(), model.number, goal);
  model.routes.search_towards(goal, remains_s, from.station, from.heading, model.prices.costs_s());
}

// How much an AGV that stands there blocks. Two AGVs so near to each other that none of them can turn may stay for
// ever.
std::uint32_t FleetPlanner::burden_at(std::uint32_t agv, const Path& standing) {
  const std::uint32_t burden = places_.burden(standing.station);
  if (burden != 0) return burden;
  for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) {
    if (other != agv && geometry_.turns_conflict(agv, standing.station, other, book_.end_of_way(other).station))
      return kCrowdedBurden;
  }
  return 0;
}

// A section that grows lane by lane.
struct FleetPlanner::Walk {
  Walk(FleetPlanner& of, std::uint32_t id) : planner(of), agv(id) { section.path = planner.book_.end_of_way(agv); }

  FleetPlanner& planner;
  std::uint32_t agv;
  Section section;
  Section::End here, least;
  std::uint32_t least_burden = ~0U;
  double length_m = 0.0;
  bool ends_anywhere = false;  // of a faulty server: wherever it waits, it blocks nobody

  Path end() const { return end_of(planner.map_, section.path); }
  bool is_done() const { return !section.ends.empty() && (length_m >= kSection_m || here.goals > 0); }

  // False if the walk is done, or has no room for this lane.
  bool drive(std::uint32_t lane) {
    const double lane_m = planner.map_.lane(lane).length_m;
    if (planner.book_.way(agv).held.count + here.lanes >= kPathLanesMax) return false;
    if ((here.lanes > 0 && length_m + lane_m > kMostOfASection_m) || !section.path.append(lane)) return false;
    length_m += lane_m;
    section.steps.push_back({Step::Kind::Drive, lane});
    ++here.lanes;
    note_end();
    return true;
  }

  // False if the walk ends before the end of these lanes.
  bool follow(std::span<const std::uint32_t> lanes) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      if (!drive(lanes[i]) || (i + 1 < lanes.size() && is_done())) return false;
    }
    return !lanes.empty();
  }

  void transfer(const Goal& goal) {
    section.steps.push_back(goal.step);
    ++here.goals;
    note_end();
  }

  void note_end() {
    here.steps = static_cast<std::uint32_t>(section.steps.size());
    if (here.lanes == 0) return;
    const std::uint32_t burden = ends_anywhere ? 0 : planner.burden_at(agv, end());
    if (burden <= least_burden) least = here, least_burden = burden;
    if (burden > 0) return;
    if (!section.ends.empty() && section.ends.back().lanes == here.lanes) section.ends.pop_back();
    section.ends.push_back(here);
  }

  // If it passes no waiting place, it ends where the AGV blocks least.
  Section take() {
    if (section.ends.empty() && least.lanes > 0) section.ends.push_back(least);
    return std::move(section);
  }
};

// To the first goal and on to a waiting place, or to a waiting place on the way.
Section FleetPlanner::towards_goals(std::uint32_t agv) {
  Model& model = *model_of_[agv];
  bool loaded = carries_load(agv);
  price(model, agv, loaded);
  Walk walk(*this, agv);
  const auto& goals = tasks_[agv].goals;
  walk.ends_anywhere =
      !options_.ways_to_chargers_are_whole && !goals.empty() && goals.front().step.kind == Step::Kind::Charge;
  for (const Goal& goal : goals) {
    const Path here = walk.end();
    if (here.station != goal.station || !map_.may_stay(here.station, here.heading)) {
      search(model, here, goal.station);
      if (!walk.follow(model.routes.lanes(goal.station))) return walk.take();
    }
    walk.transfer(goal);
    if (goal.step.kind == Step::Kind::Charge && !walk.ends_anywhere) {  // it stays there, and nothing is behind it
      walk.section.ends.assign(1, walk.here);
      return walk.take();
    }
    if (walk.is_done()) return walk.take();
    const bool now_loaded = goal.step.kind == Step::Kind::Pick;
    if (model.rules.any() && now_loaded != loaded) price(model, agv, now_loaded);
    loaded = now_loaded;
  }
  const std::uint32_t place = waiting_place(agv, walk.end());
  if (place != FP_NONE) walk.follow(model.routes.lanes(place));
  return walk.take();
}

// The nearest one at which no other AGV is or will be. Afterwards, the way there may be asked for.
std::uint32_t FleetPlanner::waiting_place(std::uint32_t agv, const Path& from) {
  Model& model = *model_of_[agv];
  std::uint32_t found = FP_NONE;
  const auto look_at = [&](std::uint32_t station, double) {
    if (station == from.station || !places_.is_safe(station)) return false;
    for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) {
      if (other != agv && geometry_.turn_conflict(agv, station, other, book_.way(other).held)) return false;
    }
    found = station;
    return true;
  };
  model.routes.search_until(look_at, from.station, from.heading, model.prices.costs_s());
  return found;
}

std::uint32_t FleetPlanner::free_charger(std::uint32_t agv, bool urgent) {
  Model& model = *model_of_[agv];
  const Path standing = book_.end_of_way(agv);
  price(model, agv, carries_load(agv));
  model.routes.search(standing.station, standing.heading, model.prices.costs_s());
  const auto is_taken = [&](std::uint32_t station) {
    for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) {
      if (other == agv) continue;
      const auto& goals = tasks_[other].goals;
      const bool goes_there =
          !goals.empty() && goals.front().step.kind == Step::Kind::Charge && goals.front().station == station;
      if (goes_there || geometry_.turn_conflict(agv, station, other, book_.end_of_way(other))) return true;
    }
    return false;
  };
  std::uint32_t best = FP_NONE;
  double best_s = urgent ? 2.0 * kWallPrice_s : kWallPrice_s;
  for (std::uint32_t station = 0; station < map_.station_count(); ++station) {
    if ((map_.station(station).purposes & FP_CHARGING) == 0 || model.routes.cost_s(station) >= best_s) continue;
    const double cost_s = model.routes.cost_s(station) + (places_.is_safe(station) ? 0.0 : kUnsafeChargerPrice_s) +
                          (is_taken(station) ? kWallPrice_s : 0.0);
    if (cost_s < best_s) best = station, best_s = cost_s;
  }
  return best;
}

// ---- granting

// As much of the section as is free, up to one of its ends.
bool FleetPlanner::extend(std::uint32_t agv, const Section& section) {
  const std::uint32_t free = free_lanes(agv, section.path);
  if (section.ends.front().lanes > free) return false;
  const Section::End* best = nullptr;
  std::vector<Standing> fleet = standing_fleet(agv);
  for (const Section::End& end : section.ends) {
    fleet[agv].path = end_of(map_, section.up_to(end.lanes));
    if (end.lanes <= free && !is_stuck(map_, geometry_, fleet, agv)) best = &end;
  }
  if (best == nullptr || !book_.grant(agv, std::span(section.steps).first(best->steps))) return false;
  Task& task = tasks_[agv];
  task.charging = section.steps[best->steps - 1].kind == Step::Kind::Charge;
  task.goals.erase(task.goals.begin(), task.goals.begin() + best->goals);
  if (best->goals > 0) task.since_ns = -1;
  task.wanted.reset();
  task.in_vain = 0;
  return true;
}

std::uint32_t FleetPlanner::free_lanes(std::uint32_t agv, const Path& path) {
  Path part = path;
  const auto shorten = [&](std::uint32_t other, const Path& of_other) {
    if (other == agv || part.empty() || !book_.holds_floor(other) || !geometry_.conflict(agv, part, other, of_other))
      return;
    std::uint32_t free = 0, taken = part.count;
    while (free + 1 < taken) {
      part.count = (free + taken) / 2;
      (geometry_.conflict(agv, part, other, of_other) ? taken : free) = part.count;
    }
    part.count = free;
  };
  for (const AgvPath& need : reserved_) shorten(need.agv, need.path);
  for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) shorten(other, book_.way(other).held);
  return part.count;
}

bool FleetPlanner::is_still_obstructed(std::uint32_t agv) const {
  const Obstruction& known = tasks_[agv].obstruction;
  return known.by != FP_NONE && book_.way(known.by).changes == known.changes &&
         seconds(now_ns_ - known.seen_ns) < kLookAgain_s;
}

// Those in the way that stand may have to make way. If others are, they will pass; after a while, their successors must
// not pass as well.
void FleetPlanner::wait(std::uint32_t agv) {
  Task& task = tasks_[agv];
  const AgvPath need{agv, task.wanted->up_to(task.wanted->ends.front().lanes)};
  if (!is_still_obstructed(agv)) {
    // If nothing is in the way, it would be stuck at each end of the section.
    bool passes = free_lanes(agv, need.path) == need.path.count;
    task.obstruction = {};
    for (std::uint32_t other = 0; other < book_.fleet_count(); ++other) {
      if (!book_.is_held_by(other, agv, need.path)) continue;
      const FloorBook::Way& way = book_.way(other);
      const bool lasts = task.obstruction.lasts || way.is_waiting() || way.out_of_order;
      task.obstruction = {other, way.changes, now_ns_, lasts};
      passes = passes || makes_way(other, agv);
    }
    if (passes && book_.way(agv).is_waiting() && now_ns_ >= task.passes_ns) pass(agv);
  }
  if (!task.obstruction.lasts && task.since_ns >= 0 && seconds(now_ns_ - task.since_ns) > kKeepsFreeAfter_s)
    reserved_.push_back(need);
}

// ---- passing

bool FleetPlanner::is_passing(std::uint32_t agv) const {
  return std::ranges::any_of(passings_, [&](const Passing& passing) { return contains(passing.agvs, agv); });
}

// An AGV makes way if it stands and has no work, or has waited and is younger. After a while, older ones do, too.
bool FleetPlanner::makes_way(std::uint32_t agv, std::uint32_t leader) const {
  const Task& task = tasks_[agv];
  const FloorBook::Way& way = book_.way(agv);
  if (!way.is_waiting() || way.out_of_order || is_passing(agv)) return false;
  if (task.charging && !settings_.is_enough(way.battery)) return false;
  if (task.is_idle()) return true;
  if (!options_.ways_to_chargers_are_whole && task.goals.front().step.kind == Step::Kind::Charge) return false;
  const bool insists = seconds(now_ns_ - tasks_[leader].since_ns) > kInsists_s;
  return task.since_ns >= 0 && seconds(now_ns_ - task.since_ns) >= kYields_s && (insists || is_older(leader, agv));
}

// All AGVs, as this one sees them when it looks for a way past the others.
std::vector<Standing> FleetPlanner::standing_fleet(std::uint32_t leader) const {
  std::vector<Standing> fleet;
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    const FloorBook::Way& way = book_.way(agv);
    fleet.push_back({agv, way.out_of_order ? way.held : book_.end_of_way(agv), &model_of_[agv]->rules,
                     lane_costs_s(geometry_.parts(), agv), carries_load(agv), makes_way(agv, leader)});
  }
  return fleet;
}

void FleetPlanner::pass(std::uint32_t leader) {
  Task& task = tasks_[leader];
  std::vector<AgvPath> promised;
  for (const UnderWay& other : passings_) promised.insert(promised.end(), other.moves.begin(), other.moves.end());
  const std::size_t most = by_age().front() == leader ? kMostStatesOfTheOldest : kMostStates;
  Passing passing =
      find_passing(map_, geometry_, standing_fleet(leader), promised, leader, task.goals.front().station, most);
  if (passing.moves.empty()) {
    // If nobody takes part, AGVs are in the way that have just come to stand.
    task.passes_ns =
        now_ns_ + (kTryAgain_ns << std::min(task.in_vain++, passing.agvs.size() == 1 ? 2 : kMostDoublings));
    return;
  }
  task.in_vain = 0;
  for (const std::uint32_t agv : passing.agvs) tasks_[agv].wanted.reset(), tasks_[agv].charging = false;
  carry_out(passings_.emplace_back(UnderWay{{std::move(passing)}}));
}

// Grants moves of it as soon as they keep clear of all earlier ones that still have to wait.
void FleetPlanner::carry_out(UnderWay& passing) {
  std::uint32_t changes = 0;
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) changes += book_.way(agv).changes;
  std::vector<AgvPath> later;
  if (changes != passing.changes) {
    for (const AgvPath& move : passing.moves) {
      const bool is_next = std::ranges::none_of(later, [&](const AgvPath& before) {
        return before.agv == move.agv || geometry_.conflict(move.agv, move.path, before.agv, before.path);
      });
      const Step step{Step::Kind::Drive, move.path.lanes().front()};
      if (!is_next || !book_.grant(move.agv, {&step, 1})) later.push_back(move);
    }
    if (later.size() < passing.moves.size()) passing.granted_ns = now_ns_;
    passing.moves = std::move(later);
    passing.changes = changes;
  }
  reserved_.insert(reserved_.end(), passing.moves.begin(), passing.moves.end());
}

// Done, or not to be done any more: one of them is out of order, or an AGV stands in the way that did not before.
bool FleetPlanner::is_over(const UnderWay& passing) {
  if (passing.moves.empty() || seconds(now_ns_ - passing.granted_ns) > kGivesUp_s) return true;
  const AgvPath& next = passing.moves.front();
  for (std::uint32_t agv = 0; agv < book_.fleet_count(); ++agv) {
    const FloorBook::Way& way = book_.way(agv);
    if (contains(passing.agvs, agv)
            ? way.out_of_order
            : (way.is_waiting() || way.out_of_order) && book_.is_held_by(agv, next.agv, next.path))
      return true;
  }
  return false;
}

}  // namespace fleetproof::agents::central
