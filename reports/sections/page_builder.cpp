#include "reports/sections/page_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/contract.hpp"
#include "reports/attempts/attempt_section.hpp"
#include "reports/comparison/baseline.hpp"
#include "reports/findings/mechanism_record.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/audit_section.hpp"
#include "reports/sections/breakdown_tables.hpp"
#include "reports/sections/condition_table.hpp"
#include "reports/sections/coverage_section.hpp"
#include "reports/sections/failure_section.hpp"
#include "reports/sections/gate_section.hpp"
#include "reports/sections/plan_conditions.hpp"
#include "reports/sections/sample_sentence.hpp"
#include "reports/sections/verdict_sentences.hpp"
#include "reports/sections/weak_points.hpp"
#include "reports/sensitivity/sensitivity_section.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostGroups = 50;

Section weak_point_section(const ReportInput& input) {
  Section section{"Weak points of this evidence", {}, {}};
  for (auto& point : weak_points(input)) section.remarks.push_back({std::move(point), ""});
  if (section.remarks.empty()) section.remarks.push_back({"None found by the checks of this page.", ""});
  return section;
}

Section provenance_section(const ReportInput& input) {
  const auto& campaign = input.campaign;
  const auto& engine = campaign.engine;
  Section section{"Provenance", {}, {}};
  const auto add = [&](const std::string& name, const std::string& value) {
    section.remarks.push_back({name + ": " + printable(value, 400), ""});
  };
  add("archive", input.archive_path);
  add("campaign", fmt::format("{}, kind {}, seed {}, {}, {}", campaign.name, campaign.kind, campaign.seed,
                              count_text(input.evidence.cells().size(), "cell"),
                              count_text(campaign.replicates, "planned replicate")));
  add("plan digest", hex_text(campaign.plan_hash));
  add("fleetproof", engine.version);
  add("program sha256", engine.program_sha256);
  add("compiler", engine.compiler);
  add("flags", engine.flags);
  add("libraries", engine.libraries);
  return section;
}

Section plan_section(const ReportInput& input) {
  Section section{"Conditions", {}, {}};
  for (const auto& [name, value] : campaign_conditions(input))
    section.remarks.emplace_back().text = fmt::format("{}: {}", name, value);
  return section;
}

void add_methods(Section& section, const std::vector<GateRecord>& gates) {
  const auto any = [&](GateMethod method) {
    return std::ranges::find(gates, method, &GateRecord::method) != gates.end();
  };
  if (gates.empty() || any(GateMethod::AnyTime)) {
    section.remarks.emplace_back().text =
        "Bounds of the method any-time hold at every number of replicates at once: one may look, stop, go on and "
        "extend for any reason. The upper bound is the largest limit that the release gate (an e-value, Ville 1939) "
        "would not pass; the lower bound is the largest limit that an e-value of the same kind refutes. Of AGV-hours, "
        "both bounds are those of the Gamma-Poisson sequence.";
  }
  if (any(GateMethod::Fixed)) {
    section.remarks.emplace_back().text =
        ("Bounds of the method fixed are exact (Clopper-Pearson, Garwood) for the number of "
         "replicates that was planned before the first run, and for no other.");
  }
}

Section method_section(const ReportInput& input) {
  Section section{"How to read this", {}, {}};
  const auto add = [&](std::string text) { section.remarks.push_back({std::move(text), ""}); };
  if (input.evidence.counts_only()) {
    add("A search looks for failures where it expects them. Its counts are not a sample of normal operation, so there "
        "are no rates and no bounds.");
  } else {
    add("A replicate is one world: one draw of all randomness, run in every cell (test condition). If several cells "
        "are judged together, the world is the unit and fails if any of its runs fails. Runs with an unknown outcome "
        "count as "
        "failing in every rate and bound. Stuck runs stay in the count of runs. An upper bound "
        "is rounded up, a lower bound is rounded down.");
    add(std::string(kUnknownMeans));
    add_methods(section, input.evidence.gates());
    add("\"Demonstrated\" means: if the true rate were above the limit, a result this good would be rarer than one "
        "minus the confidence. It is a statement about the sampled scenarios in the simulator. It says nothing about "
        "other conditions, or about real vehicles beyond what the simulator has been validated for.");
  }
  const auto& sampling = input.campaign.sampling;
  if (sampling == "uniform") {
    add("If a factor was drawn, every replicate has its own point, drawn uniformly and independently. The bounds hold "
        "for the mean rate over the region. They say nothing about its worst point.");
  } else if (!sampling.empty()) {
    add("Points of a Latin hypercube or a Sobol sequence cover a region more evenly than independent points. In the "
        "long run, a mean over them varies no more. They are not independent, so exact binomial bounds need not hold, "
        "and none is given.");
  }
  add(fmt::format(
      "A violation is a clearance below the minimal safety distance (0.10 m unless the scenario says otherwise). "
      "Clearances are rounded down to 1 cm; \"> 0.5 m\" means that no measured clearance was below 0.5 m, and \"-\" "
      "that none was measured: the simulator met an error, or it is not known what happened after a crash. The "
      "contract region is loss <= {} and delay <= {:g} s. Outside it, standing still is legal, and a violation remains "
      "a "
      "violation.",
      percent(kContractLoss), kContractDelay_s));
  return section;
}

