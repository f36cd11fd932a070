#include "campaign/cli/output_file.hpp"

#include <filesystem>
#include <fstream>

#include "core/error.hpp"

namespace fleetproof::cli {

void write_whole(const std::string& path, const std::string& text, const std::string& option) {
  const std::string draft = path + ".draft";
  std::ofstream file(draft, std::ios::binary);
  file << text;
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(draft, path, failed);
  if (!file || failed) throw InputError(path, "cannot be written; choose another path for " + option);
}

}  // namespace fleetproof::cli
