#include "generators/scenario_file/unmet_requests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "core/base/outside_text.hpp"
#include "core/scenario/scripted_agent.hpp"

namespace fleetproof {
namespace {

class Requests {
 public:
  explicit Requests(const Scenario& scenario) : scenario_(scenario) {}

  std::vector<UnmetRequest> run() {
    for (std::size_t i = 0; i < scenario_.agvs.size(); ++i) agv(i);
    late_things("/transports", "open transports", scenario_.open_orders, &TransportOrder::release);
    for (std::size_t i = 0; i < scenario_.faults.size(); ++i) fault(i);
    for (std::size_t i = 0; i < scenario_.obstacles.size(); ++i) obstacle(i);
    late_things("/fates", "messages with a given delivery", scenario_.deliveries, &GivenDelivery::sent);
    if (!scenario_.deliveries.empty() && plays_scripts(scenario_.agent))
      add("/fates", "the agent \"scripted\" sends no messages, so no delivery is used; leave them out");
    adverse_scope();
    idle_radio();
    idle_rules();
    if (const auto& help = scenario_.operator_help; help.on && seconds(help.least_s) > scenario_.horizon)
      add("/operator/least_s",
          fmt::format("the operator comes {:g} s after a call, which is {}", help.least_s, after()));
    return std::move(unmet_);
  }

 private:
  void add(std::string pointer, std::string sentence) { unmet_.push_back({std::move(pointer), std::move(sentence)}); }

  // An event at the end of the run still takes place.
  bool is_late(Duration at) const { return at > scenario_.horizon; }
  std::string after() const {
    return fmt::format("after the end of the run (horizon_s is {:g}); make the run longer, or this earlier",
                       to_seconds(scenario_.horizon));
  }

  // One sentence for all things of a list that are late.
  template <class Thing>
  void late_things(const std::string& list, std::string_view what, const std::vector<Thing>& things,
                   Duration Thing::*at) {
    const auto late = [&](const Thing& thing) { return is_late(thing.*at); };
    const auto first = std::ranges::find_if(things, late);
    if (first == things.end()) return;
    const auto count = std::ranges::count_if(things, late);
    add(fmt::format("{}/{}", list, first - things.begin()),
        fmt::format("{} of {} {} {} {}", count, things.size(), what, count == 1 ? "comes" : "come", after()));
  }

  void agv(std::size_t i) {
    const AgvSetup& agv = scenario_.agvs[i];
    const std::string place = fmt::format("/agvs/{}", i), name = in_quotes(agv.name);
    late_things(place + "/transports", "orders of " + name, agv.transports, &TransportOrder::release);
    if (!agv.script.empty() && !scenario_.agent.empty() && !plays_scripts(scenario_.agent))
      add(place + "/script",
          fmt::format("only the agent \"scripted\" plays a script, and the agent is {}; leave one out",
                      in_quotes(scenario_.agent)));
    else
      late_things(place + "/script", "calls of the script of " + name, agv.script, &ScriptedCall::at);
  }

  void fault(std::size_t i) {
    const Fault& fault = scenario_.faults[i];
    const std::string place = fmt::format("/faults/{}", i);
    const bool counts_from_pick = fault.transport.has_value();
    const auto& orders = fault.agv.valid() && scenario_.is_agv(fault.agv) ? scenario_.agvs[fault.agv.index()].transports
                                                                          : scenario_.open_orders;
    const Duration earliest = fault.at + (counts_from_pick ? orders[*fault.transport].release : Duration{});
    const std::string whose = fault.agv.valid() ? in_quotes(scenario_.name_of(fault.agv))
                                                : fmt::format("open transport {}", fault.transport.value_or(0));
    if (is_late(earliest))
      add(place + "/at_s", fmt::format("the {} of {} comes {}at {:g} s, {}", text_of(fault), whose,
                                       counts_from_pick ? "at the earliest " : "", to_seconds(earliest), after()));
    if (fault.kind == Fault::Kind::LoadDrop && fault.agv.valid())
      load_drop(place, fault, scenario_.agvs[fault.agv.index()]);
    else if (fault.kind == Fault::Kind::LoadDrop)
      return;  // how large the AGV is that picks the load is not known
    else if (describes_load(fault))
      add(place,
          fmt::format("a {} has no load, so length_m, width_m, ahead_m and left_m change nothing; leave them out",
                      name_of(fault.kind)));
    if (fault.kind != Fault::Kind::Named && (!fault.word.empty() || fault.number != 0))
      add(place,
          fmt::format("a {} has no name, so word and number change nothing; leave them out", name_of(fault.kind)));
  }
  static bool describes_load(const Fault& fault) {
    const Fault usual;
    return fault.load != usual.load || fault.ahead_m != usual.ahead_m || fault.left_m != usual.left_m;
  }

