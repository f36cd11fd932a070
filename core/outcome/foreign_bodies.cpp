#include "core/outcome/foreign_bodies.hpp"

#include <algorithm>
#include <map>

namespace fleetproof {

bool is_foreign(EntityId body, const Outcome& outcome) {
  return body.valid() && outcome.agv_count > 0 && body.value >= outcome.agv_count;
}

std::vector<bool> answerable(const Outcome& outcome) {
  std::map<EntityId, SimTime> wrecks;  // AGVs that hit a foreign body, or such a wreck: how long they lie there
  std::vector<bool> answers;
  const auto taints = [&](EntityId body, SimTime at) {
    const auto wreck = wrecks.find(body);
    return is_foreign(body, outcome) || (wreck != wrecks.end() && at <= wreck->second);
  };
  for (const Violation& violation : outcome.violations) {  // in order of their beginning
    const bool tainted = taints(violation.a, violation.first) || taints(violation.b, violation.first);
    answers.push_back(!tainted);
    if (!tainted || !violation.contact) continue;
    for (const EntityId body : {violation.a, violation.b}) {
      SimTime& until = wrecks.try_emplace(body, violation.last).first->second;
      until = std::max(until, violation.last);
    }
  }
  return answers;
}

bool foreign_body_lay(const Outcome& outcome, const Incident& incident) {
  return std::ranges::any_of(outcome.incidents, [&](const Incident& body) {
    return body.kind == IncidentKind::ForeignBody && body.first < incident.last && body.last > incident.first;
  });
}

bool met_foreign_bodies(const Outcome& outcome) {
  const auto is_body = [](const Incident& incident) { return incident.kind == IncidentKind::ForeignBody; };
  const auto is_with_body = [&](const Violation& violation) {
    return is_foreign(violation.a, outcome) || is_foreign(violation.b, outcome);
  };
  return std::ranges::any_of(outcome.incidents, is_body) || std::ranges::any_of(outcome.violations, is_with_body);
}

}  // namespace fleetproof
