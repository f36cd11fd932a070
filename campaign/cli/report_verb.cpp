#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaign/cli/attempt_log.hpp"
#include "campaign/cli/campaign_end.hpp"
#include "campaign/cli/ci_summary.hpp"
#include "campaign/cli/evidence_set.hpp"
#include "campaign/cli/explain_run.hpp"
#include "campaign/cli/film_maker.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/cli/waived.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "reports/attempts/looks.hpp"
#include "reports/campaign_page/html_report.hpp"
#include "reports/sections/head_notes.hpp"

namespace fleetproof::cli {
namespace {

struct ReportWords {
  std::string archive, format = "text", out, html, baseline, ledger, evidence;
  std::optional<std::uint64_t> cases;
  bool json = false, digest = false, exit_zero = false, no_film = false;
};

// As sha256sum does: the digest first, then whose it is.
void print_digest(const ArchiveReader& archive, bool json) {
  const EngineIdentity& engine = archive.campaign().engine;
  const std::uint64_t digest = archive.results_digest();
  if (!json) {
    put("{:016x}  results, by fleetproof {} sha256 {} ({}, {}; {})\n", digest, engine.version, engine.program_sha256,
        engine.compiler, engine.flags, engine.libraries);
    return;
  }
  const Json object = {{"schema_version", 1},
                       {"results_digest", fmt::format("{:016x}", digest)},
                       {"runs", archive.run_count()},
                       {"engine",
                        {{"version", engine.version},
                         {"program_sha256", engine.program_sha256},
                         {"compiler", engine.compiler},
                         {"flags", engine.flags},
                         {"libraries", engine.libraries}}}};
  put_text(shown_json(object));
}

// The comparison with the baseline, if there is one to compare with.
void add_baseline(ReportInput& input, const ArchiveReader& archive, const ReportWords& words) {
  if (words.baseline.empty()) return;
  const ArchiveReader baseline(words.baseline);
  input.baseline = compare_with_baseline({archive, words.archive, head_beside_verdict(input)},
                                         {baseline, words.baseline, head_of_release(baseline, words.baseline)});
}

int told_to_ci(const ReportInput& input, const ReportWords& words) {
  tell_ci(input);
  return exit_code_of(input, words.exit_zero);
}

// A report on a campaign that still grows is a look at it.
void show_history(ReportInput& input, const ReportWords& words) {
  try {
    if (!input.evidence.complete()) note_look(words.archive, input.stored_runs);
  } catch (const std::runtime_error& error) {  // of the log
    talk("this look at the campaign is not counted: {}\n", error.what());
  }
  add_history(input, words.ledger);
}

constexpr std::uint64_t kMostCases = 100;
constexpr const char* kPageOfAll = "report.html";

std::string in_folder(const ReportWords& words, const std::string& name) {
  return (std::filesystem::path(words.html) / name).string();
}

void check_cases(const ReportWords& words) {
  if (!words.cases) return;
  if (words.html.empty()) throw InputError("--cases", "stand beside a page; name their folder with --html");
  if (*words.cases < 1 || *words.cases > kMostCases)
    throw InputError("--cases", fmt::format("is {}; it is 1 to {}", *words.cases, kMostCases));
  std::error_code error;  // a folder that is there is none
  std::filesystem::create_directory(words.html, error);
  if (!std::filesystem::is_directory(words.html))
    throw InputError("--html", fmt::format("{} is no folder{}; with --cases it names the folder of all pages",
                                           words.html, error ? " and cannot be made" : ""));
  require_writable({in_folder(words, kPageOfAll), "--html", OutputKind::Report});
}

// A run whose software is gone, for instance, gets no page, and the others do.
void write_cases(HtmlInput& input, const ReportWords& words) {
  const auto groups = input.report.failures.list(input.report.evidence.plan());
  for (const std::uint64_t run : runs_to_show(groups, *words.cases)) {
    try {
      explain_unless_kept(words.archive, run);
      write_case_page(words.archive, run, in_folder(words, case_page_name(run)));
      input.cases.insert(run);
    } catch (const InputError& error) {
      talk("run {} has no page: {}\n", run, error.what());
    } catch (const EngineError& error) {
      talk("run {} has no page: {}\n", run, error.what());
    }
  }
}

int html_report(const ArchiveReader& archive, const ReportWords& words) {
  check_cases(words);
  if (!words.out.empty() || words.json || words.format != "text")
    throw InputError(words.html.empty() ? "--evidence" : "--html",
                     "writes files of its own; leave out --output, --json and --format, or call report twice");
  auto progress = reading_progress("report", archive.run_count());
  HtmlInput input = read_html_input(archive, words.archive);
  progress.reset();
  add_exit_code(input.report);
  input.report.waived = lenient_conditions(input.report.campaign.plan_json);
  show_history(input.report, words);
  add_baseline(input.report, archive, words);
  if (!words.no_film) input.strips = film_strips(archive, words.archive, input.report.failures);
  if (!words.evidence.empty()) write_evidence_set(words.evidence, archive, input);
  if (words.cases) write_cases(input, words);
  const std::string page = words.cases ? in_folder(words, kPageOfAll) : words.html;
  if (!page.empty()) write_whole({page, "--html", OutputKind::Report}, render_html(input));
  return told_to_ci(input.report, words);
}

int report(const ReportWords& words) {
  const ArchiveReader archive(words.archive);
  if (words.digest) {
    print_digest(archive, words.json);
    return kDemonstrated;
  }
  if (!words.html.empty() || !words.evidence.empty() || words.cases) return html_report(archive, words);
  const bool is_page = !words.json && (words.format == "text" || words.format == "markdown");
  if (!words.baseline.empty() && !is_page)
    throw InputError("--baseline",
                     "stands on pages for people (text, markdown, --html); see: fleetproof compare --json");
  auto progress = reading_progress("report", archive.run_count());
  ReportInput input = read_report_input(archive, words.archive);
  progress.reset();
  add_exit_code(input);
  input.waived = lenient_conditions(input.campaign.plan_json);
  show_history(input, words);
  add_baseline(input, archive, words);
  const std::string text = render(input, words.json ? "json" : words.format);
  if (words.out.empty()) {
    put_text(text);
  } else {
    write_whole({words.out, "--output", OutputKind::Report}, text);
  }
  return told_to_ci(input, words);
}

}  // namespace

Action prepare_report(Options& options) {
  auto words = std::make_shared<ReportWords>();
  options.positional("DB", words->archive, "results file");
  options.option("--format", words->format, "text (default), markdown, junit, json or summary");
  options.option("-o,--output", words->out, "write the report to this file instead of standard output");
  options.option("--html", words->html, "write one self-contained HTML page with maps and charts to this file");
  options.option(
      "--cases", words->cases,
      "also write the pages of so many failing runs, and find out why each failed, in up to 20 s of CPU time: "
      "--html then names the folder of all pages");
  options.option("--baseline", words->baseline, "also say what changed since this results file");
  options.flag("--no-film", words->no_film, "leave out the film strips, which simulate up to ten runs again");
  options.option("--evidence", words->evidence,
                 "write the evidence of a release to this new folder: page, reports, runs as CSV, checksums");
  options.option("--ledger", words->ledger, "ledger of attempts (default: the one that the campaign wrote to)");
  options.flag("--json", words->json, "the same as --format json");
  options.flag("--digest", words->digest,
               "print one digest of plan and results, the same from every build, and beside it the engine");
  options.flag("--exit-zero", words->exit_zero, "end with exit code 0 whatever the verdict is; 3 stays 3");
  return [words] { return report(*words); };
}

}  // namespace fleetproof::cli
