#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof::lockstep {

// The program on the other side has broken the protocol, or is gone. The text says how, for people.
class Broken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A part of a line as it is quoted in errors.
std::string cited(std::string_view line);

// A process that is spoken to over its standard input and output, in lines. Its standard error is that of this process.
// It ends with this object, or with the thread that has started it. It leads a process group, which ends with this
// object: the processes that it has started, but for those that have left the group.
class Process {
 public:
  // Requires: SIGPIPE is ignored in this process, and `words` is not empty. Throws Broken if it cannot be started.
  explicit Process(std::vector<std::string> words);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Adds the line feed. Throws Broken if there is an answer to nothing, or nobody to read the line.
  void send(std::string& line);
  // The next line, without its end; valid until the next call. Waits for it. Throws Broken.
  std::string_view receive();
  // The same, but an end in order, with exit code 0, is an empty line.
  std::string_view receive_or_end();

 private:
  bool read_more();
  [[noreturn]] void tell_end();
  int end();

  pid_t process_ = 0;
  int handle_ = -1;  // becomes readable when the process has ended; -1: the system has no such handles
  int to_ = -1, from_ = -1;
  int status_ = 0;          // as of waitpid
  std::vector<char> room_;  // for what is read; not cleared for each answer, which takes microseconds
  std::string bytes_;       // received
  std::size_t taken_ = 0;   // of them, in lines that were returned
};

}  // namespace fleetproof::lockstep
