#include "reports/findings/found_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {

std::string findings_sentence(const FoundRecord& record) {
  const auto open = std::ranges::count_if(record.findings, &FoundFinding::needs_attention);
  return fmt::format("{}, {} of which need attention", count_text(record.findings.size(), "finding"), open);
}

Section findings_section(const FoundFile& file, const std::string& archive_path) {
  Section section{"Findings: failures by what they need", {}, {}};
  const auto& [record, trouble] = file;
  if (!record) {
    const std::string how = "fleetproof findings " + shell_word(archive_path);
    section.remarks.push_back({trouble.empty()
                                   ? "Not looked for. Failures can be grouped by what they need (" + how + ")."
                                   : "Not known: " + printable(trouble, 400),
                               ""});
    return section;
  }
  section.table = {{{"finding", false},
                    {"standing", false},
                    {"agent", false},
                    {"failures", true},
                    {"mechanism", false},
                    {"simplest run", true}},
                   {}};
  for (const FoundFinding& finding : record->findings)
    section.table.rows.push_back({printable(finding.id, 20), printable(finding.standing, 60),
                                  printable(finding.agent, 40), std::to_string(finding.runs.size()),
                                  printable(finding.mechanism, 300), std::to_string(finding.run)});
  section.remarks.push_back({fmt::format("{}. {} of {} failing runs were simulated again without what they may need.",
                                         findings_sentence(*record), record->looked_at, record->failing_runs),
                             ""});
  if (!record->not_again.empty())
    section.remarks.push_back({fmt::format("{} did not fail again.", count_text(record->not_again.size(), "run")), ""});
  return section;
}

}  // namespace fleetproof
