#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/findings/finding.hpp"
#include "campaign/findings/findings_file.hpp"
#include "campaign/findings/retest.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::uint64_t kMostNeighbours = 1'000'000;

struct RetestWords {
  std::string file, agent, config;
  std::vector<std::string> plugins, computers, ids;
  std::optional<std::uint64_t> jobs, neighbours;
  bool bisect = false, json = false, global_symbols = false;
};

struct Retested {
  const KnownIssue& finding;
  Retest result;
};

std::vector<const KnownIssue*> chosen(const FindingsFile& file, const std::vector<std::string>& ids) {
  std::vector<const KnownIssue*> findings;
  for (const std::string& id : ids) {
    findings.push_back(file.find(id));
    if (findings.back() == nullptr) throw InputError("--finding", fmt::format("{} is not in the file", id));
  }
  if (!ids.empty()) return findings;
  for (const KnownIssue& finding : file.findings()) findings.push_back(&finding);
  if (findings.empty()) throw InputError("FINDINGS", "there is no finding in this file");
  return findings;
}

bool is_bad(const Retested& retested) {
  return retested.result.verdict != RetestVerdict::Fixed && retested.result.verdict != RetestVerdict::NotKnown;
}

double share_of(const NeighbourCounts& counts) {
  return counts.of == 0 ? 0.0 : static_cast<double>(counts.alike) / static_cast<double>(counts.of);
}

// What the verdict rests on, in a sentence.
std::string reason(const Retest& result, const NeighbourCounts& before) {
  const std::size_t alike = result.now.alike, of = result.now.of;
  switch (result.verdict) {
    case RetestVerdict::Fixed:
      return fmt::format("neither the case nor any of {} neighbours fails so (below {:.2f} %, 95 % sure)", of,
                         100.0 * result.upper_bound);
    case RetestVerdict::Dodged:
      return fmt::format("the case passes, but {} of {} neighbours fail so", alike, of);
    case RetestVerdict::StillThere:
      if (!result.case_fails && alike == 0)
        return fmt::format("neither the case nor any of {} neighbours fails so, but {} of {} runs of its campaign", of,
                           result.whole_runs.alike, result.whole_runs.of);
      return result.case_fails ? fmt::format("the case fails, and {} of {} neighbours", alike, of)
                               : fmt::format("the case passes, but {} of {} neighbours still fail so", alike, of);
    case RetestVerdict::NewKind:
      return "it fails, but not as it did: " + result.new_kind;
    case RetestVerdict::NotKnown:
      if (!result.standing.empty())
        return fmt::format("neither the case nor any of {} neighbours fails so, but the fleets hardly drive", of);
      return fmt::format("neither the case nor any of {} neighbours fails so, but of so many, only {:.1f} would before",
                         of, share_of(before) * static_cast<double>(of));
  }
  invariant_violated("a retest has a verdict");
}

void put_line(const Retested& retested) {
  const auto& [finding, result] = retested;
  put("{}  {}\n  {}\n  {}\n", finding.id, name_of(result.verdict), without_refuted(finding.mechanism, finding.refuted),
      reason(result, finding.neighbours));
  // Beside each verdict: software may fail otherwise and no longer as it did.
  put("  {} of {} neighbours end as the case did{}; in {}, where it was found, {} of {}\n", result.now.alike,
      result.now.of,
      result.now.alike == 0 ? fmt::format(" (below {:.2f} %, 95 % sure)", 100.0 * result.upper_bound) : "",
      finding.found_in, finding.neighbours.alike, finding.neighbours.of);
  if (result.looked_at > 0)
    put("  {} of them were looked at: {} fail as it did, {} do not, of {} that is not known\n", result.looked_at,
        result.known_kept, result.known_other, result.looked_at - result.known_kept - result.known_other);
  for (const auto& [end, count] : result.now.otherwise) {
    const auto then = finding.neighbours.otherwise.find(end);
    put("  {} of {} end otherwise, with {}; {} of {} there\n", count, result.now.of, end,
        then == finding.neighbours.otherwise.end() ? 0 : then->second, finding.neighbours.of);
  }
  if (result.whole_runs.of > 0)
    put("  of runs of its campaign with other draws, {} of {} end so, {} of {} before\n", result.whole_runs.alike,
        result.whole_runs.of, finding.whole.counts.alike, finding.whole.counts.of);
  if (!result.standing.empty()) put("  the fleets drive {}\n", result.standing);
}

