#include "campaign/cli/evidence_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>
#include <vector>

#include "campaign/batch/session_log.hpp"
#include "campaign/cli/campaign_end.hpp"
#include "campaign/cli/repeat_page.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/plan/plan_text.hpp"
#include "campaign/run/program_door.hpp"
#include "campaign/run/replay.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/regular_file.hpp"
#include "core/bridges/wrapped/fault_words.hpp"
#include "generators/formats/layout_file.hpp"
#include "reports/formats/csv_tables.hpp"
#include "reports/formats/report_formats.hpp"
#include "reports/formats/report_schema.hpp"
#include "reports/formats/validity.hpp"
#include "reports/page/wording.hpp"
#include "storage/line_log.hpp"

namespace fleetproof::cli {
namespace {

namespace fs = std::filesystem;

// A folder beside the wanted one, which takes its place at the end. Gone if anything fails before.
class EvidenceFolder {
 public:
  explicit EvidenceFolder(const std::string& folder) : wanted_(fs::path(folder).lexically_normal()) {
    if (!wanted_.has_filename()) wanted_ = wanted_.parent_path();
    partial_ = wanted_;
    partial_ += ".partial";
    for (const fs::path& path : {wanted_, partial_}) {
      if (is_name_taken(path.string()))
        throw InputError("--evidence",
                         fmt::format("{} is there already; name another folder, or move it away", path.string()));
    }
    std::error_code error;
    if (!fs::create_directory(partial_, error))
      throw InputError("--evidence", fmt::format("{} cannot be made ({})", folder, error.message()));
  }
  EvidenceFolder(const EvidenceFolder&) = delete;
  EvidenceFolder& operator=(const EvidenceFolder&) = delete;
  ~EvidenceFolder() {
    std::error_code ignored;
    if (!published_) fs::remove_all(partial_, ignored);
  }

  std::ofstream open(const std::string& name) {
    std::ofstream file(path_of(name), std::ios::binary);
    if (!file) fail(name);
    return file;
  }
  void close(std::ofstream& file, const std::string& name) {
    file.close();
    if (!file) fail(name);
    sums_[name] = sha256_of_file(path_of(name));
  }
  void write(const std::string& name, std::string_view text) {
    std::ofstream file = open(name);
    file << text;
    close(file, name);
  }
  // Under this name, block by block: a results file may be large.
  void copy(const std::string& from, const std::string& name) {
    constexpr std::size_t kBlock = 1U << 20;
    RegularFile source(from);
    std::ofstream file = open(name);
    for (std::string block; block = source.read(kBlock), !block.empty();)
      file.write(block.data(), static_cast<std::streamsize>(block.size()));
    close(file, name);
    constexpr fs::perms kMayRun = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    std::error_code ignored;  // of a file that has just been written
    fs::permissions(path_of(name), fs::status(from, ignored).permissions() & kMayRun, fs::perm_options::add, ignored);
  }
  void publish() {
    std::string sums;
    for (const auto& [name, sum] : sums_) sums += sum + "  " + name + "\n";
    write("SHA256SUMS", sums);
    std::error_code error;
    fs::rename(partial_, wanted_, error);
    if (error) throw MachineError(fmt::format("{}: cannot be written ({})", wanted_.string(), error.message()));
    published_ = true;
  }

 private:
  std::string path_of(const std::string& name) const { return (partial_ / name).string(); }
  [[noreturn]] void fail(const std::string& name) const {
    throw MachineError(fmt::format("{}: cannot be written ({})", (wanted_ / name).string(), std::strerror(errno)));
  }

