#include "storage/beside.hpp"

namespace fleetproof {

std::string beside(std::string_view archive_path, std::string_view ending) {
  for (const std::string_view dropped : {".partial", ".db"}) {
    if (archive_path.ends_with(dropped)) archive_path.remove_suffix(dropped.size());
  }
  return std::string(archive_path) + std::string(ending);
}

}  // namespace fleetproof
