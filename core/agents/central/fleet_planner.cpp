#include "core/agents/central/fleet_planner.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

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
// So long an AGV waits before another one stops charging for it, although it has not enough.
constexpr double kEndsCharging_s = 40.0;
constexpr std::size_t kMostStates = 300, kMostStatesOfTheOldest = 2000;
constexpr std::int64_t kTryAgain_ns = 2'000'000'000;
constexpr int kMostDoublings = 4;
constexpr double kGivesUp_s = 120.0;  // if nothing of a passing was granted for so long

constexpr double kTransferTakes_s = 5.0;  // expected
// Prices of a station at which another AGV will stand for a while, or for good.
constexpr double kMovingPrice_s = 8.0, kChargingPrice_s = 60.0, kWallPrice_s = 1000.0;
constexpr std::uint32_t kCrowdedBurden = 1;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
bool takes_part(const Passing& passing, std::uint32_t agv) { return std::ranges::count(passing.agvs, agv) > 0; }

}  // namespace

FleetPlanner::FleetPlanner(const MapView& map, HullGeometry& geometry, FloorBook& book, const Settings& settings,
                           const ServerOptions& options)
    : map_(map),
      geometry_(geometry),
      book_(book),
      settings_(settings),
      options_(options),
      places_(map, geometry),
      routes_(map, geometry.parts()),
      tasks_(book.fleet_count()) {}

// ---- work

bool Task::carries_load() const {
  const auto next = std::ranges::find_if(goals, [](const Goal& goal) { return !goal.step.charges(); });
  return next != goals.end() && next->step.kind == Step::Kind::Drop;
}

bool Task::has_to(Step::Kind kind, std::uint32_t order) const {
  return std::ranges::find(goals, Step{kind, order}, &Goal::step) != goals.end();
}

void Task::take_order(const Order& order, bool on_board) {
  if (!on_board) goals.push_back({order.from, {Step::Kind::Pick, order.id}});
  goals.push_back({order.to, {Step::Kind::Drop, order.id}});
}

// What its former self was to pick, another AGV may pick now. It has waited as long as its former self.
void FleetPlanner::begin(std::uint32_t agv) {
  const std::int64_t since_ns = tasks_[agv].since_ns;
  tasks_[agv] = {};
  tasks_[agv].since_ns = since_ns;
  std::erase_if(passings_, [&](const Passing& passing) { return takes_part(passing, agv); });
  for (OpenOrder& open : open_) {
    const bool on_board = open.order.id == book_.way(agv).first_load;
    if (on_board) tasks_[agv].take_order(open.order, true);
    if (open.agv == agv || on_board) open.agv = on_board ? agv : std::uint32_t{FP_NONE};
  }
}

bool FleetPlanner::take_orders(std::uint32_t agv, std::uint32_t first, std::span<const Order> orders) {
  Task& task = tasks_[agv];
  if (task.cancelling && !task.carries_load()) task.goals.clear();
  task.cancelling = false;
  if (first > task.orders || first + orders.size() <= task.orders) return false;
  for (const Order& order : orders.subspan(task.orders - first)) {
    task.take_order(order, order.id == book_.way(agv).first_load);
    ++task.orders;
  }
  return true;
}

// After a restart of the server, an AGV may be carrying it out.
void FleetPlanner::take_open_order(const Order& order) {
  const auto agvs = book_.agvs();
  const auto agv = std::ranges::find_if(agvs, [&](std::uint32_t id) { return is_under_way(order.id, id); });
  open_.push_back({order, agv == agvs.end() ? std::uint32_t{FP_NONE} : *agv});
}

void FleetPlanner::withdraw(std::uint32_t order) {
  const auto open = std::ranges::find(open_, order, [](const OpenOrder& o) { return o.order.id; });
  if (open == open_.end()) return;
  if (open->agv != FP_NONE) {
    Task& task = tasks_[open->agv];
    if (!task.has_to(Step::Kind::Pick, order)) return;
    take_back(*open);
    task.cancelling = !options_.cancels_name_an_order;
  }
  open_.erase(open);
}

