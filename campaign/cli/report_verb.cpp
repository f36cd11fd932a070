#include <memory>

#include "campaign/cli/output_file.hpp"
#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"

namespace fleetproof::cli {
namespace {

struct ReportWords {
  std::string archive, format = "text", out;
  bool json = false, digest = false;
};

int report(const ReportWords& words) {
  const ArchiveReader archive(words.archive);
  if (words.digest) {
    put("{:016x}\n", archive.content_digest());
    return kDemonstrated;
  }
  const ReportInput input = read_report_input(archive, words.archive);
  const std::string text = render(input, words.json ? "json" : words.format);
  if (words.out.empty()) {
    put_text(text);
  } else {
    write_whole({words.out, "--output", OutputKind::Report}, text);
  }
  return input.exit_code;
}

}  // namespace

Action prepare_report(Options& options) {
  auto words = std::make_shared<ReportWords>();
  options.positional("DB", words->archive, "campaign file");
  options.option("--format", words->format, "text (default), markdown, json or summary");
  options.option("-o,--output", words->out, "write the report to this file instead of standard output");
  options.flag("--json", words->json, "the same as --format json");
  options.flag("--digest", words->digest, "print one digest over plan and results: equal exactly for equal content");
  return [words] { return report(*words); };
}

}  // namespace fleetproof::cli
