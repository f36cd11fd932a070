#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// A sentence about why a run failed, found by changing one thing and simulating again.
struct ExplainedLine {
  std::string text;
  std::optional<std::int64_t> at_us;  // the instant that it is about
  bool is_of_run = false;             // of the run itself; otherwise of its smallest case
  std::vector<std::size_t> runs;      // the numbers of the runs that show it, from 1 on
  friend bool operator==(const ExplainedLine&, const ExplainedLine&) = default;
};

// From an instant on, the radio draws anew: in so many branches the run fails in the same way.
struct ExplainedBranches {
  std::int64_t at_us = 0;
  std::size_t failing = 0;
  friend bool operator==(const ExplainedBranches&, const ExplainedBranches&) = default;
};

// What was found out about one failing run, as its page shows it and as it is stored beside its results file. Texts may
// hold words of agents.
struct ExplainedRun {
  std::string of;       // which run: what is known of one says nothing of another
  std::string failure;  // "contact, two AGVs"
  std::string lead;     // what decided it, in a sentence; empty: no run that was tried tells
  std::vector<ExplainedLine> lines;
  std::vector<ExplainedBranches> curve;  // in order of time
  std::size_t branches = 0;              // of each instant
  bool is_whole = true;                  // false: the time was over before all was tried
  friend bool operator==(const ExplainedRun&, const ExplainedRun&) = default;
};
std::string explained_text(const ExplainedRun& run);  // JSON
std::optional<ExplainedRun> parse_explained(const std::string& text);

// What a page shows of an explanation, and where the pages of its other runs stand.
struct ExplainedPart {
  enum class Shows : std::uint8_t { Run, Smallest };

  ExplainedRun run;
  std::string command;               // that finds it out, and writes its runs
  Shows shows = Shows::Run;          // what this page shows
  std::string run_page, small_page;  // beside this page; empty: there is none
  std::size_t run_pages = 0;         // so many of the runs have pages beside this one: page_of_run
  const Film* failing = nullptr;     // this page shows a run in which one thing is changed: the failing one
};
// "003.html": of the run with this number.
std::string page_of_run(std::size_t number);

// The sentences, each with its instant and with links to the runs that show it, and the curve of no return as a figure.
html::Element explained_part(const ExplainedPart& part);

}  // namespace fleetproof::web