// Requires: its pick has not been granted.
void FleetPlanner::take_back(OpenOrder& open) {
  Task& task = tasks_[std::exchange(open.agv, FP_NONE)];
  std::erase_if(task.goals, [&](const Goal& goal) { return goal.step.what == open.order.id && !goal.step.charges(); });
  task.wanted.reset();
}

std::uint32_t FleetPlanner::work_of(std::uint32_t agv) const {
  const auto open = std::ranges::find(open_, agv, &OpenOrder::agv);
  return open == open_.end() ? FP_NONE : open->order.id;
}

std::uint32_t FleetPlanner::waits_for(std::uint32_t agv) const {
  const Task& task = tasks_[agv];
  return task.wanted && book_.way(agv).is_waiting() ? task.obstruction.by : FP_NONE;
}

// An AGV has at most the load on board to deliver before. If no charger is free, it works on, as long as it can.
void FleetPlanner::assign_open_orders() {
  std::erase_if(open_,
                [&](const OpenOrder& open) { return open.agv != FP_NONE && !is_under_way(open.order.id, open.agv); });
  std::vector<std::uint32_t> free;
  std::ranges::copy_if(book_.agvs(), std::back_inserter(free), [&](std::uint32_t agv) { return is_free(agv); });
  const auto takes_s = [&](std::uint32_t agv, std::uint32_t station) {
    double sum_s = time_left_s(agv);
    std::uint32_t at = book_.end_of_way(agv).station;
    for (const Goal& goal : tasks_[agv].goals)
      sum_s += routes_.usual_cost_s(agv, std::exchange(at, goal.station), goal.station) + kTransferTakes_s;
    return sum_s + routes_.usual_cost_s(agv, at, station);
  };
  assign(open_, free, takes_s, [&](std::uint32_t agv, const Order& order) { tasks_[agv].take_order(order, false); });
}

// What is neither a goal nor a granted step is done, or turned out to be impossible.
bool FleetPlanner::is_under_way(std::uint32_t order, std::uint32_t agv) const {
  const auto is_part = [&](const Step& step) { return !step.drives() && !step.charges() && step.what == order; };
  return std::ranges::any_of(tasks_[agv].goals, is_part, &Goal::step) ||
         std::ranges::any_of(book_.way(agv).steps, is_part);
}

bool FleetPlanner::is_free(std::uint32_t agv) const {
  const Task& task = tasks_[agv];
  const FloorBook::Way& way = book_.way(agv);
  if (task.charging || way.out_of_order) return false;
  if (task.is_idle()) return !settings_.is_urgent(way.battery, false);
  return task.goals.size() == 1 && task.carries_load() && !settings_.is_low(way.battery);
}

// Those that do not wait are younger than all others.
bool FleetPlanner::is_older(std::uint32_t a, std::uint32_t b) const {
  const auto age = [&](std::uint32_t agv) { return std::tuple(tasks_[agv].since_ns < 0, tasks_[agv].since_ns, agv); };
  return age(a) < age(b);
}

std::vector<std::uint32_t> FleetPlanner::by_age() const {
  std::vector<std::uint32_t> agvs(book_.agvs().begin(), book_.agvs().end());
  std::ranges::sort(agvs, [&](std::uint32_t a, std::uint32_t b) { return is_older(a, b); });
  return agvs;
}

void FleetPlanner::plan(std::int64_t now_ns) {
  if (!book_.all_joined()) return;
  now_ns_ = now_ns;
  reserved_.clear();
  for (const std::uint32_t agv : by_age()) look_at_battery(agv);
  assign_open_orders();
  for (UnderWay& passing : passings_) carry_out(passing);
  std::erase_if(passings_, [&](const UnderWay& passing) { return is_over(passing); });
  for (const std::uint32_t agv : by_age()) plan_for(agv);
}