  void load_drop(const std::string& place, const Fault& fault, const AgvSetup& agv) {
    if (agv.transports.empty() && scenario_.open_orders.empty())
      return add(place + "/agv", fmt::format("{} has no transports, so it never carries a load that could fall; give "
                                             "it one, or leave the fault out",
                                             in_quotes(agv.name)));
    const OrientedRectangle body{Vec2::Zero(), Vec2::UnitX(), 0.5 * loaded(agv).length_m, 0.5 * loaded(agv).width_m};
    const OrientedRectangle load = placed(fault.load, {{fault.ahead_m, fault.left_m}, Vec2::UnitX()});
    const double gap_m = std::max(0.0, clearance_m(body, load)), distance_m = scenario_.law.safety_distance_m;
    if (gap_m > distance_m) return;
    add(place + "/ahead_m",
        fmt::format(
            "the load would lie {:.3g} m from {}, which drops it, and it needs more than the safety distance of "
            "{:g} m; so it does not fall: set ahead_m below {:g}",
            gap_m, in_quotes(agv.name), distance_m, -(body.half_length_m + 0.5 * fault.load.length_m + distance_m)));
  }
  Footprint loaded(const AgvSetup& agv) const { return scenario_.type_of(agv).footprint_with(true); }

  void obstacle(std::size_t i) {
    const ObstacleSetup& obstacle = scenario_.obstacles[i];
    const std::string place = fmt::format("/obstacles/{}", i), name = in_quotes(obstacle.name);
    if (is_late(obstacle.appears))
      return add(place + "/appears_s",
                 fmt::format("{} appears at {:g} s, {}", name, to_seconds(obstacle.appears), after()));
    if (obstacle.appears == Duration::zero()) return;
    const OrientedRectangle body = placed(obstacle.footprint, obstacle.pose);
    for (const ObstacleSetup& other : scenario_.obstacles) {
      const bool always =
          other.appears == Duration::zero() && other.leaves >= std::min(obstacle.leaves, scenario_.horizon);
      if (&other == &obstacle || !always) continue;
      const double gap_m = std::max(0.0, clearance_m(body, placed(other.footprint, other.pose)));
      if (gap_m > scenario_.law.safety_distance_m + kAppearsClear_m) continue;
      return add(
          place + "/position_m",
          fmt::format("{} would stand {:.3g} m from obstacle {}, which is there all the time; it needs more than "
                      "{:g} m, so it never appears: move one",
                      name, gap_m, in_quotes(other.name), scenario_.law.safety_distance_m + kAppearsClear_m));
    }
  }

  void adverse_scope() {
    const AdverseScope& adverse = scenario_.radio.adverse;
    if (is_late(seconds(adverse.adverse_from_s)))
      add("/radio/adverse_from_s",
          fmt::format("the radio loses and delays messages from {:g} s on, {}", adverse.adverse_from_s, after()));
    if (adverse.adverse_until_s > 0.0 && adverse.adverse_until_s <= adverse.adverse_from_s)
      add("/radio/adverse_until_s", fmt::format("{:g} s is not after adverse_from_s, which is {:g}; so the radio loses "
                                                "and delays nothing: let it end later",
                                                adverse.adverse_until_s, adverse.adverse_from_s));
  }

  // Fields which count only beside another one. That one is told if any of them is not as usual.
  void idle(bool is_usual, bool counts, std::string_view pointer, std::string_view sentence) {
    if (!is_usual && !counts) add(std::string(pointer), std::string(sentence));
  }

