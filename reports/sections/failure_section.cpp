#include "reports/sections/failure_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/wording.hpp"
#include "reports/sections/verdict_sentences.hpp"

namespace fleetproof {

static_assert(kHazardousSpeed_um_s == 300'000, "kFailureColumns says it in words");

Remark worst_of(const ReportInput& input, const FailureGroup& group) {
  Remark remark = describe(input, group.worst);
  if (!group.worst.factors.in_contract()) remark.text += " (outside the contract)";
  return remark;
}

Table failure_table(const std::vector<FailureGroup>& groups) {
  Table table;
  for (const char* head : {"agent", "end point", "leading failure", "before it"})
    table.columns.push_back({head, false});
  for (const char* head : {"runs", "distinct", "worst run"}) table.columns.push_back({head});
  for (const FailureGroup& group : groups) {
    table.rows.push_back({printable(group.agent, 40), group.end_point, printable(group.first_cause, 80),
                          name_of(group.before), std::to_string(group.runs),
                          (group.at_least ? ">= " : "") + std::to_string(group.distinct),
                          std::to_string(group.worst.run_index)});
  }
  return table;
}

Section failure_section(const ReportInput& input, std::size_t most_groups) {
  Section section{kFailuresTitle, {}, {}};
  auto groups = input.failures.list(input.evidence.plan());
  if (groups.empty()) {
    section.remarks.emplace_back().text = "No run failed.";
    return section;
  }
  const std::size_t all = groups.size();
  groups.resize(std::min(all, most_groups));
  section.remarks.emplace_back().text = fmt::format("{} The worst run of each group:", kFailureColumns);
  section.table = failure_table(groups);
  for (const FailureGroup& group : groups) section.remarks.push_back(worst_of(input, group));
  if (all > most_groups)
    section.remarks.emplace_back().text = fmt::format("{} more groups are left out here.", all - most_groups);
  return section;
}

}  // namespace fleetproof
