#include "reports/sensitivity/sensitivity_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

std::string runs_text(const PlantedFault& fault) {
  if (fault.by_rate) return "by rate";
  return fault.median_runs ? fmt::format("{:g}", *fault.median_runs) : "-";
}

std::string most_text(const PlantedFault& fault) { return fault.most_runs ? std::to_string(*fault.most_runs) : "-"; }

std::string or_dash(const std::string& text) { return text.empty() ? "-" : printable(text, 80); }

std::string measured_text(const SensitivityRecord& record) {
  const std::string sound =
      record.sound.size() == 1 ? printable(record.sound.front().agent, 40) : std::string("its sound agent");
  std::string text = fmt::format(
      "Measured with {}, in at most {} of each agent. A fault is detected if it ends in a violation, or is accused of "
      "something more often than {} is, over all runs or with one radio (95 % confidence){}.",
      count_text(record.seeds.size(), "seed"), count_text(record.runs, "run"), sound,
      record.seeds.size() == 1 ? "" : ", with at least nine of ten seeds");
  for (const auto& [agent, runs, violating_runs] : record.sound) {
    text += violating_runs == 0
                ? fmt::format(" {} had no violation in {}.", printable(agent, 40), count_text(runs, "run"))
                : fmt::format(" {} itself had violations in {} of {} runs, so that violations count as rates.",
                              printable(agent, 40), violating_runs, runs);
  }
  if (!std::ranges::all_of(record.faults, &PlantedFault::tried))
    text += fmt::format(
        " A fault was never tried if its agent did the same as {} in each run: nothing in these runs asked for the "
        "rule that it breaks.",
        sound);
  return text;
}

}  // namespace

std::string sensitivity_sentence(const SensitivityRecord& record) {
  std::vector<std::string> missed, untried;
  for (const PlantedFault& fault : record.faults) {
    if (!record.detects(fault)) (fault.tried ? missed : untried).push_back(printable(fault.agent, 80));
  }
  const std::uint64_t unmeasured = record.known_faults - std::min(record.known_faults, record.faults.size());
  return fmt::format("detects {} of {} within {}{}{}{}", record.detected(),
                     count_text(record.faults.size(), "planted fault"), count_text(record.runs, "run"),
                     missed.empty() ? "" : "; misses " + joined(missed),
                     untried.empty() ? "" : "; never tries " + joined(untried),
                     unmeasured == 0 ? "" : fmt::format("; {} more were not measured", unmeasured));
}

Table sensitivity_table(const SensitivityRecord& record) {
  Table table{{{"planted fault", false},
               {"what it does", false},
               {"seeds", true},
               {record.seeds.size() == 1 ? "first after runs" : "first after runs, median", true},
               {"most", true},
               {"accused of", false},
               {"first in", false},
               {"met there", false}},
              {}};
  for (const PlantedFault& fault : record.faults) {
    table.rows.push_back({printable(fault.agent, 80), printable(fault.text, 80),
                          fmt::format("{} of {}", fault.seeds, record.seeds.size()), runs_text(fault), most_text(fault),
                          fault.tried ? or_dash(fault.seen_as) : "never tried", or_dash(fault.cell),
                          or_dash(fault.probe)});
  }
  return table;
}

Section sensitivity_section(const SensitivityFile& file, const std::string& archive_path,
                            const std::string& program_sha256) {
  Section section{"Which planted faults these worlds detect", {}, {}};
  const auto& [record, trouble] = file;
  if (!record) {
    const auto name = std::filesystem::path(sensitivity_path(archive_path)).filename();
    section.remarks.push_back(
        {trouble.empty()
             ? fmt::format("Not measured. Agents with known faults can be tried in these worlds (fleetproof "
                           "sensitivity CAMPAIGN); a report looks for {} beside its results file.",
                           printable(name.string(), 200))
             : "Not known: " + printable(trouble, 400),
         ""});
    return section;
  }
  section.table = sensitivity_table(*record);
  section.remarks.push_back({fmt::format("A campaign in these worlds {}.", sensitivity_sentence(*record)), ""});
  section.remarks.push_back({measured_text(*record), ""});
  if (record->program_sha256 != program_sha256) {
    section.remarks.push_back(
        {fmt::format("It was measured by another build: fleetproof {}.", printable(record->engine_version, 40)), ""});
  }
  return section;
}

}  // namespace fleetproof
