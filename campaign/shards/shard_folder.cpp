#include "campaign/shards/shard_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include "campaign/shards/run_spool.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/durable_file.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFilesOfAFolder = 1000;
constexpr std::string_view kChunk = ".chunk", kDiffers = ".differs-", kTemporary = ".tmp-";

// Attempts of one task may not be told apart by anything that the engine says: a restart may count as the first.
std::string random_word() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

std::optional<std::uint64_t> number_before(std::string_view name, std::string_view ending) {
  const auto at = name.find(ending);
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(name.data(), name.data() + std::min(at, name.size()), value);
  if (at == std::string_view::npos || error != std::errc{} || stop != name.data() + at) return std::nullopt;
  return value;
}

// All files in the folders of the chunks, but those that were not finished.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error); !error && entry != fs::end(entry);
       entry.increment(error)) {
    std::error_code none;
    const std::string name = entry->path().filename().string();
    const bool is_folder = entry->is_directory(none);
    if (is_folder && name.ends_with(kChunk))
      throw InputError(entry->path().string(), "is a folder and stands where a chunk belongs; move it away");
    if (!is_folder && !name.starts_with(kTemporary)) files.push_back(entry->path());
  }
  if (error) throw InputError(folder.string(), fmt::format("cannot be read ({})", error.message()));
  std::ranges::sort(files);
  return files;
}

bool is_differing(const fs::path& file) { return number_before(file.filename().string(), kDiffers).has_value(); }

}  // namespace

std::string ShardFolder::chunk_file(std::uint64_t chunk) const {
  return fmt::format("{}/chunks/{:03}/{:06}{}", path_, chunk / kFilesOfAFolder, chunk, kChunk);
}

std::string ShardFolder::differing_file(std::uint64_t chunk) const {
  return fmt::format("{}/chunks/{:03}/{:06}{}{}", path_, chunk / kFilesOfAFolder, chunk, kDiffers, random_word());
}

std::string ShardFolder::temporary_name(const std::string& target) {
  const fs::path path(target);
  return (path.parent_path() / fmt::format("{}{}-{}", kTemporary, random_word(), path.filename().string())).string();
}

std::string ShardFolder::new_session_name(Shard shard) const {
  return fmt::format("{}/sessions/{}-of-{}-{}.db", path_, shard.index, shard.count, random_word());
}

void ShardFolder::make() const {
  for (const char* part : {"", "/chunks", "/sessions"}) {
    std::error_code error;
    fs::create_directories(path_ + part, error);
    if (error)
      throw InputError("--out", fmt::format("the folder {}{} cannot be made ({}); name another folder", path_, part,
                                            error.message()));
  }
}

void ShardFolder::require_plan() const {
  std::error_code error;
  if (!fs::is_directory(path_, error))
    throw InputError(path_, "there is no such folder; name one that `fleetproof run --shard ... --out` wrote");
  if (fs::exists(plan_file(), error)) return;
  if (is_name_taken(plan_file())) RegularFile says_why(plan_file());
  throw InputError(path_,
                   "no shard has written a plan.db here; name a folder that `fleetproof run --shard ... "
                   "--out` wrote");
}

std::map<std::uint64_t, std::string> ShardFolder::chunk_files() const {
  std::map<std::uint64_t, std::string> chunks;
  for (const fs::path& file : files_in(path_ + "/chunks")) {
    if (is_differing(file)) continue;
    const auto chunk = number_before(file.filename().string(), kChunk);
    if (!chunk || chunk_file(*chunk) != file.string())
      throw InputError(file.string(), "this is not the name of a chunk of this folder; move the file away");
    chunks.emplace(*chunk, file.string());
  }
  return chunks;
}

std::vector<std::string> ShardFolder::differing_files() const {
  std::vector<std::string> files;
  for (const fs::path& file : files_in(path_ + "/chunks")) {
    if (is_differing(file)) files.push_back(file.string());
  }
  return files;
}

std::vector<std::string> ShardFolder::sessions() const {
  std::vector<std::string> names;
  std::error_code error;
  const std::string ending = session_log_path("x").substr(1);
  for (const auto& entry : fs::directory_iterator(path_ + "/sessions", error)) {
    const std::string log = entry.path().string();
    if (log.ends_with(ending)) names.push_back(log.substr(0, log.size() - ending.size()) + ".db");
  }
  std::ranges::sort(names);
  return names;
}

namespace {

// A folder of this machine, which goes with the object.
class LocalFolder {
 public:
  LocalFolder() : path_(temporary_folder() + "/fleetproof-plan-XXXXXX") {
    if (::mkdtemp(path_.data()) == nullptr)
      throw MachineError(fmt::format("{}: no folder can be made here; name another place with TMPDIR", path_));
  }
  ~LocalFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  LocalFolder(const LocalFolder&) = delete;
  LocalFolder& operator=(const LocalFolder&) = delete;
  std::string plan() const { return path_ + "/plan.db"; }

 private:
  std::string path_;
};

// A plan is no larger than a text that this program reads, and anybody may have put another file into the folder.
void copy(const std::string& from, const std::string& to) {
  const std::string bytes = read_text_file(from);
  std::ofstream file(to, std::ios::binary);
  file << bytes;
  file.close();
  if (!file)
    throw MachineError(fmt::format("{}: cannot be copied to {} ({}); free some space, or name another folder", from, to,
                                   std::strerror(errno)));
}

}  // namespace

StoredPlan read_plan(const ShardFolder& folder) {
  folder.require_plan();
  const LocalFolder local;
  copy(folder.plan_file(), local.plan());
  try {
    const ArchiveReader archive(local.plan());
    archive.for_each_run([](const RunRecord&) {});  // checks the seal
    return archive.plan();
  } catch (const MachineError&) {
    throw;
  } catch (const InputError& error) {  // of another version, for example
    throw InputError(folder.plan_file(), fmt::format("cannot be read: {}", error.what()));
  } catch (const std::exception&) {
    throw EngineError(
        fmt::format("{}: this plan is damaged; remove it, the next shard writes it again", folder.plan_file()));
  }
}

void publish_plan(const ShardFolder& folder, const StoredPlan& plan) {
  const std::string target = folder.plan_file(), temporary = ShardFolder::temporary_name(target);
  if (is_name_taken(target)) return;
  const LocalFolder local;
  ArchiveWriter(local.plan(), plan).publish(0);
  copy(local.plan(), temporary);
  if (publish_once(temporary, target) != Publication::Differs) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
}

}  // namespace fleetproof