void FleetPlanner::plan_for(std::uint32_t agv) {
  Task& task = tasks_[agv];
  if (book_.way(agv).out_of_order || is_passing(agv) || time_left_s(agv) > kLead_s) return;
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
  while (!task.charging && !task.is_idle()) {
    const Path here = book_.end_of_way(agv);
    const Goal goal = task.goals.front();
    if (goal.station != here.station || !map_.may_stay(here.station, here.heading)) return;
    if (!book_.grant(agv, {&goal.step, 1})) return;
    note_grant(agv, 1);
    task.charging = goal.step.charges();
  }
}

void FleetPlanner::look_at_battery(std::uint32_t agv) {
  Task& task = tasks_[agv];
  const double level = book_.way(agv).battery;
  if (level >= settings_.charge_to) task.charging = false;
  if (task.charging || !settings_.is_low(level) || task.goes_to_charger() || !map_.has_chargers()) return;
  if (book_.way(agv).out_of_order || is_passing(agv) || time_left_s(agv) > kLead_s) return;
  const bool loaded = task.carries_load(), urgent = settings_.is_urgent(level, loaded);
  if (loaded && !urgent) return;
  const auto is_taken = [&](std::uint32_t station) {
    if (!options_.ways_to_chargers_are_whole) return false;
    return std::ranges::any_of(book_.agvs(), [&](std::uint32_t other) {
      const bool goes_there = tasks_[other].goes_to_charger() && tasks_[other].goals.front().station == station;
      return other != agv && (goes_there || geometry_.turn_conflict(agv, station, other, book_.end_of_way(other)));
    });
  };
  price(agv, loaded);
  const std::uint32_t charger = routes_.charger(agv, book_.end_of_way(agv), places_, urgent, is_taken);
  if (charger == FP_NONE) return;
  for (OpenOrder& open : open_) {
    if (open.agv == agv && task.has_to(Step::Kind::Pick, open.order.id)) take_back(open);  // another AGV is there first
  }
  task.goals.insert(task.goals.begin(), {charger, {Step::Kind::Charge, FP_NONE}});
  task.wanted.reset();
}

// As far as the server knows; what the AGV has done since makes it less.
double FleetPlanner::time_left_s(std::uint32_t agv) const {
  const FloorBook::Way& way = book_.way(agv);
  return routes_.takes_s(agv, way.held) + kTransferTakes_s * static_cast<double>(way.steps.size() - way.held.count);
}

double FleetPlanner::waits_s(std::uint32_t agv) const {
  return tasks_[agv].since_ns < 0 ? 0.0 : seconds(now_ns_ - tasks_[agv].since_ns);
}

// ---- ways

void FleetPlanner::price(std::uint32_t agv, bool loaded) {
  LanePrices& prices = routes_.prices(agv);
  prices.begin(loaded);
  for (const std::uint32_t other : book_.agvs()) {
    if (other == agv) continue;
    const FloorBook::Way& way = book_.way(other);
    const double waiting_s = tasks_[other].charging ? kChargingPrice_s : 0.0;
    const double price_s = way.out_of_order ? kWallPrice_s : way.is_waiting() ? waiting_s : kMovingPrice_s;
    prices.price_station(book_.end_of_way(other).station, price_s);
    prices.price_meetings(way.held);
    if (tasks_[other].wanted) prices.price_meetings(tasks_[other].wanted->path);
  }
}

// How much an AGV that stands there blocks. Two AGVs so near to each other that none of them can turn may stay for
// ever.
std::uint32_t FleetPlanner::burden_at(std::uint32_t agv, const Path& standing) {
  const std::uint32_t burden = places_.burden(standing.station);
  const auto crowds = [&](std::uint32_t other) {
    return other != agv && geometry_.turns_conflict(agv, standing.station, other, book_.end_of_way(other).station);
  };
  return burden == 0 && std::ranges::any_of(book_.agvs(), crowds) ? kCrowdedBurden : burden;
}

