#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/engine/run_watch.hpp"

namespace fleetproof {

// The files that take what agents print. Each line says who printed it, in which run and when:
//   run 17, AGV 2, 12.345 s: waiting for the section ahead
// A worker prints into its log directly, so that a crash loses nothing. The lines at the end of the file that have no
// label yet are those of the call under way: they get it when that call is over, or when the worker is dead.

// What stands in front of the lines that are printed in this call of an agent.
std::string line_label(std::uint64_t run_index, const CallNote& call);
// The same while a worker starts and loads the plug-ins.
inline constexpr std::string_view kStartLabel = "start of a worker: ";

// The same when the run is over.
std::string end_label(std::uint64_t run_index);

// Puts the label in front of each line behind the first `labelled` bytes of a log. Returns the size of the log then.
// Lines that would go beyond the limit of the process for a file, or that fill more than a megabyte, stay without.
std::uint64_t label_lines(int log, std::uint64_t labelled, std::string_view label);

// Adds a line to a log, unless it would go beyond the limit of the process for a file. Returns the size of the log
// then.
std::uint64_t add_line(int log, std::string_view line);

// Whether the logs of an earlier session stay, and are written on.
enum class EarlierLogs : bool { Stay, AreRemoved };

// The logs of some workers, one for each, with names from "x.worker-0.log" on. A file of another program, or one that
// another fleetproof writes, is left alone: the next number is taken.
class WorkerLogs {
 public:
  // An empty prefix makes none. Throws InputError if a file cannot be made.
  WorkerLogs(const std::string& prefix, int count, EarlierLogs earlier);
  ~WorkerLogs();  // removes the files in which nothing was printed
  WorkerLogs(const WorkerLogs&) = delete;
  WorkerLogs& operator=(const WorkerLogs&) = delete;

  const std::vector<int>& descriptors() const { return descriptors_; }  // by worker; -1: none
  const std::string& path(int worker) const { return paths_[static_cast<std::size_t>(worker)]; }
  std::uint64_t size(int worker) const;
  // The lines of the last stack trace in the log of a worker (fatal_signals.hpp), without this label; empty: there is
  // none.
  std::vector<std::string> last_stack(int worker, std::string_view label) const;

 private:
  std::vector<std::string> paths_;
  std::vector<int> descriptors_;
};

// Copies all logs with one of the prefixes `from` beside each other, as logs with the prefix `to`. Logs that stood
// there under that prefix are removed first. What is no log, or cannot be read or written, is left out.
void carry_logs_over(const std::vector<std::string>& from, const std::string& to);

// The last lines that a run has in a log with this prefix, at most `most` of them, without the number of the run.
// `trouble`: why a log cannot be read.
struct PrintedLines {
  std::string log;
  std::vector<std::string> lines;
  std::string trouble;
};
PrintedLines last_printed(const std::string& prefix, std::uint64_t run_index, std::size_t most);

}  // namespace fleetproof