Json shares_of_worlds(const NeighbourCounts& now, const NeighbourCounts& before) {
  return {{"neighbours", now.of_world},
          {"failing", now.alike_of_world},
          {"failing_before", before.alike_of_world},
          {"neighbours_before", before.of_world}};
}
Json shares_of_runs(const NeighbourCounts& now, const NeighbourCounts& before) {
  return {{"runs", now.of}, {"failing", now.alike}, {"failing_before", before.alike}, {"runs_before", before.of}};
}

void put_json(const std::vector<Retested>& all) {
  Json json = {{"schema_version", 1}};
  json["findings"] = Json::array();
  for (const auto& [finding, result] : all)
    json["findings"].push_back({{"id", finding.id},
                                {"verdict", name_of(result.verdict)},
                                {"case_fails", result.case_fails},
                                {"neighbours", result.now.of},
                                {"failing", result.now.alike},
                                {"upper_bound", result.upper_bound},
                                {"looked_at", result.looked_at},
                                {"known_as_before", result.known_kept},
                                {"known_otherwise", result.known_other},
                                {"otherwise", result.now.otherwise},
                                {"new_kind", result.new_kind},
                                {"hardly_drives", result.standing},
                                {"failing_before", finding.neighbours.alike},
                                {"neighbours_before", finding.neighbours.of},
                                {"of_worlds", shares_of_worlds(result.now, finding.neighbours)},
                                {"of_runs", shares_of_runs(result.whole_runs, finding.whole.counts)}});
  put_text(shown_json(json));
}

// One for all findings with one configuration of the agent that are judged alike. Made before any thread.
class RetestHosts {
 public:
  RetestHosts(const AgentPrograms& programs, int workers) : programs_(programs), workers_(workers) {}
  CaseHost& of(const CaseAgent& agent) {
    for (const auto& [known, host] : hosts_) {
      if (known == agent) return *host;
    }
    return *hosts_.emplace_back(agent, std::make_unique<CaseHost>(agent, programs_, workers_)).second;
  }

  std::uint64_t simulated() const {
    std::uint64_t sum = 0;
    for (const auto& [agent, host] : hosts_) sum += host->simulated();
    return sum;
  }

 private:
  const AgentPrograms& programs_;
  int workers_;
  std::vector<std::pair<CaseAgent, std::unique_ptr<CaseHost>>> hosts_;
};

