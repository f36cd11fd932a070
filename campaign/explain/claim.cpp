#include "campaign/explain/claim.hpp"

#include <fmt/format.h>

#include "core/base/shown_time.hpp"

namespace fleetproof {

bool avoids(const CaseRun& run, const FailingCase& failing, const FailurePattern& pattern) {
  return failing.failure.is_violation ? run.outcome.violations.empty() : !pattern.match(run);
}

std::string name_of_body(const Scenario& scenario, EntityId body) {
  if (!body.valid()) return "an AGV";  // that picks an open transport
  if (body < scenario.first_obstacle()) return scenario.name_of(body);
  if (body < scenario.first_fallen_load()) return scenario.obstacle(body).name;
  return "a fallen load";
}

std::string words_of(const std::string& kind, const std::string& content) {
  if (kind.empty()) return "not described";
  return content.empty() ? kind : kind + ": " + content;
}

std::string words_of(const MessageDelivery& message) { return words_of(message.kind, message.content); }

std::string message_text(const Scenario& scenario, const MessageDelivery& message) {
  const GivenDelivery& delivery = message.delivery;
  return fmt::format("message {} ({}{} to {}, {:.3f} s)", message.number,
                     message.kind.empty() ? "" : words_of(message) + ", ", name_of_body(scenario, delivery.sender),
                     name_of_body(scenario, delivery.receiver), shown_seconds(delivery.sent));
}

}  // namespace fleetproof
