#include "reports/page/lenient_conditions.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/page/wording.hpp"

namespace fleetproof {

std::string lenient_text(const LenientCondition& condition) {
  const std::string usual = condition.usual.empty() ? "none" : printable(condition.usual, 60);
  return fmt::format("{} = {} (usual: {})", condition.field, printable(condition.value, 120), usual);
}

std::vector<Headline> lenient_headlines(const LenientConditions& conditions) {
  constexpr std::size_t kMostNamed = 8;
  if (!conditions.trouble.empty())
    return {
        {"waived", fmt::format("what this campaign waives is not known: {}", printable(conditions.trouble, 300)), {}}};
  if (conditions.list.empty()) return {};
  std::vector<std::string> words;
  for (const LenientCondition& condition : conditions.list) {
    if (words.size() < kMostNamed) words.push_back(lenient_text(condition));
  }
  std::string text = "what is easier here than usual: " + joined(words, "; ");
  if (conditions.list.size() > kMostNamed)
    text += fmt::format("; and {} more, under Conditions", conditions.list.size() - kMostNamed);
  return {{"waived", text + ".", {}}};
}

Json waived_json(const LenientConditions& waived) {
  auto list = Json::array();
  for (const auto& [field, value, usual] : waived.list)
    list.push_back({{"field", field}, {"value", value}, {"usual", usual.empty() ? Json(nullptr) : Json(usual)}});
  return list;
}

}  // namespace fleetproof