// The title says whether the campaign is complete, so that no reader can miss it.
std::string replicates_text(const Evidence& evidence) {
  const auto complete = evidence.complete_replicates();
  if (!evidence.complete())
    return fmt::format("INCOMPLETE: {} of {}", complete,
                       count_text(evidence.planned_replicates(), "planned replicate"));
  return count_text(complete, "replicate") + " complete";
}

}  // namespace

Page build_page(const ReportInput& input, std::size_t most_rows) {
  Page page;
  const auto& evidence = input.evidence;
  page.title =
      fmt::format("fleetproof report: {} ({}), {} of {} cells each, {} judged", printable(input.campaign.name, 80),
                  printable(input.campaign.kind, 20), replicates_text(evidence), evidence.cells().size(),
                  count_text(evidence.complete_replicates() * evidence.cells().size(), "run"));
  page.headlines = reservations(input);
  for (auto& waived : lenient_headlines(input.waived)) page.headlines.push_back(std::move(waived));
  for (auto& warning : warnings(input)) page.headlines.push_back(std::move(warning));
  for (auto& audit : audit_headlines(input)) page.headlines.push_back(std::move(audit));
  for (auto& weak : weak_headlines(input)) page.headlines.push_back(std::move(weak));
  for (auto& verdict : verdicts(input)) page.headlines.push_back(std::move(verdict));
  for (auto& note : foreign_body_notes(input)) page.headlines.push_back(std::move(note));
  const auto add = [&](SectionTopic topic, Section section) {
    section.topic = topic;
    page.sections.push_back(std::move(section));
  };
  const auto add_conditions = [&](const std::string& title, bool (*wanted)(const Condition&)) {
    add(SectionTopic::Conditions, condition_section(input, title, wanted, most_rows));
  };
  add(SectionTopic::Gates, gate_section(input));
  add(SectionTopic::Plan, plan_section(input));
  add(SectionTopic::Groups, layout_section(input, most_rows));
  add(SectionTopic::Groups, fleet_section(input, most_rows));
  const std::string loss = percent(kContractLoss), delay = fmt::format("{:g} s", kContractDelay_s);
  add(SectionTopic::Conditions, table_legend(input));
  add_conditions(fmt::format("Worst case of the contract: {} loss, {} delay", loss, delay),
                 [](const Condition& c) { return c.is_worst_case; });
  add_conditions(fmt::format("Contract region: loss <= {}, delay <= {}", loss, delay),
                 [](const Condition& c) { return c.in_contract; });
  add_conditions("Outside the contract", [](const Condition& c) { return !c.in_contract; });
  if (!input.baseline.empty()) add(SectionTopic::Comparison, comparison_section(input.baseline, input.archive_path));
  add(SectionTopic::Coverage, coverage_section(input, most_rows));
  add(SectionTopic::Coverage, incident_section(input, most_rows));
  add(SectionTopic::Sensitivity,
      sensitivity_section(input.sensitivity, input.archive_path, input.campaign.engine.program_sha256));
  add(SectionTopic::Audit, audit_section(input));
  add(SectionTopic::WeakPoints, weak_point_section(input));
  add(SectionTopic::Failures, failure_section(input, std::min(most_rows, kMostGroups)));
  add(SectionTopic::Failures, findings_section(input.findings, input.archive_path));
  add(SectionTopic::Attempts, attempt_section(input.attempts, input.campaign, input.evidence));
  add(SectionTopic::Provenance, provenance_section(input));
  add(SectionTopic::Method, method_section(input));
  return page;
}

}  // namespace fleetproof
