#include "generators/scenario_file/script_check.hpp"

#include <fmt/format.h>

#include "core/base/outside_text.hpp"
#include "core/scenario/lane_rules.hpp"

namespace fleetproof {
namespace {

class ScriptCheck {
 public:
  ScriptCheck(const Scenario& scenario, std::size_t agv, Problems& problems)
      : map_(*scenario.map),
        agv_(scenario.agvs[agv]),
        type_(agv_.type < scenario.vehicle_types.size() ? std::string_view(scenario.type_of(agv_).name) : ""),
        place_(fmt::format("/agvs/{}/script", agv)),
        problems_(problems) {}

  void check() {
    Duration last{};
    for (std::size_t k = 0; k < agv_.script.size(); ++k) {
      const ScriptedCall& call = agv_.script[k];
      if (!call.segment.valid())
        call_without_segment(k);
      else if (call.segment.index() >= map_.segment_count())
        add(k, "segment", "there is no such segment");
      else
        call_with_segment(k);
      if (call.at < last)
        problems_.push_back({ProblemKind::NumberOutOfRange, fmt::format("{}/{}/at_ns", place_, k),
                             fmt::format("{} s: calls are listed in order of time", to_seconds(call.at))});
      last = call.at;
    }
  }

 private:
  void add(std::size_t k, std::string_view key, std::string sentence) {
    problems_.push_back({ProblemKind::UnknownReference, fmt::format("{}/{}/{}", place_, k, key), std::move(sentence)});
  }

  // Where a later call begins depends on the run.
  bool starts_here(std::size_t k) const { return k == 0 && agv_.start.index() < map_.station_count(); }

  void call_without_segment(std::size_t k) {
    const ScriptedCall& call = agv_.script[k];
    if (call.action == ScriptedCall::Action::Move)
      return add(k, "action",
                 "a move needs a segment; name it (only pick, drop, park and charge may leave it out: then the AGV "
                 "does them where it stands)");
    if (call.backward)
      add(k, "backward", "without a segment the AGV does not drive; leave backward out, or name the segment");
    if (!starts_here(k) || LaneRules{map_, type_}.may_stay(agv_.start, agv_.heading)) return;
    const Station& station = map_.station(agv_.start);
    add(k, "action",
        fmt::format("{} cannot {} at {} with its first heading [{:g}, {:g}]; the station wants [{:g}, {:g}]: start "
                    "with that heading, or name a segment to drive first",
                    in_quotes(agv_.name), name_of(call.action), in_quotes(station.name), agv_.heading.x(),
                    agv_.heading.y(), station.heading->x(), station.heading->y()));
  }

  void call_with_segment(std::size_t k) {
    const ScriptedCall& call = agv_.script[k];
    const Segment& segment = map_.segment(call.segment);
    if (!call.backward) return;
    const bool first = starts_here(k) && (agv_.start == segment.from || agv_.start == segment.to);
    const bool there = map_.backward_lane(call.segment, segment.from) != nullptr,
               back = map_.backward_lane(call.segment, segment.to) != nullptr;
    if (first ? (agv_.start == segment.from ? there : back) : there || back) return;
    add(k, "backward",
        fmt::format("{} cannot drive segment {} backward{}; leave backward out, or set {} of the segment to backward "
                    "or either",
                    in_quotes(agv_.name), in_quotes(segment.name),
                    first ? " from " + in_quotes(map_.station(agv_.start).name) : "",
                    first && agv_.start == segment.to ? "back_travel" : "travel"));
  }

  const LogicalMap& map_;
  const AgvSetup& agv_;
  std::string_view type_;
  std::string place_;
  Problems& problems_;
};

}  // namespace

void check_script(const Scenario& scenario, std::size_t agv, Problems& problems) {
  ScriptCheck(scenario, agv, problems).check();
}

}  // namespace fleetproof
