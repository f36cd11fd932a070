#include "campaign/shards/run_spool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/error.hpp"

namespace fleetproof {

std::string temporary_folder() {
  std::error_code error;
  const auto path = std::filesystem::temp_directory_path(error);
  if (!error) return path.string();
  const char* named = std::getenv("TMPDIR");
  throw InputError("TMPDIR",
                   fmt::format("names \"{}\", which is no folder that can be used ({}); make it, or name another",
                               named != nullptr ? named : "/tmp", error.message()));
}

namespace {

[[noreturn]] void failed(const char* what) {
  throw MachineError(fmt::format("{}: {} ({}); free some space there, or name another folder with TMPDIR",
                                 temporary_folder(), what, std::strerror(errno)));
}

int open_unnamed() {
  std::string name = temporary_folder() + "/fleetproof-chunk-XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) failed("no temporary file can be made");
  ::unlink(name.c_str());
  return file;
}

}  // namespace

RunSpool::RunSpool(std::uint64_t run_count) : extents_(run_count), missing_(run_count), file_(open_unnamed()) {}

RunSpool::~RunSpool() { ::close(file_); }

void RunSpool::add(std::uint64_t place, std::string_view encoded) {
  Extent& extent = extents_.at(place);
  ensure(extent.length == 0 && !encoded.empty(), "a run finishes once");
  for (std::size_t done = 0; done < encoded.size();) {
    const auto written =
        ::pwrite(file_, encoded.data() + done, encoded.size() - done, static_cast<off_t>(used_ + done));
    if (written < 0 && errno != EINTR) failed("a temporary file cannot be written");
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  extent = {used_, encoded.size()};
  used_ += encoded.size();
  --missing_;
}

std::string RunSpool::at(std::uint64_t place) const {
  const Extent& extent = extents_.at(place);
  std::string bytes(extent.length, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const auto read =
        ::pread(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(extent.offset + done));
    if (read == 0 || (read < 0 && errno != EINTR)) failed("a temporary file cannot be read");
    if (read > 0) done += static_cast<std::size_t>(read);
  }
  return bytes;
}

}  // namespace fleetproof
