#include "campaign/cli/ci_summary.hpp"

#include <cstdlib>
#include <fstream>

#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "reports/sections/verdict_sentences.hpp"

namespace fleetproof::cli {
namespace {

// GitHub drops a summary above 1 MiB; a page for people has less.
constexpr std::size_t kMostBytes = 60'000;

// As commands of a workflow want it: one line.
std::string in_command(std::string_view text, bool is_property) {
  std::string out;
  for (const char c : text) {
    if (c == '%') {
      out += "%25";
    } else if (c == '\n') {
      out += "%0A";
    } else if (is_property && c == ':') {
      out += "%3A";
    } else if (is_property && c == ',') {
      out += "%2C";
    } else {
      out += c;
    }
  }
  return out;
}

std::string page_of(const ReportInput& input) {
  std::string page = render(input, "markdown");
  if (page.size() <= kMostBytes) return page;
  page.resize(page.rfind('\n', kMostBytes));
  return page + "\n\nThe rest is left out here: see the report of the results file.\n";
}

}  // namespace

void tell_ci(const ReportInput& input) {
  if (const char* summary = std::getenv("GITHUB_STEP_SUMMARY"); summary != nullptr && *summary != '\0') {
    std::ofstream file(summary, std::ios::app);
    file << page_of(input) << '\n';
    file.close();
    if (!file) talk("the step summary {} cannot be written\n", summary);
  }
  const char* actions = std::getenv("GITHUB_ACTIONS");
  if (actions == nullptr || std::string_view(actions) != "true") return;
  const Headline claim = verdicts(input).front();
  talk_text("::" + std::string(conclusion_of(input) == Conclusion::Demonstrated ? "notice" : "error") +
            " title=" + in_command("fleetproof " + claim.word, true) + "::" + in_command(claim.text, false) + "\n");
}

}  // namespace fleetproof::cli
