#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace fleetproof {

// The one way to read a file that a person or another program may have put there. Under its name may stand a pipe that
// keeps its reader waiting for ever, a device without an end, a folder, a link to nothing, or a file that fills the
// memory. So it is opened once, without waiting, and it is read only if what was opened is a regular file.

// No text that this program reads is larger.
inline constexpr std::size_t kLargestTextFile = std::size_t{64} << 20;

// What stands under a path that should be a regular file: "is a folder", "is a pipe", ... Nothing for a regular file
// (or a link to one) and for a path where nothing stands. The file is not opened.
std::string_view what_else_stands_at(const std::string& path);

// Whether anything has this name, also a link to nothing.
bool is_name_taken(const std::string& path);

// A regular file, opened for reading.
class RegularFile {
 public:
  // Throws InputError, with a remedy, if no regular file stands there, or if it may not be read.
  explicit RegularFile(const std::string& path);
  // Nothing if nothing has the name. Throws the same if something else has it.
  static std::optional<RegularFile> if_there(const std::string& path);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  std::uint64_t size() const;  // when it was opened
  // The next bytes, `most` of them if it has so many. Throws InputError if the disk does not give them.
  std::string read(std::size_t most);

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

// The first bytes of a file, `most` of them if it has so many. Throws as RegularFile.
std::string read_beginning(const std::string& path, std::size_t most);
// The whole file. Throws as RegularFile, and if it is packed (gzip, ZIP, ...) or larger than kLargestTextFile, which is
// known before it is read.
std::string read_text_file(const std::string& path);
// The same; nothing if nothing has the name.
std::optional<std::string> read_text_file_if_there(const std::string& path);

// Calls `visit` with each line of a text, without its end.
void for_each_line(std::string_view text, const std::function<void(std::string_view)>& visit);

}  // namespace fleetproof
