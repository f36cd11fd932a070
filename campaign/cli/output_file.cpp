#include "campaign/cli/output_file.hpp"

#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"

namespace fleetproof::cli {

void write_whole(const std::string& path, const std::string& text, const std::string& option) {
  std::error_code failed;
  const bool replaces = !std::filesystem::exists(path, failed) || std::filesystem::is_regular_file(path, failed);
  // A pipe or a device takes the text; a rename would put a file in its place.
  const std::string draft = replaces ? path + ".draft" : path;
  std::ofstream file(draft, std::ios::binary);
  file << text;
  file.close();
  failed.clear();
  if (file && replaces) std::filesystem::rename(draft, path, failed);
  if (!file || failed) throw InputError(path, "cannot be written; choose another path for " + option);
}

}  // namespace fleetproof::cli