  fs::path wanted_, partial_;
  std::map<std::string, std::string> sums_;
  bool published_ = false;
};

std::string identity_text(const ReportInput& input) {
  const CampaignRecord& campaign = input.campaign;
  const auto& own = input.attempts.own;
  const Json json{{"campaign", campaign.name},
                  {"campaign_file_sha256", sha256_of_file(input.archive_path)},
                  {"plan_hash", hex_text(campaign.plan_hash)},
                  {"plan_fixed_utc", own ? own->begun_utc : ""},
                  {"release", own ? own->release : ""},
                  {"seed", campaign.seed},
                  {"seed_follows_from_release_and_plan", own && own->fresh_seed},
                  {"overrides", input.attempts.overrides},
                  {"agents_of_shared_objects", campaign.plugin_agents},
                  {"engine",
                   {{"version", campaign.engine.version},
                    {"source_commit", campaign.engine.source_commit},
                    {"program_sha256", campaign.engine.program_sha256},
                    {"compiler", campaign.engine.compiler},
                    {"flags", campaign.engine.flags},
                    {"libraries", campaign.engine.libraries}}}};
  return shown_json(json);
}

// The file beside the results file as it is; empty if there is none.
std::string copied(const std::string& path) { return read_text_file_if_there(path).value_or(""); }

// The failing runs in the order in which a reader looks at them: control software under test before reference agents,
// the most serious end points first, then by run index. 16 bytes a run.
class RunsToReplay {
 public:
  RunsToReplay(const CampaignPlan& plan, const RepeatWords& words) : plan_(plan), words_(words) {}
  void add(const RunRecord& run, bool under_test) {
    const auto failing = FailingRun::of(run);
    if (run.outcome.is_failure() && failing)
      runs_.push_back({!under_test, -std::int64_t{failing->seriousness()}, run.run_index});
  }
  std::string text(const ReportInput& input) {
    std::ranges::sort(runs_);
    const std::string archive = words_.archive.empty() ? input.archive_path : words_.archive;
    std::string lines = words_.archive.empty() ? "# The results file is not in this folder: see REPEAT.md.\n"
                                               : "# Call these in this folder.\n";
    for (const auto& [is_reference, most_serious_first, run_index] : runs_) {
      const AgentFactor& agent = plan_.agent_of_cell(run_index);
      lines += replay_command(archive, run_index) + plugin_of(agent) + "\n";
    }
    return lines;
  }

 private:
  std::string plugin_of(const AgentFactor& agent) const {
    std::string words;
    for (const KeptProgram& kept : words_.programs) {
      const auto is_it = [&](const ProgramPart* part) { return kept.program == wrapped::bare_name(part->program); };
      if (std::ranges::any_of(agent.parts(), is_it)) words += plugin_words(kept);
    }
    return words;
  }

