#include "campaign/cli/repeat_page.hpp"

#include <fmt/format.h>

#include "reports/page/wording.hpp"

namespace fleetproof::cli {
namespace {

std::string files_text(const std::vector<KeptFile>& files) {
  std::string text;
  for (const KeptFile& file : files) {
    text += file.name.empty() ? fmt::format("* {}: not in this folder ({}).\n", printable(file.what, 200), file.trouble)
                              : fmt::format("* `{}`: {}.\n", file.name, printable(file.what, 200));
  }
  return text;
}

std::string command(const std::string& words, const std::string& ending) {
  return fmt::format("\n    {}\n\n{}\n", words, ending);
}

std::string program_text(const EngineIdentity& engine) {
  return fmt::format(
      "| version | {} |\n|---|---|\n| source commit | {} |\n| SHA-256 of the program | {} |\n| compiler | {} |\n"
      "| flags | {} |\n| libraries | {} |\n",
      engine.version, engine.source_commit.empty() ? "not recorded" : engine.source_commit, engine.program_sha256,
      engine.compiler, engine.flags, printable(engine.libraries, 2000));
}

}  // namespace

std::string plugin_words(const KeptProgram& program) {
  return program.word.empty() ? "" : " --plugin " + shell_word(program.word);
}

std::string repeat_page(const ReportInput& input, const RepeatWords& words) {
  std::string text = fmt::format(
      "# How to repeat this evidence\n\nCampaign {}, seed {}. Call everything in this folder, in a copy of it if it "
      "must stay as it is.\n\n## 1. Nothing was changed\n",
      printable(input.campaign.name, 100), input.campaign.seed);
  text += command("sha256sum -c SHA256SUMS", "Ends with 0, and says OK for each file.");
  text += "\n## 2. The program\n\nThis program made the results:\n\n" + program_text(input.campaign.engine) +
          "\nTake that program, or check out the commit, call `./get-started`, and put `build/default` into `PATH`. "
          "Every build of the commit computes the same results. The sources say in `README.md` what they need.\n";
  text += command("fleetproof --version", "Ends with 0, and shows the table above.");
  text +=
      "\n## 3. The files of the campaign\n\n`plan.json` holds the whole plan: all cells, gates and layouts, as the "
      "program used them.\n\n" +
      files_text(words.campaign) + files_text(words.layouts);
  std::string plugins;
  bool is_complete = true;
  for (const KeptProgram& program : words.programs) {
    text += files_text(program.files);
    if (program.is_command) {
      text += fmt::format(
          "* What the command of agent {} finds by itself, such as an interpreter and its modules, is not in "
          "this folder.\n",
          printable(program.program, 200));
    }
    plugins += plugin_words(program);
    is_complete = is_complete && !program.word.empty();
  }
  if (words.archive.empty())
    return text +
           "\n## 4. The results\n\nThe campaign was under way when this folder was written, so its results file "
           "is not in it. Write the folder again when the campaign is finished.\n";
  text += fmt::format("* `{}`: all results.\n", words.archive);
  text += "\n## 4. The results say what the reports say\n";
  const std::string archive = shell_word(words.archive);
  text += command(fmt::format("fleetproof report {} --digest", archive),
                  fmt::format("Ends with 0, and prints the digest {}.", words.results_digest));
  text += command(fmt::format("fleetproof report {} --ledger attempts.jsonl", archive),
                  fmt::format("Ends with {}: {}.", words.exit_code, words.verdict));
  text +=
      "\n## 5. The results come out again\n\nThis simulates every run once more. It takes as long as the campaign "
      "did.\n";
  text +=
      command(fmt::format("fleetproof verify {} --sample 100%{}", archive, plugins),
              is_complete ? "Ends with 0: every run is the same to the bit, if the software does the same each time."
                          : "Cannot be done without the programs that are not in this folder.");
  return text +
         "\n`replay.txt` has one command for each failing run, the most serious of the software under test first.\n";
}

}  // namespace fleetproof::cli