// A section that grows lane by lane.
struct FleetPlanner::Walk {
  Walk(FleetPlanner& of, std::uint32_t id) : planner(of), agv(id) {
    section.path = planner.book_.end_of_way(agv);
    here.loaded = planner.tasks_[agv].carries_load();
  }

  FleetPlanner& planner;
  std::uint32_t agv;
  Section section;
  Section::End here, least;
  std::uint32_t least_burden = ~0U;
  double length_m = 0.0;
  bool ends_anywhere = false;  // of a faulty server: wherever it waits, it blocks nobody

  Path end() const { return end_of(planner.map_, section.path); }
  bool is_done() const { return !section.ends.empty() && (length_m >= kSection_m || here.goals > 0); }

  // False if the walk ends before the end of these lanes: it is done, or has no room for the next one.
  bool follow(std::span<const std::uint32_t> lanes) {
    const std::uint32_t held = planner.book_.way(agv).held.count;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const double longer_m = length_m + planner.map_.lane(lanes[i]).length_m;
      const bool is_full = held + here.lanes >= kPathLanesMax || (here.lanes > 0 && longer_m > kMostOfASection_m);
      if (is_full || (i > 0 && is_done())) return false;
      length_m = longer_m;
      section.path.append(lanes[i]);
      section.steps.push_back({Step::Kind::Drive, lanes[i]});
      ++here.lanes;
      note_end();
    }
    return !lanes.empty();
  }

  void transfer(const Goal& goal) {
    section.steps.push_back(goal.step);
    ++here.goals;
    if (!goal.step.charges()) here.loaded = goal.step.kind == Step::Kind::Pick;
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
  const Task& task = tasks_[agv];
  price(agv, task.carries_load());
  Walk walk(*this, agv);
  walk.ends_anywhere = !options_.ways_to_chargers_are_whole && task.goes_to_charger();
  for (const Goal& goal : task.goals) {
    const Path here = walk.end();
    const bool loaded = walk.here.loaded;
    const bool is_there = here.station == goal.station && map_.may_stay(here.station, here.heading);
    if (!is_there && !walk.follow(routes_.way(agv, here, goal.station))) return walk.take();
    walk.transfer(goal);
    const bool stays = goal.step.charges() && !walk.ends_anywhere;  // whatever it blocks there
    if (stays) walk.section.ends.assign(1, walk.here);
    if (stays || walk.is_done()) return walk.take();
    if (routes_.rules(agv).any() && walk.here.loaded != loaded) price(agv, walk.here.loaded);
  }
  // To the nearest one at which no other AGV is or will be.
  const Path from = walk.end();
  walk.follow(routes_.way_to_first(agv, from, [&](std::uint32_t station) {
    return station != from.station && places_.is_safe(station) &&
           std::ranges::none_of(book_.agvs(), [&](std::uint32_t other) {
             return other != agv && geometry_.turn_conflict(agv, station, other, book_.way(other).held);
           });
  }));
  return walk.take();
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
    fleet[agv].loaded = end.loaded;
    if (end.lanes <= free && !is_stuck(map_, geometry_, fleet, agv)) best = &end;
  }
  if (best == nullptr || !book_.grant(agv, std::span(section.steps).first(best->steps))) return false;
  tasks_[agv].charging = section.steps[best->steps - 1].charges();
  tasks_[agv].in_vain = 0;
  note_grant(agv, best->goals);
  return true;
}

// So many of its goals are among the granted steps.
void FleetPlanner::note_grant(std::uint32_t agv, std::uint32_t goals) {
  Task& task = tasks_[agv];
  task.goals.erase(task.goals.begin(), task.goals.begin() + goals);
  if (goals > 0) task.since_ns = -1;
  task.wanted.reset();
}

std::uint32_t FleetPlanner::free_lanes(std::uint32_t agv, const Path& path) {
  Path part = path;
  const auto shorten = [&](std::uint32_t other, const Path& of_other) {
    if (other != agv && !part.empty() && book_.holds_floor(other))
      part.count = geometry_.clear_lanes(agv, part, other, of_other);
  };
  for (const AgvPath& need : reserved_) shorten(need.agv, need.path);
  for (const std::uint32_t other : book_.agvs()) shorten(other, book_.way(other).held);
  return part.count;
}

