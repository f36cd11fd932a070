#include "core/base/regular_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

[[noreturn]] void throw_not_opened(const std::string& path, int error) {
  if (error == ELOOP) throw InputError(path, "is a link that leads back to itself; remove it, or name another file");
  if (error != ENOENT && error != ENOTDIR)
    throw InputError(path, fmt::format("cannot be opened ({}); check its permissions", std::strerror(error)));
  if (is_name_taken(path)) throw InputError(path, "is a link to nothing; remove it, or name another file");
  std::error_code gone;
  (void)std::filesystem::current_path(gone);
  if (!path.starts_with('/') && gone)
    throw InputError(path, "the current folder is not there any more; change into one that is, or give a full path");
  throw InputError(path, "there is no such file");
}

struct Packing {
  std::string_view beginning, sentence;
};
constexpr Packing kPackings[] = {
    {"\x1f\x8b", "is packed with gzip; unpack it with gunzip, and name the file that comes out"},
    {"PK\x03\x04", "is a ZIP archive, as spreadsheets (.xlsx) are, too; unpack it, or save the sheet as CSV"},
    {"BZh", "is packed with bzip2; unpack it with bunzip2, and name the file that comes out"},
    {"\xfd\x37zXZ", "is packed with xz; unpack it with unxz, and name the file that comes out"},
    {"\x28\xb5\x2f\xfd", "is packed with zstd; unpack it with unzstd, and name the file that comes out"},
};

std::string all_of(RegularFile& file, const std::string& path) {
  std::string text = file.size() > kLargestTextFile ? std::string() : file.read(kLargestTextFile + 1);
  if (std::max<std::uint64_t>(file.size(), text.size()) > kLargestTextFile)
    throw InputError(path, "is larger than 64 MiB, which no file of this kind is; check the file name");
  for (const auto& [beginning, sentence] : kPackings) {
    if (text.starts_with(beginning)) throw InputError(path, sentence);
  }
  return text;
}

}  // namespace

std::string_view what_else_stands_at(const std::string& path) {
  using Type = std::filesystem::file_type;
  std::error_code ignored;
  switch (std::filesystem::status(path, ignored).type()) {
    case Type::directory:
      return "is a folder";
    case Type::fifo:
      return "is a pipe";
    case Type::socket:
      return "is a socket";
    case Type::block:
    case Type::character:
      return "is a device";
    default:
      return {};
  }
}

bool is_name_taken(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

RegularFile::RegularFile(const std::string& path) : path_(path) {
  if (const auto what = what_else_stands_at(path); !what.empty())
    throw InputError(path, fmt::format("{}; name a regular file", what));
  // A pipe may have replaced the file since the check. Without O_NONBLOCK, open() would then wait for a writer.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor_ < 0) throw_not_opened(path, errno);
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw InputError(path, "is no regular file; name one");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::optional<RegularFile> RegularFile::if_there(const std::string& path) {
  if (!is_name_taken(path) && (errno == ENOENT || errno == ENOTDIR)) return std::nullopt;
  return RegularFile(path);
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::uint64_t RegularFile::size() const { return size_; }

std::string RegularFile::read(std::size_t most) {
  std::string text;
  char buffer[65536];
  while (text.size() < most) {
    const auto count = ::read(descriptor_, buffer, std::min(sizeof buffer, most - text.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw InputError(path_, fmt::format("cannot be read to its end ({}); check the disk", std::strerror(errno)));
    if (count == 0) break;
    text.append(buffer, static_cast<std::size_t>(count));
  }
  return text;
}

std::string read_beginning(const std::string& path, std::size_t most) { return RegularFile(path).read(most); }

std::string read_text_file(const std::string& path) {
  RegularFile file(path);
  return all_of(file, path);
}

std::optional<std::string> read_text_file_if_there(const std::string& path) {
  auto file = RegularFile::if_there(path);
  if (!file) return std::nullopt;
  return all_of(*file, path);
}

void for_each_line(std::string_view text, const std::function<void(std::string_view)>& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    visit(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace fleetproof
