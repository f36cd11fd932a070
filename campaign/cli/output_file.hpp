#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fleetproof::cli {

// What an output option writes.
enum class OutputKind : std::uint8_t { Layout, LifLayout, CsvLayout, Picture, Scenario, Report };

// What a verb was asked to write: the path, the option that named it, and the kind of the file.
struct OutputFile {
  std::string path, option;
  OutputKind kind;
};

// Leaves `text` in the file, whole or not at all. A file that is there already is replaced only if it is empty or of
// the same kind. InputError, which names the option, if another kind of file stands there or the place cannot be
// written; EngineError if the disk is full.
void write_whole(const OutputFile& file, std::string_view text);

}  // namespace fleetproof::cli