bool FleetPlanner::is_still_obstructed(std::uint32_t agv) const {
  const Obstruction& known = tasks_[agv].obstruction;
  return known.by != FP_NONE && book_.way(known.by).change == known.change &&
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
    for (const std::uint32_t other : book_.agvs()) {
      if (!book_.is_held_by(other, agv, need.path)) continue;
      const FloorBook::Way& way = book_.way(other);
      const bool lasts = task.obstruction.lasts || way.is_waiting() || way.out_of_order;
      task.obstruction = {other, way.change, now_ns_, lasts};
      passes = passes || makes_way(other, agv);
    }
    const bool only_waits = !options_.ways_to_chargers_are_whole && task.goes_to_charger();
    if (passes && !only_waits && book_.way(agv).is_waiting() && now_ns_ >= task.passes_ns) pass(agv);
  }
  if (!task.obstruction.lasts && waits_s(agv) > kKeepsFreeAfter_s) reserved_.push_back(need);
}

// ---- passing

bool FleetPlanner::is_passing(std::uint32_t agv) const {
  return std::ranges::any_of(passings_, [&](const Passing& passing) { return takes_part(passing, agv); });
}

// An AGV makes way if it stands and has no work, or has waited and is younger. After a while, older ones do, too.
bool FleetPlanner::makes_way(std::uint32_t agv, std::uint32_t leader) const {
  const Task& task = tasks_[agv];
  const FloorBook::Way& way = book_.way(agv);
  if (!way.is_waiting() || way.out_of_order || is_passing(agv)) return false;
  const bool stops = waits_s(leader) > kEndsCharging_s && !tasks_[leader].goes_to_charger();
  if (task.charging && !settings_.is_enough(way.battery) && (!stops || settings_.is_urgent(way.battery, true)))
    return false;
  if (task.is_idle()) return true;
  if (!options_.ways_to_chargers_are_whole && task.goes_to_charger()) return false;
  return waits_s(agv) >= kYields_s && (waits_s(leader) > kInsists_s || is_older(leader, agv));
}

// All AGVs, as this one sees them when it looks for a way past the others.
std::vector<Standing> FleetPlanner::standing_fleet(std::uint32_t leader) const {
  std::vector<Standing> fleet;
  for (const std::uint32_t agv : book_.agvs()) {
    const FloorBook::Way& way = book_.way(agv);
    fleet.push_back({agv, way.out_of_order ? way.held : book_.end_of_way(agv), &routes_.rules(agv),
                     lane_costs_s(geometry_.parts(), agv), tasks_[agv].carries_load(), makes_way(agv, leader)});
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

// Grants moves of it, and keeps the floor of the others.
void FleetPlanner::carry_out(UnderWay& passing) {
  agents::carry_out(passing, geometry_, book_.changes(), now_ns_, [&](const AgvPath& move) {
    const Step step{Step::Kind::Drive, move.path.lanes().front()};
    return book_.grant(move.agv, {&step, 1});
  });
  reserved_.insert(reserved_.end(), passing.moves.begin(), passing.moves.end());
}

// Done, or not to be done any more: one of them is out of order, or an AGV stands in the way that did not before.
bool FleetPlanner::is_over(const UnderWay& passing) const {
  if (passing.moves.empty() || seconds(now_ns_ - passing.given_ns) > kGivesUp_s) return true;
  const AgvPath& next = passing.moves.front();
  return std::ranges::any_of(book_.agvs(), [&](std::uint32_t agv) {
    const FloorBook::Way& way = book_.way(agv);
    if (takes_part(passing, agv)) return way.out_of_order;
    return (way.is_waiting() || way.out_of_order) && book_.is_held_by(agv, next.agv, next.path);
  });
}

}  // namespace fleetproof::agents::central
