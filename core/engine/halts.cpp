#include "core/engine/halts.hpp"

#include <algorithm>

namespace fleetproof {

Halts::Halts(RunContext& run, ActionsPort actions) : run_(run), actions_(actions), begun_(run.agvs.size()) {}

std::uint64_t Halts::begin(AgvId agv, Halt::Reason reason) {
  AgvStatus& status = run_.status(agv);
  const std::uint64_t number = ++begun_[agv.index()];
  const bool held_as_much = reason == Halt::Reason::Agent ? !status.halts.empty() : status.is_held();
  status.halts.push_back({reason, number});
  if (!held_as_much && status.activity) actions_.brake(agv);
  return number;
}

void Halts::end(AgvId agv, std::uint64_t number) {
  AgvStatus& status = run_.status(agv);
  const auto over = std::ranges::find(status.halts, number, &Halt::number);
  if (over == status.halts.end()) return;
  const bool by_agent = over->reason == Halt::Reason::Agent;
  status.halts.erase(over);
  const bool held_less = status.halts.empty() || (!by_agent && !status.is_held());
  if (!held_less || status.out_of_order) return;
  // An agent that holds its AGV and lets it go has done nothing by that.
  if (!by_agent && !status.is_driving()) run_.progressed(agv);
  actions_.go_on(agv);
}

void Halts::end_all(AgvId agv, Halt::Reason reason) {
  const auto& halts = run_.status(agv).halts;
  while (true) {
    const auto found = std::ranges::find(halts, reason, &Halt::reason);
    if (found == halts.end()) return;
    end(agv, found->number);
  }
}

}  // namespace fleetproof