int retest_findings(const RetestWords& words) {
  if (words.agent.empty()) throw InputError("--agent", "name the control software to test");
  if (words.neighbours && (*words.neighbours < 1 || *words.neighbours > kMostNeighbours))
    throw InputError("--neighbours", fmt::format("is {}; it is from 1 to {}", *words.neighbours, kMostNeighbours));
  AgentPrograms programs;
  std::vector<std::string> plugins = words.plugins;
  const std::string agent = meet_agent(words.agent, plugins, programs, &AgentPrograms::know, words.global_symbols);
  (void)programs.program(agent, "--agent");
  refuse_idle_symbols(words.global_symbols, AgentFactor(agent), programs);
  const FindingsFile file(words.file);
  std::vector<KeptFailure> failures;
  RetestHosts hosts(programs, worker_count(words.jobs));
  std::vector<CaseHost*> host_of;  // of each finding
  const auto findings = chosen(file, words.ids);
  for (const KnownIssue* finding : findings) {
    failures.push_back(file.failure(*finding));
    take_computer_programs(failures.back().smallest, words.computers, finding->id);
    const std::string config = words.config.empty() ? failures.back().smallest.agent_config : words.config;
    CaseAgent of_case{agent, config, finding->laws_left_out, finding->limits};
    of_case.computers =
        computer_parts(failures.back().smallest, plugins, programs, &AgentPrograms::know, words.global_symbols);
    programs.require_computers(factor_of(of_case), failures.back().smallest, finding->id + ": ");
    host_of.push_back(&hosts.of(of_case));
  }
  std::vector<Retested> all;
  // As many as when it was found: there, so many were needed for some of them to fail.
  const auto neighbours_of = [&](const KnownIssue& finding) {
    const auto usual = std::clamp<std::uint64_t>(finding.neighbours.of, kNeighbours, kMostNeighbours);
    return static_cast<std::uint32_t>(words.neighbours.value_or(usual));
  };
  listen_to_interrupts();
  const TimeLimit limit({}, is_interrupted);
  std::optional<WorkProgress> progress;
  progress.emplace("retest", [&] { return hosts.simulated(); });
  try {
    for (std::size_t i = 0; i < findings.size(); ++i) {
      progress->begin(fmt::format("{} ({} of {})", findings[i]->id, i + 1, findings.size()));
      CaseHost host = host_of[i]->looking_at(findings[i]->choice).within(limit);
      all.push_back({*findings[i], retest(host, failures[i], findings[i]->neighbours, neighbours_of(*findings[i]),
                                          file.known_runs(*findings[i]))});
      progress->hide();
      if (!words.json) put_line(all.back());
    }
  } catch (const GivenUp&) {  // a signal: what was found stands
  }
  progress.reset();
  if (words.json) put_json(all);
  if (all.size() < findings.size()) {
    talk("interrupted: {} of {} were retested\n", all.size(), count_text(findings.size(), "finding"));
    return exit_code_of_signal(interrupted());
  }
  if (std::ranges::any_of(all, is_bad)) return kViolated;
  const auto is_fixed = [](const Retested& one) { return one.result.verdict == RetestVerdict::Fixed; };
  if (std::ranges::all_of(all, is_fixed)) return kDemonstrated;
  return words.bisect ? kCannotTest : kNotDemonstrated;
}

// Software that cannot be built or loaded is neither good nor bad.
int retest_or_skip(const RetestWords& words) {
  if (!words.bisect) return retest_findings(words);
  try {
    return retest_findings(words);
  } catch (const std::exception& error) {
    talk("cannot test: {}\n", error.what());
    return kCannotTest;
  }
}

}  // namespace

Action prepare_retest(Options& options) {
  auto words = std::make_shared<RetestWords>();
  options.positional("FINDINGS", words->file, "findings file, with the scenario files that it names");
  options.option("--agent", words->agent,
                 "the control software to test: a name, or a shared object; of a central fleet, the program on board");
  options.option("--agent-config", words->config, "text handed to the agent (default: as when the finding was found)");
  options.option("--plugin", words->plugins, "shared object or \"lockstep:COMMAND\" of an agent; may be repeated");
  add_computer_option(options, words->computers);
  add_symbols_option(options, words->global_symbols);
  options.option("--finding", words->ids, "only this finding, as F-1c2d3e4f; may be repeated");
  options.option(
      "--neighbours", words->neighbours,
      "scenarios beside each case, and whole runs if need be, of these 1000 at most (default: as when it was "
      "found, at least 1000)");
  options.flag("--bisect", words->bisect, "exit as git bisect run wants it: 0 fixed, 1 not, 125 cannot be tested");
  options.option("-j,--jobs", words->jobs, "worker threads (default: one per core)");
  options.flag("--json", words->json, "print JSON");
  return [words] { return retest_or_skip(*words); };
}

}  // namespace fleetproof::cli