  const CampaignPlan& plan_;
  const RepeatWords& words_;
  std::vector<std::tuple<bool, std::int64_t, std::uint64_t>> runs_;
};

void write_runs(EvidenceFolder& folder, const ArchiveReader& archive, const ReportInput& input,
                const CampaignPlan& plan, const RepeatWords& words) {
  const auto& tables = csv_tables();
  std::vector<std::ofstream> files;
  for (const CsvTable& table : tables) write_heading(files.emplace_back(folder.open(table.file)), table);
  RunsToReplay replays(plan, words);
  archive.for_each_run([&](const RunRecord& run) {
    const CellRecord& cell = archive.cells()[run.cell];
    for (std::size_t i = 0; i < tables.size() && !run.folded; ++i) write_rows(files[i], tables[i], run, cell);
    replays.add(run, is_under_test(archive.plan(), cell.agent));
  });
  for (std::size_t i = 0; i < tables.size(); ++i) folder.close(files[i], tables[i].file);
  folder.write("replay.txt", replays.text(input));
  folder.write("columns.csv", csv_dictionary());
}

// With all files that it names, if they are still what made the results.
KeptProgram keep_program(EvidenceFolder& folder, const ReportInput& input, const std::string& program,
                         std::size_t number) {
  const auto lost = [&](const std::string& trouble) {
    return KeptProgram{program, {}, {{"the program of agent " + program, {}, trouble}}, false};
  };
  const std::string word = remembered_plugin(input.archive_path, program);
  if (word.empty()) return lost("no session log beside the results file says where it is");
  try {
    const ProgramSource source = source_of(word, false);
    if (stored_plugins(input.campaign.engine, program) != std::vector{identity_of(source)})
      return lost(printable(source.file) + " is not what made the results");
    const bool is_command = source.kind == ProgramKind::Lockstep;
    KeptProgram kept{program, {}, {}, is_command};
    std::vector<std::string> names;
    for (const std::string& file : files_of(source)) {
      const std::string name = is_command ? fmt::format("program-{}-{}-{}", number, names.size() + 1,
                                                        printable(fs::path(file).filename().string()))
                                          : fmt::format("plugin-{}.so", number);
      folder.copy(file, name);
      kept.files.push_back(
          {(is_command ? "a file of the command of agent " : "the plug-in of agent ") + program, name, {}});
      names.push_back(is_command ? "./" + name : name);
    }
    kept.word = word_with(source, names);
    return kept;
  } catch (const InputError& error) {
    return lost(error.what());
  }
}

std::vector<KeptProgram> keep_programs(EvidenceFolder& folder, const ReportInput& input, const CampaignPlan& plan) {
  std::set<std::string> programs;
  for (const AgentFactor& agent : plan.agents) {
    if (std::ranges::find(input.campaign.plugin_agents, agent.name) == input.campaign.plugin_agents.end()) continue;
    for (const ProgramPart* part : agent.parts()) {
      const std::string name = wrapped::bare_name(part->program);
      if (!stored_plugins(input.campaign.engine, name).empty()) programs.insert(name);
    }
  }
  std::vector<KeptProgram> kept;
  for (const std::string& program : programs) kept.push_back(keep_program(folder, input, program, kept.size() + 1));
  return kept;
}

std::vector<KeptFile> keep_layouts(EvidenceFolder& folder, const CampaignPlan& plan) {
  std::vector<KeptFile> kept;
  for (const LayoutFactor& layout : plan.layouts) {
    if (layout.map == nullptr) continue;
    const std::string name = fmt::format("layout-{}.json", kept.size() + 1);
    folder.write(name, to_text(layout.map->layout()));
    kept.push_back({"layout " + layout.name, name, {}});
  }
  return kept;
}

// The campaign file as its user wrote it, if it is still the one that was run.
std::vector<KeptFile> keep_campaign_file(EvidenceFolder& folder, const ReportInput& input) {
  const RememberedFile file = remembered_campaign_file(input.archive_path);
  KeptFile kept{"the campaign file as it was written", {}, {}};
  try {
    if (file.path.empty()) {
      kept.trouble = "no session log beside the results file names it";
    } else if (const std::string text = read_text_file(file.path); sha256_hex(text) != file.sha256) {
      kept.trouble = printable(file.path) + " was changed since";
    } else {
      kept.name = "campaign.toml";
      folder.write(kept.name, text);
    }
  } catch (const InputError& error) {
    kept.trouble = error.what();
  }
  return {kept};
}

// A published results file; one that still grows is not copied.
std::string keep_results(EvidenceFolder& folder, const std::string& archive) {
  if (archive.ends_with(".partial")) return {};
  const std::string name = fs::path(archive).filename().string();
  folder.copy(archive, name);
  return name;
}

}  // namespace

void write_evidence_set(const std::string& path, const ArchiveReader& archive, const HtmlInput& input) {
  const std::vector<ValidityCheck> checks = validity_checks(input.report);
  require_known_answers(checks);
  EvidenceFolder folder(path);
  const ReportInput& report = input.report;
  folder.write("report.html", render_html(input));
  for (const auto& [name, format] : {std::pair{"report.txt", "text"}, {"report.json", "json"}, {"report.xml", "junit"}})
    folder.write(name, find_entry(report_formats(), format)->make(report));
  folder.write("report.schema.json", report_schema());
  folder.write("plan.json", report.campaign.plan_json);
  folder.write("identity.json", identity_text(report));
  const CampaignPlan plan = parse_plan(report.campaign.plan_json);
  RepeatWords words;
  words.archive = keep_results(folder, report.archive_path);
  words.results_digest = hex_text(archive.results_digest());
  words.verdict = name_of(overall_verdict(report.evidence, report.gates));
  words.exit_code = exit_code_of(report, false);
  words.programs = keep_programs(folder, report, plan);
  words.layouts = keep_layouts(folder, plan);
  words.campaign = keep_campaign_file(folder, report);
  folder.write("REPEAT.md", repeat_page(report, words));
  write_runs(folder, archive, report, plan, words);
  folder.write("validity.txt", validity_text(report, checks));
  folder.write("attempts.jsonl", copied(report.attempts.ledger));
  folder.write("sessions.jsonl", copied(session_log_path(report.archive_path)));
  if (report.sensitivity.record) folder.write("sensitivity.json", sensitivity_text(*report.sensitivity.record));
  folder.publish();
}

}  // namespace fleetproof::cli
