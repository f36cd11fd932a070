#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fleetproof::cli {

// What an output option writes.
enum class OutputKind : std::uint8_t {
  Layout,
  LifLayout,
  CsvLayout,
  Picture,
  Scenario,
  Report,
  Sensitivity,
  Trace,
  Pieces,
  Poses,
  ChromeTrace,
  ReplayPage,
  Fleet,
  Findings,
  FoundFindings,
  Explanation,
  FoundExplanation
};

// An output that the user asked for: the path, the option that named it, and the kind of the file.
struct OutputFile {
  std::string path, option;
  OutputKind kind;
};

// Before work of hours: throws what write_whole would throw for an existing file.
void require_writable(const OutputFile& file);

// Writes `text` to the file, whole or not at all. An existing file is replaced only if it is empty or of the same kind.
// Throws InputError with the name of the option if the existing file is of another kind, or if the place cannot be
// written. Throws MachineError if the disk is full.
void write_whole(const OutputFile& file, std::string_view text);

}  // namespace fleetproof::cli
