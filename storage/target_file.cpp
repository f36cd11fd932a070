#include "storage/target_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "storage/schema.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kApplicationIdAt = 68;  // in the header of an SQLite file, big-endian

using Header = std::array<char, kApplicationIdAt + 4>;

std::optional<Header> header_of(const std::string& path) {
  Header header{};
  std::ifstream file(path, std::ios::binary);
  return file.read(header.data(), header.size()) ? std::optional(header) : std::nullopt;
}

bool is_results_header(const Header& header) {
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | static_cast<unsigned char>(header[kApplicationIdAt + i]);
  return std::string_view(header.data(), 15) == "SQLite format 3" && id == static_cast<std::uint32_t>(kApplicationId);
}

// Judged by the header, so that a damaged results file still counts as a results file.
bool is_results_file(const std::string& path) {
  const auto header = header_of(path);
  return header && is_results_header(*header);
}

// A link is not followed: the rename would replace the link, not the file behind it.
fs::file_status status_of(const std::string& path) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::none) throw_cannot_make(path, error.value());
  return status;
}

[[noreturn]] void throw_not_ours(const std::string& path) {
  throw InputError(path, "this is not a results file of fleetproof; it is not overwritten; give another name");
}

}  // namespace

std::string absolute_name(const std::string& path) {
  std::error_code error;
  const auto absolute = fs::absolute(path, error);
  if (error)
    throw InputError(path, fmt::format("the current folder cannot be found ({}); give a full path", error.message()));
  return absolute.string();
}

void require_place(const std::string& path) {
  if (path.empty()) throw InputError("", "the results file needs a name");
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path, "this is a folder; name a file in it");
  const auto folder = fs::path(absolute_name(path)).parent_path();
  const auto status = fs::status(folder, error);
  if (status.type() == fs::file_type::none) throw_cannot_make(path, error.value());
  if (status.type() == fs::file_type::not_found) {
    throw InputError(path, fmt::format("there is no folder {}; make it first, or give another name", folder.string()));
  }
  if (!fs::is_directory(status))
    throw InputError(path, fmt::format("{} is a file, not a folder; give another name", folder.string()));
}

void require_free_name(const std::string& path, Existing existing) {
  const auto status = status_of(path);
  if (!fs::exists(status)) return;
  if (existing == Existing::Refuse)
    throw InputError(path, "this file exists already; give another name, or remove it to start again");
  if (!fs::is_regular_file(status) || !is_results_file(path)) throw_not_ours(path);
}

bool holds_results(const std::string& path) { return fs::is_regular_file(status_of(path)) && is_results_file(path); }

bool is_empty_file(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(status_of(path)) && fs::file_size(path, error) == 0 && !error;
}

void require_free_live_name(const std::string& live_path, Existing existing) {
  const auto status = status_of(live_path);
  if (!fs::exists(status)) return;
  if (existing == Existing::Refuse)
    throw InputError(live_path,
                     "a campaign of this name was interrupted; remove this file to start again, or give another name");
  if (is_empty_file(live_path)) return;  // the program was killed before it wrote a header
  if (!fs::is_regular_file(status) || !is_results_file(live_path)) throw_not_ours(live_path);
}

// SQLite writes the first page last: until then it is all zeros.
void require_own_rest(const std::string& path) {
  const auto status = status_of(path);
  if (!fs::exists(status) || is_empty_file(path)) return;
  const auto header = fs::is_regular_file(status) ? header_of(path) : std::nullopt;
  if (header && (is_results_header(*header) || *header == Header{})) return;
  throw InputError(path,
                   "fleetproof needs this name beside the results file, and this file is not of fleetproof; move it "
                   "away, or give the results file another name");
}

void throw_cannot_make(const std::string& path, int error) {
  const auto* const cause = std::strerror(error);
  switch (error) {
    case EACCES:
    case EPERM:
      throw InputError(
          path, fmt::format(
                    "this file may not be made here ({}); change the permissions of its folder, or name another folder",
                    cause));
    case EROFS:
      throw InputError(path, fmt::format("this place cannot be written ({}); name a folder on another disk", cause));
    case ENOENT:
    case ENOTDIR:
      throw InputError(path, fmt::format("no file can be made in this folder ({}); name another folder", cause));
    case ENAMETOOLONG:
      throw InputError(path, fmt::format("this name is too long ({}); give a shorter one", cause));
    case EISDIR:
    case ELOOP:
    case EEXIST:
      throw InputError(
          path,
          fmt::format("something of this name stands in the way ({}); remove it, or give the results file another name",
                      cause));
    case ENOSPC:
    case EDQUOT:
      throw MachineError(
          fmt::format("{}: the disk is full ({}); free some space, then the same command goes on", path, cause));
    default:
      throw MachineError(fmt::format("{}: the disk refused to make the file ({}); look at the disk", path, cause));
  }
}

}  // namespace fleetproof
