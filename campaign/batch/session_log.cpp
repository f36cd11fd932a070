#include "campaign/batch/session_log.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "campaign/run/engine_identity.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/regular_file.hpp"
#include "storage/archive_reader.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {
namespace {

constexpr const char *kFresh = "fresh", *kFixed = "fixed";
// Looks at runs that came out differently, by agent.
constexpr const char *kCloserLooks = "looked_at_earlier_runs", *kDependent = "dependent", *kOther = "other";
constexpr std::string_view kLogBeginning = "{\"started_utc\":";

// What could make this machine compute differently from another one, for session logs.
struct MachineFacts {
  std::string cpu;           // the model, as the kernel names it; empty: it does not
  std::string instructions;  // those that the C library chooses its functions by: "avx2 fma"
  std::string c_library;     // "glibc 2.36"
};

// The value of the first line "KEY : VALUE".
std::string cpu_line(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with(key) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

std::string known_instructions() {
  constexpr std::array kChosenBy = {"avx2", "avx512f", "fma", "fma4"};
  std::string known;
  std::istringstream words(cpu_line("flags"));
  for (std::string word; words >> word;) {
    for (const char* wanted : kChosenBy) {
      if (word == wanted) known += (known.empty() ? "" : " ") + word;
    }
  }
  return known;
}

MachineFacts machine_facts() {
  return {cpu_line("model name"), known_instructions(), std::string("glibc ") + gnu_get_libc_version()};
}

std::string line_of(const Json& json) { return json_text(json) + "\n"; }

Json json_of(const WorkerLoss& loss) {
  return {{"lost_run", loss.run_index},
          {"message", loss.message},
          {"fresh_worker", loss.in_fresh_worker},
          {"signal", WIFSIGNALED(loss.death.status) ? WTERMSIG(loss.death.status) : 0},
          {"cpu_s", loss.death.cpu_s},
          {"max_memory_kb", loss.death.max_memory_kb},
          {"stack", loss.stack},
          {"log", loss.log}};
}

// The file of an agent in one line of a log; empty: the line has none. The line may be of any kind, or damaged.
std::string file_in(std::string_view line, const std::string& agent) {
  const Json json = read_json(line);
  const Json* at = &json;
  for (const std::string& key : {std::string("plugins"), agent, std::string("file")}) {
    const auto found = at->find(key);  // the end, if `at` is no object
    if (found == at->end()) return "";
    at = &*found;
  }
  return at->is_string() ? at->get<std::string>() : "";
}

}  // namespace

SessionLog::SessionLog(const std::string& archive_path)
    : archive_path_(archive_path), path_(session_log_path(archive_path)) {
  read_log(path_, kLogBeginning,
           "this is no session log of fleetproof, and nothing is appended to it; give the results file another "
           "name, or move this file away");
  if (is_name_taken(path_))  // else it is made beside the results file, whose place is looked at by itself
    require_appendable(path_, "change the permissions, or give the results file another name");
}

void SessionLog::begin(const RunOptions& options, const AgentPrograms& programs, const SessionFacts& facts) const {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  Json plugins = Json::object();
  for (const AgentProgram* program : programs.foreign())
    plugins[program->name] = {{"file", lasting_word_of(program->source)}, {"sha256", program->source.sha256}};
  const MachineFacts machine = machine_facts();
  Json line = {{"started_utc", utc_now()},
               {"host", host.data()},
               {"pid", ::getpid()},
               {"jobs", options.workers},
               {"ledger", facts.ledger},
               {"overrides", facts.overrides},
               {"plugins", plugins},
               {"cpu", machine.cpu},
               {"cpu_has", machine.instructions},
               {"libraries", engine_identity().libraries + ", " + machine.c_library}};
  if (!facts.campaign_file.empty()) {
    line["campaign_file"] = facts.campaign_file;
    line["campaign_sha256"] = sha256_of_file(facts.campaign_file);
  }
  if (!facts.attempt.empty()) {
    line["attempt"] = facts.attempt;
    line["ledger_line"] = facts.ledger_line.number;
    line["ledger_hash"] = fmt::format("{:016x}", facts.ledger_line.hash);
  }
  if (!facts.shard.empty()) {
    line["shard"] = facts.shard;
    line["shard_source"] = facts.shard_source;
    line["release"] = facts.release;
    line["seed"] = facts.fresh_seed ? kFresh : kFixed;
  }
  append_lines(path_, line_of(line));
}

void SessionLog::took_over(const TakenOver& taken) const {
  append_lines(
      path_,
      line_of({{"runs_taken_over", taken.runs}, {"simulated_again", taken.simulated_again}, {"drawn", taken.drawn}}));
}

void SessionLog::end(const CampaignResult& result, int signal_number, const std::optional<ShardChunks>& chunks) const {
  Json line = {{"ended_utc", utc_now()},
               {"pid", ::getpid()},
               {"elapsed_s", result.progress.elapsed_s},
               {"runs_simulated", result.progress.simulated},
               {"runs_planned", result.progress.planned},
               {"workers_lost", result.loss_count},
               {"runs_disturbed", result.progress.disturbed},
               {"runs_audited", result.progress.audited},
               {"audits_differing", result.audits_differing},
               {"signal", signal_number}};
  for (const auto& [agent, looks] : result.closer_looks)
    line[kCloserLooks][agent] = {{kDependent, looks.dependent}, {kOther, looks.other}};
  if (chunks) {
    line["chunks"] = chunks->owned;
    line["chunks_published"] = chunks->published;
  } else {
    line["runs_stored"] = result.stored;
    line["seal"] = fmt::format("{:016x}", ArchiveReader(archive_path_).seal().value_or(0));
  }
  std::string lines = line_of(line);
  for (const WorkerLoss& loss : result.losses) lines += line_of(json_of(loss));
  append_lines(path_, lines);
}

namespace {

// The last text of this key at the top of a line of the log.
std::string last_text(const std::string& archive_path, const char* key) {
  std::string found;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    if (json.is_object() && json.contains(key) && json[key].is_string()) found = json[key].get<std::string>();
  });
  return found;
}

}  // namespace

