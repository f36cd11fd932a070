#include "campaign/shards/stored_plan.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/durable_file.hpp"

namespace fleetproof {
namespace {

namespace fs = std::filesystem;

// A folder of this machine, which goes with the object.
class LocalFolder {
 public:
  LocalFolder() : path_((fs::temp_directory_path() / "fleetproof-plan-XXXXXX").string()) {
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

void copy(const std::string& from, const std::string& to) {
  std::error_code error;
  if (!fs::copy_file(from, to, error))
    throw MachineError(fmt::format("{}: cannot be copied to {} ({}); free some space, or name another folder", from, to,
                                   error.message()));
}

}  // namespace

StoredPlan read_plan(const ShardFolder& folder) {
  folder.require_plan();
  const LocalFolder local;
  copy(folder.plan_file(), local.plan());
  try {
    const ArchiveReader plan(local.plan());
    plan.for_each_run([](const RunRecord&) {});  // checks the seal
    return {plan.campaign(), plan.cells(), plan.gates()};
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
  if (fs::exists(target)) return;
  const LocalFolder local;
  ArchiveWriter(local.plan(), plan.campaign, plan.cells, plan.gates).publish(0);
  copy(local.plan(), temporary);
  if (publish_once(temporary, target) != Publication::Differs) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
}

}  // namespace fleetproof
