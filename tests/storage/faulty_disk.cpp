#include "tests/storage/faulty_disk.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <cstring>
#include <new>

namespace fleetproof::test {
namespace {

struct Faults {
  DiskCall kind = DiskCall::Open;
  std::uint64_t first = 0, calls = 0, failed = 0;
  bool goes_on = false;

  bool strikes(DiskCall call) {
    if (call != kind) return false;
    ++calls;
    const bool struck = goes_on ? calls >= first : calls == first;
    if (struck) ++failed;
    return struck;
  }
};

Faults faults;
sqlite3_vfs* real_disk = nullptr;

// SQLite gives one block of memory for a file; the file of the real disk stands behind ours in it.
struct File {
  sqlite3_file base;
  static constexpr std::size_t kRealAt = 64;
  static sqlite3_file* real(sqlite3_file* file) {
    return std::launder(reinterpret_cast<sqlite3_file*>(reinterpret_cast<std::byte*>(file) + kRealAt));
  }
};
static_assert(sizeof(File) <= File::kRealAt);

template <auto Method, class... Arguments>
auto forward(sqlite3_file* file, Arguments... arguments) {
  sqlite3_file* real = File::real(file);
  return (real->pMethods->*Method)(real, arguments...);
}

int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 offset) {
  if (faults.strikes(DiskCall::Write)) {
    // A full disk writes the first part.
    (void)forward<&sqlite3_io_methods::xWrite>(file, bytes, count / 2, offset);
    return SQLITE_FULL;
  }
  return forward<&sqlite3_io_methods::xWrite>(file, bytes, count, offset);
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  if (faults.strikes(DiskCall::Truncate)) return SQLITE_IOERR_TRUNCATE;
  return forward<&sqlite3_io_methods::xTruncate>(file, size);
}

// Nothing is brought to the real disk: this machine keeps its power.
int sync(sqlite3_file*, int) { return faults.strikes(DiskCall::Sync) ? SQLITE_IOERR_FSYNC : SQLITE_OK; }

template <auto Method>
struct Forwarder;
template <class... Arguments, int (*sqlite3_io_methods::*Method)(sqlite3_file*, Arguments...)>
struct Forwarder<Method> {
  static int call(sqlite3_file* file, Arguments... arguments) { return forward<Method>(file, arguments...); }
};

void shm_barrier(sqlite3_file* file) { forward<&sqlite3_io_methods::xShmBarrier>(file); }

// Version 2: shared memory for write-ahead logs, no memory mapping of the file.
const sqlite3_io_methods kMethods{
    .iVersion = 2,
    .xClose = Forwarder<&sqlite3_io_methods::xClose>::call,
    .xRead = Forwarder<&sqlite3_io_methods::xRead>::call,
    .xWrite = write,
    .xTruncate = truncate,
    .xSync = sync,
    .xFileSize = Forwarder<&sqlite3_io_methods::xFileSize>::call,
    .xLock = Forwarder<&sqlite3_io_methods::xLock>::call,
    .xUnlock = Forwarder<&sqlite3_io_methods::xUnlock>::call,
    .xCheckReservedLock = Forwarder<&sqlite3_io_methods::xCheckReservedLock>::call,
    .xFileControl = Forwarder<&sqlite3_io_methods::xFileControl>::call,
    .xSectorSize = Forwarder<&sqlite3_io_methods::xSectorSize>::call,
    .xDeviceCharacteristics = Forwarder<&sqlite3_io_methods::xDeviceCharacteristics>::call,
    .xShmMap = Forwarder<&sqlite3_io_methods::xShmMap>::call,
    .xShmLock = Forwarder<&sqlite3_io_methods::xShmLock>::call,
    .xShmBarrier = shm_barrier,
    .xShmUnmap = Forwarder<&sqlite3_io_methods::xShmUnmap>::call,
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* flags_out) {
  file->pMethods = nullptr;
  if (faults.strikes(DiskCall::Open)) return SQLITE_CANTOPEN;
  const int result = real_disk->xOpen(real_disk, name, File::real(file), flags, flags_out);
  if (File::real(file)->pMethods != nullptr) file->pMethods = &kMethods;
  return result;
}

sqlite3_vfs faulty{};

}  // namespace

const char* name_of(DiskCall call) {
  switch (call) {
    case DiskCall::Open:
      return "open";
    case DiskCall::Write:
      return "write";
    case DiskCall::Sync:
      return "sync";
    case DiskCall::Truncate:
      return "truncate";
  }
  return "";
}

FaultyDisk::FaultyDisk(DiskCall kind, std::uint64_t first_to_fail, bool goes_on) {
  faults = {kind, first_to_fail, 0, 0, goes_on};
  if (real_disk == nullptr) {
    real_disk = sqlite3_vfs_find(nullptr);
    faulty = *real_disk;  // all but opening files; these methods do not look at their first argument's place
    faulty.zName = "faulty";
    faulty.szOsFile = static_cast<int>(File::kRealAt) + real_disk->szOsFile;
    faulty.xOpen = open;
  }
  sqlite3_vfs_register(&faulty, 1);
}

FaultyDisk::~FaultyDisk() { sqlite3_vfs_register(real_disk, 1); }

std::uint64_t FaultyDisk::failed() const { return faults.failed; }

}  // namespace fleetproof::test