RememberedFile remembered_campaign_file(const std::string& archive_path) {
  return {last_text(archive_path, "campaign_file"), last_text(archive_path, "campaign_sha256")};
}

std::string remembered_ledger(const std::string& archive_path) { return last_text(archive_path, "ledger"); }

std::string remembered_attempt(const std::string& archive_path) { return last_text(archive_path, "attempt"); }

std::vector<LogLine> remembered_ledger_lines(const std::string& archive_path) {
  const std::string ledger = remembered_ledger(archive_path);
  std::vector<LogLine> found;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    if (!json.is_object() || json.find("ledger") == json.end() || json["ledger"] != ledger) return;
    const auto number = json.find("ledger_line"), hash = json.find("ledger_hash");
    if (number == json.end() || !number->is_number_unsigned() || hash == json.end() || !hash->is_string()) return;
    found.push_back({number->get<std::uint64_t>(), std::strtoull(hash->get<std::string>().c_str(), nullptr, 16)});
  });
  return found;
}

std::string remembered_shard(const std::string& archive_path) { return last_text(archive_path, "shard"); }

std::string remembered_release(const std::string& archive_path) { return last_text(archive_path, "release"); }

bool remembers_fresh_seed(const std::string& archive_path) { return last_text(archive_path, "seed") == kFresh; }

std::string remembered_overrides(const std::string& archive_path) { return last_text(archive_path, "overrides"); }

std::optional<TakenOver> remembered_taken_over(const std::string& archive_path) {
  std::optional<TakenOver> taken;
  std::string attempt;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    if (!json.is_object()) return;
    const auto number = [&](const char* key) {
      const auto found = json.find(key);
      return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
    };
    if (json.contains("attempt") && std::exchange(attempt, json_text(json["attempt"])) != json_text(json["attempt"]))
      taken.reset();
    if (json.contains("runs_taken_over"))
      taken = {number("runs_taken_over"), number("simulated_again"), number("drawn")};
  });
  return taken;
}

RememberedSeal remembered_seal(const std::string& archive_path) {
  RememberedSeal seal;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    if (!json.is_object()) return;
    if (json.contains("started_utc")) seal = {};
    if (!json.contains("ended_utc")) return;
    const auto found = json.find("seal");
    seal = {true, std::nullopt};
    if (found != json.end() && found->is_string())
      seal.value = std::strtoull(found->get<std::string>().c_str(), nullptr, 16);
  });
  return seal;
}

std::uint64_t remembered_disturbed(const std::string& archive_path) {
  std::uint64_t sum = 0;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    const auto found = json.is_object() ? json.find("runs_disturbed") : json.end();
    if (found != json.end() && found->is_number_unsigned()) sum += found->get<std::uint64_t>();
  });
  return sum;
}

// One look may be a chance: memory that was never written holds the same byte now and then. Software that was
// exchanged has its looks of its own. A merge names no software.
std::set<std::string> remembered_dependent_agents(const std::string& archive_path) {
  std::map<std::string, CloserLooks> sums;
  std::string software;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    const Json json = read_json(line);
    if (!json.is_object()) return;
    const auto plugins = json.find("plugins"), looks = json.find(kCloserLooks);
    if (plugins != json.end() && !plugins->empty() && json_text(*plugins) != software) {
      software = json_text(*plugins);
      sums.clear();
    }
    if (looks == json.end() || !looks->is_object()) return;
    for (const auto& [agent, counts] : looks->items()) {
      const auto number = [&counts = counts](const char* key) {
        const auto found = counts.find(key);
        return found != counts.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
      };
      sums[agent].dependent += number(kDependent);
      sums[agent].other += number(kOther);
    }
  });
  std::set<std::string> agents;
  for (const auto& [agent, looks] : sums) {
    if (looks.dependent > 1 && looks.other == 0) agents.insert(agent);
  }
  return agents;
}

std::string remembered_plugin(const std::string& archive_path, const std::string& agent) {
  std::string found;
  for_each_log_line(session_log_path(archive_path), [&](std::string_view line) {
    if (const std::string remembered = file_in(line, agent); !remembered.empty()) found = remembered;
  });
  return found;
}

}  // namespace fleetproof
