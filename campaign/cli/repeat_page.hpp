#pragma once

#include <string>
#include <vector>

#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

// A file of the campaign in the folder of its evidence.
struct KeptFile {
  std::string what;     // "a file of program rover", "layout hall-3"
  std::string name;     // in the folder; empty: it is not there
  std::string trouble;  // why it is not there
};

// A program that is not built in, with its files.
struct KeptProgram {
  std::string program;
  std::string word;  // for --plugin, in the folder; empty: its files are not there
  std::vector<KeptFile> files;
  bool is_command = false;  // what it finds by itself is not there
};

// What REPEAT.md of an evidence folder is about.
struct RepeatWords {
  std::string archive;  // the results file, in the folder; empty: the campaign was not finished, and it is not there
  std::string results_digest, verdict;
  int exit_code = 0;  // of `fleetproof report`
  std::vector<KeptProgram> programs;
  std::vector<KeptFile> layouts, campaign;
};

// " --plugin plugin-1.so", or nothing: what a verb needs to find the program in the folder.
std::string plugin_words(const KeptProgram& program);

// A page that says how to check the evidence and to simulate the campaign again, with nothing but this folder and the
// sources of the program. Each command stands on an indented line, and the next line says how it ends.
std::string repeat_page(const ReportInput& input, const RepeatWords& words);

}  // namespace fleetproof::cli
