#include "reports/sections/coverage_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

std::string share_text(const Seen& seen, std::uint64_t runs) {
  return runs == 0 ? "-" : percent(static_cast<double>(seen.runs) / static_cast<double>(runs));
}

void add_rows(Section& section, const AgentCoverage& agent) {
  const auto add = [&](const std::string& name, const char* by, const Seen& seen) {
    section.table.rows.push_back({printable(agent.agent, 40), printable(name, 64), by, std::to_string(seen.runs),
                                  share_text(seen, agent.coverage.runs()), std::to_string(seen.times)});
  };
  for (const auto& [name, seen] : agent.coverage.by_the_world()) add(name, name_of(ProbeSource::World), seen);
  for (const auto& [name, seen] : agent.coverage.by_agents()) add(name, name_of(ProbeSource::Agent), seen);
  for (const auto& missing : agent.missing) {
    if (missing.runs_with == 0) add(missing.name, "nobody", {});
  }
}

void cut(Section& section, std::size_t most_rows) {
  auto& rows = section.table.rows;
  if (rows.size() <= most_rows) return;
  section.remarks.push_back({fmt::format("{} more rows are left out.", rows.size() - most_rows), ""});
  rows.resize(most_rows);
}

std::string question_mark_text(const ReportInput& input) {
  const bool has_central = std::ranges::any_of(
      input.evidence.cells(), [&](const CellRecord& cell) { return !input.evidence.computers_of(cell.agent).empty(); });
  return fmt::format(" (\"?\": only if the agent declares probes{})",
                     has_central ? ", and negotiation only on board, not of central fleets" : "");
}

}  // namespace

std::string missing_text(const std::vector<MissingProbe>& missing) {
  std::vector<std::string> never, rare;
  for (const auto& probe : missing) {
    auto name = printable(probe.name, 64);
    if (probe.is_encounter) name += " (of two AGVs that both drive)";
    if (probe.runs_with == 0) {
      never.push_back(name);
    } else {
      rare.push_back(fmt::format("{} ({} of {} runs)", name, probe.runs_with, probe.runs));
    }
  }
  std::vector<std::string> parts;
  if (!never.empty()) parts.push_back("never met: " + joined(never));
  if (!rare.empty()) parts.push_back("too rare: " + joined(rare));
  return joined(parts, "; ");
}

std::vector<Headline> weak_headlines(const ReportInput& input) {
  std::vector<Headline> list;
  for (const auto& agent : input.evidence.agent_coverage()) {
    if (agent.missing.empty() || !is_under_test(input.evidence.plan(), agent.agent)) continue;
    list.push_back(
        {"weak",
         fmt::format(
             "this campaign is weak evidence for agent {}: its {} did not meet what a test has to meet ({}; see "
             "[coverage] probes of the campaign file). "
             "Few failures say little then.",
             printable(agent.agent, 40), count_text(agent.coverage.runs(), "run"), missing_text(agent.missing)),
         {}});
  }
  return list;
}

bool is_weak(const ReportInput& input) {
  const auto& gates = input.evidence.gates();
  for (std::size_t i = 0; i < input.gates.size(); ++i) {
    if (!is_under_test(input.evidence.plan(), gates[i].agent)) continue;
    if (!input.gates[i].missing.empty() || !input.gates[i].counts.doubt.empty()) return true;
  }
  if (!unjudged_agents(input.evidence).empty()) return true;
  return !weak_headlines(input).empty();
}

Section coverage_section(const ReportInput& input, std::size_t most_rows) {
  Section section{"What the runs met",
                  {{{"agent", false},
                    {"what", false},
                    {"reported by", false},
                    {"runs with it", true},
                    {"share", true},
                    {"times", true}},
                   {}},
                  {}};
  for (const auto& agent : input.evidence.agent_coverage()) add_rows(section, agent);
  cut(section, most_rows);
  const auto& required = input.campaign.required_probes;
  section.remarks.push_back({required.empty()
                                 ? std::string("This campaign requires nothing to be met ([coverage] probes).")
                                 : fmt::format("Required: at least one in {} runs has to meet {}{}.", kRunsPerProbe,
                                               printable(joined(required), 400),
                                               required.back().ends_with('?') ? question_mark_text(input) : ""),
                             ""});
  return section;
}

Section incident_section(const ReportInput& input, std::size_t most_rows) {
  Section section{
      "What the other laws found",
      {{{"agent", false}, {"incident", false}, {"runs with it", true}, {"incidents", true}, {"what it means", false}},
       {}},
      {}};
  for (const auto& agent : input.evidence.agent_coverage()) {
    for (const auto& [kind, tally] : agent.incidents) {
      const auto& info = info_of(kind);
      section.table.rows.push_back({printable(agent.agent, 40), std::string(info.name), std::to_string(tally.runs),
                                    std::to_string(tally.incidents), std::string(info.meaning)});
      section.remarks.push_back({fmt::format("{} of agent {}, for instance in run {}:", info.name,
                                             printable(agent.agent, 40), tally.example_run),
                                 replay_line(input, tally.example_run)});
    }
  }
  if (section.table.rows.empty()) {
    section.table.columns.clear();
    section.remarks.push_back({"Nothing, or none of them ran.", ""});
  } else {
    Remark scope;
    scope.text =
        "All that was filed is counted here. Gates, tables by layout and failure groups leave out a deadlock, "
        "livelock, starvation or standstill that a contact or a foreign body explains.";
    section.remarks.insert(section.remarks.begin(), std::move(scope));
  }
  cut(section, most_rows);
  return section;
}

}  // namespace fleetproof
