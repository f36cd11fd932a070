#include "campaign/cli/evidence_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "campaign/cli/streams.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
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
      if (fs::exists(path))
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
                    {"program_sha256", campaign.engine.program_sha256},
                    {"compiler", campaign.engine.compiler},
                    {"flags", campaign.engine.flags},
                    {"libraries", campaign.engine.libraries}}}};
  return shown_json(json);
}

// The file beside the results file as it is; empty if there is none.
std::string copied(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The failing runs in the order in which a reader looks at them: control software under test before reference agents,
// the most serious end points first, then by run index. 16 bytes a run.
class RunsToReplay {
 public:
  void add(const RunRecord& run, bool under_test) {
    const auto failing = FailingRun::of(run);
    if (run.outcome.is_failure() && failing)
      runs_.push_back({!under_test, -std::int64_t{failing->seriousness()}, run.run_index});
  }
  std::string text(const ReportInput& input) {
    std::ranges::sort(runs_);
    std::string lines = fmt::format("# Call these where {} lies; it is no part of this folder.\n",
                                    printable(std::filesystem::path(input.archive_path).filename().string()));
    for (const auto& [is_reference, most_serious_first, run_index] : runs_)
      lines += replay_line(input, run_index) + "\n";
    return lines;
  }

 private:
  std::vector<std::tuple<bool, std::int64_t, std::uint64_t>> runs_;
};

void write_runs(EvidenceFolder& folder, const ArchiveReader& archive, const ReportInput& input) {
  const auto& tables = csv_tables();
  std::vector<std::ofstream> files;
  for (const CsvTable& table : tables) write_heading(files.emplace_back(folder.open(table.file)), table);
  RunsToReplay replays;
  archive.for_each_run([&](const RunRecord& run) {
    const CellRecord& cell = archive.cells()[run.cell];
    for (std::size_t i = 0; i < tables.size() && !run.folded; ++i) write_rows(files[i], tables[i], run, cell);
    replays.add(run, is_under_test(archive.plan(), cell.agent));
  });
  for (std::size_t i = 0; i < tables.size(); ++i) folder.close(files[i], tables[i].file);
  folder.write("replay.txt", replays.text(input));
  folder.write("columns.csv", csv_dictionary());
  folder.write("validity.txt", validity_text(input));
}

}  // namespace

void write_evidence_set(const std::string& path, const ArchiveReader& archive, const HtmlInput& input) {
  EvidenceFolder folder(path);
  const ReportInput& report = input.report;
  folder.write("report.html", render_html(input));
  for (const auto& [name, format] : {std::pair{"report.txt", "text"}, {"report.json", "json"}, {"report.xml", "junit"}})
    folder.write(name, find_entry(report_formats(), format)->make(report));
  folder.write("report.schema.json", report_schema());
  folder.write("plan.json", report.campaign.plan_json);
  folder.write("identity.json", identity_text(report));
  write_runs(folder, archive, report);
  folder.write("attempts.jsonl", copied(report.attempts.ledger));
  folder.write("sessions.jsonl", copied(session_log_path(report.archive_path)));
  if (report.sensitivity.record) folder.write("sensitivity.json", sensitivity_text(*report.sensitivity.record));
  folder.publish();
}

}  // namespace fleetproof::cli