  void idle_radio() {
    const RadioSetup& radio = scenario_.radio;
    const RadioSetup usual;
    const auto of_outages = [](const OutageSetup& s) { return std::tuple(s.model, s.scope, s.loss_good, s.loss_bad); };
    const auto of_tail = [](const DelayTailSetup& s) {
      return std::tuple(s.min_share, s.median_share, s.shape, s.cap_share);
    };
    const auto of_changes = [](const PlaceSetup& s) { return std::tuple(s.roaming_min_s, s.roaming_max_s); };
    const bool has_outages = radio.outages.mean_outage_s > 0.0, has_windows = radio.places.roaming_border_m > 0.0,
               roams = has_windows || radio.places.roaming_at_crossing;
    idle(
        of_outages(radio.outages) == of_outages(usual.outages), has_outages, "/radio/mean_outage_s",
        "0 s: there are no outages, so outage_model, outage_scope, loss_good and loss_bad change nothing; set it above "
        "0, or leave them out");
    idle(radio.outages.shape == usual.outages.shape,
         has_outages && radio.outages.model == OutageSetup::Model::HeavyTail, "/radio/outage_shape",
         "it counts only with outages (mean_outage_s above 0) of the model \"heavy-tail\"; set both, or leave it out");
    idle(
        of_tail(radio.delay_tail) == of_tail(usual.delay_tail), radio.delay_model == RadioSetup::DelayModel::HeavyTail,
        "/radio/delay_model",
        "it is not \"heavy-tail\", so delay_min_share, delay_median_share, delay_tail_shape and delay_cap_share change "
        "nothing; set it, or leave them out");
    idle(of_changes(radio.places) == of_changes(usual.places), roams, "/radio/roaming_at_crossing",
         "no AGV changes its access point, so roaming_min_s and roaming_max_s change nothing; set it or "
         "roaming_border_m, or leave them out");
    idle(radio.places.roaming_gap_s == usual.places.roaming_gap_s, has_windows, "/radio/roaming_border_m",
         "0 m: borders have no windows, so roaming_gap_s changes nothing; set it above 0, or leave roaming_gap_s out");
    idle(radio.places.ap_spacing_m == usual.places.ap_spacing_m,
         roams || (has_outages && radio.outages.scope == OutageSetup::Scope::Place), "/radio/ap_spacing_m",
         "it counts only if AGVs change their access point, or for outages of places; set roaming_at_crossing, "
         "roaming_border_m, or outage_scope to \"place\", or leave it out");
    idle(radio.contention.contention_window == usual.contention.contention_window, radio.contention.interference,
         "/radio/contention_window", "it counts only with interference; set interference to true, or leave it out");
  }

  void idle_rules() {
    const LawSetup& law = scenario_.law;
    const bool is_exempt = law.exempt_purposes != Purposes{} && law.exempt_radius_m > 0.0;
    idle(law.exempt_purposes == Purposes{}, is_exempt, "/law/exempt_radius_m",
         "0 m: exempt_purposes exempts nothing; set it above 0, or leave exempt_purposes out");
    idle(law.exempt_radius_m == 0.0, is_exempt, "/law/exempt_purposes",
         "none: exempt_radius_m exempts nothing; name a purpose, or leave exempt_radius_m out");
    ScannerSetup scanner;
    OperatorSetup help;
    scanner.on = help.on = true;
    const auto off = [](auto setup) { return setup.on = true, setup; };
    idle(off(scenario_.scanner) == scanner, scenario_.scanner.on, "/scanner/on",
         "the scanners are off, so the other fields change nothing; set it to true, or leave them out");
    idle(off(scenario_.operator_help) == help, scenario_.operator_help.on, "/operator/on",
         "the operator is off, so the other fields change nothing; set it to true, or leave them out");
  }

  const Scenario& scenario_;
  std::vector<UnmetRequest> unmet_;
};

}  // namespace

std::vector<UnmetRequest> unmet_requests(const Scenario& scenario) { return Requests(scenario).run(); }

}  // namespace fleetproof
