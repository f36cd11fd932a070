#include "generators/text/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

// Closes its descriptor in the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  int close() { return ::close(std::exchange(number_, -1)); }

 private:
  int number_;
};

// Whether the place cannot be written, so that another place helps. Otherwise the disk failed.
[[noreturn]] void throw_not_written(const std::string& path, int error, std::string_view remedy) {
  const std::string what = fmt::format("cannot be written ({}); ", std::strerror(error));
  if (error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO)
    throw MachineError(path + ": " + what + "free some space or repair the disk; nothing was changed");
  throw InputError(path, what + std::string(remedy));
}

// The file behind a link: a rename would replace the link itself.
std::string behind_links(const std::string& path, std::string_view remedy) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
  const auto target = fs::canonical(path, error);
  if (error) throw InputError(path, fmt::format("is a link to nothing; {}", remedy));
  return target.string();
}

// A new file in the folder of `path`, opened for writing.
Descriptor open_draft(const std::string& path, std::string& draft, std::string_view remedy) {
  const std::string folder = path.substr(0, path.rfind('/') + 1);  // empty: this one
  for (int number = 0;; ++number) {
    draft = fmt::format("{}.fleetproof-draft-{}-{}", folder, ::getpid(), number);
    const int made = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (made >= 0) return Descriptor(made);
    // a file that a killed program left: try the next name
    if (errno != EEXIST) throw_not_written(path, errno, remedy);
  }
}

int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const auto written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// If the folder cannot be synced, as on some network disks, the file has its new name nevertheless.
void sync_folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.is_open()) (void)::fsync(opened.number());
}

// How many bytes the character has that begins here; 0: none of UTF-8 does.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  }
  return length;
}

}  // namespace

void require_utf8(std::string_view text, std::string_view source) {
  // Without its mark, UTF-16 has a byte 0 beside the first letter, which is one of ASCII in every format.
  const bool wide = text.size() > 1 && (text[0] == '\0') != (text[1] == '\0');
  if (wide || text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw InputError(source, "is in UTF-16; save it as UTF-8");
  refuse_latin1(text, source);
}

void refuse_latin1(std::string_view text, std::string_view source) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text.substr(at));
    if (length == 0)
      throw InputError(
          at_line(source, position_in(text, at).line),
          fmt::format("the byte 0x{:02x} is none of UTF-8; if the file is in Latin-1 or Windows-1252, save it as UTF-8 "
                      "(iconv -f WINDOWS-1252 -t UTF-8)",
                      static_cast<unsigned char>(text[at])));
    at += length;
  }
}

void write_text_file(const std::string& path, std::string_view text, std::string_view remedy) {
  if (path.empty()) throw InputError("", fmt::format("the output file needs a name; {}", remedy));
  const std::string target = behind_links(path, remedy);
  if (const auto what = what_else_stands_at(target); !what.empty())
    throw InputError(path, fmt::format("{}, into which nothing is written; {}", what, remedy));
  struct stat before {};
  const bool replaces = ::stat(target.c_str(), &before) == 0;
  // The rename needs only rights on the folder. A file that may not be written is refused nevertheless.
  if (replaces && ::access(target.c_str(), W_OK) != 0) throw_not_written(path, errno, remedy);
  std::string draft;
  Descriptor file = open_draft(target, draft, remedy);
  int error = write_all(file.number(), text);
  if (error == 0 && replaces && ::fchmod(file.number(), before.st_mode & 07777) != 0) error = errno;
  if (error == 0 && ::fsync(file.number()) != 0) error = errno;
  if (file.close() != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(draft.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(draft.c_str());
    throw_not_written(path, error, remedy);
  }
  sync_folder_of(target);
}

TextPosition position_in(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, std::min(offset, text.size()));
  const auto last_break = before.rfind('\n');
  const auto breaks = static_cast<std::size_t>(std::ranges::count(before, '\n'));
  return {breaks + 1, before.size() - (last_break == std::string_view::npos ? 0 : last_break + 1) + 1};
}

std::string at_line(std::string_view source, std::size_t line) { return fmt::format("{}:{}", source, line); }

}  // namespace fleetproof
