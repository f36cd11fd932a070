#include "reports/attempts/attempt_ledger.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.hpp"
#include "core/base/json_text.hpp"
#include "core/base/random.hpp"
#include "core/base/regular_file.hpp"
#include "reports/page/wording.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kFirstWords = "{\"attempt\":";

constexpr const char* kAfter = "after";  // the hash of the line before; lines of older programs do not have it

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

std::uint64_t number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

std::uint64_t hex_in(const Json& json, const char* key) {
  const std::string text = text_in(json, key);
  std::uint64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return value;
}

bool flag_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

AttemptLedger::AttemptLedger(std::string path) : path_(std::move(path)) {
  const std::string text = read_log(
      path_, kFirstWords, "this is no ledger of attempts, and nothing is appended to it; name another with --ledger");
  for_each_line(text, [&](std::string_view line) { take(line); });
}

bool AttemptLedger::has(const LogLine& line) const {
  return line.number >= 1 && line.number <= hashes_.size() && hashes_[line.number - 1] == line.hash;
}

void AttemptLedger::take(std::string_view line) {
  const Json json = read_json(line);
  const std::uint64_t before = hashes_.empty() ? 0 : hashes_.back();
  hashes_.push_back(line_hash(line));
  const std::string after = json.is_object() ? text_in(json, kAfter) : "";
  is_chained_ |= !after.empty();
  if (is_chained_ && after != hex_text(before) && !first_foreign_line_) first_foreign_line_ = hashes_.size();
  const std::string what = json.is_object() ? text_in(json, "attempt") : "";
  const std::string id = what.empty() ? "" : text_in(json, "id");
  const auto known = std::ranges::find(attempts_, id, &Attempt::id);
  if (what == "begins" && !id.empty() && known == attempts_.end()) {
    const std::string archive = text_in(json, "archive");
    if (flag_in(json, "overwrites")) {
      for (Attempt& earlier : attempts_) earlier.replaced |= earlier.archive == archive;
    }
    attempts_.push_back({id, text_in(json, "begun_utc"), "", text_in(json, "campaign"), archive,
                         text_in(json, "release"), text_in(json, "software"), text_in(json, "worlds"),
                         text_in(json, "conditions"), number_in(json, "seed"), hex_in(json, "plan_hash"), 0,
                         number_in(json, "planned_runs"), "", flag_in(json, "fresh_seed"), false,
                         text_in(json, "agents"), LogLine{hashes_.size(), hashes_.back()}});
  } else if (what == "ends" && known != attempts_.end()) {
    known->ended_utc = text_in(json, "utc");
    known->runs = number_in(json, "runs");
    known->verdict = text_in(json, "verdict");
  } else {
    ++broken_lines_;
  }
}

LogLine AttemptLedger::begin(const Attempt& attempt, bool overwrites) {
  return append_after(path_, [&](std::uint64_t before) {
    const Json json{{"attempt", "begins"},
                    {"id", attempt.id},
                    {"begun_utc", attempt.begun_utc},
                    {"campaign", attempt.campaign},
                    {"agents", attempt.agents},
                    {"archive", attempt.archive},
                    {"release", attempt.release},
                    {"software", attempt.software},
                    {"worlds", attempt.worlds},
                    {"conditions", attempt.conditions},
                    {"plan_hash", hex_text(attempt.plan_hash)},
                    {"seed", attempt.seed},
                    {"fresh_seed", attempt.fresh_seed},
                    {"planned_runs", attempt.planned_runs},
                    {"overwrites", overwrites},
                    {kAfter, hex_text(before)}};
    return json_text(json);
  });
}

void AttemptLedger::end(const Attempt& attempt) {
  append_after(path_, [&](std::uint64_t before) {
    const Json json{{"attempt", "ends"},    {"id", attempt.id},           {"utc", utc_now()},
                    {"runs", attempt.runs}, {"verdict", attempt.verdict}, {kAfter, hex_text(before)}};
    return json_text(json);
  });
}

std::string default_ledger(const std::string& archive_path) {
  return (std::filesystem::path(archive_path).parent_path() / "attempts.jsonl").string();
}

namespace {

// Its bounds hold for one number of replicates: the same worlds with another number are another attempt.
bool has_fixed_gate(const Json& plan) {
  const auto gates = plan.find("gates");
  if (gates == plan.end() || !gates->is_array()) return false;
  return std::ranges::any_of(*gates, [](const auto& gate) {
    return gate.is_object() && gate.value("method", "") == name_of(GateMethod::Fixed);
  });
}

// What stays of a plan when other software is tried under it, in worlds of its own.
Json conditions_of(Json plan) {
  if (!plan.is_object()) return plan;
  for (const char* key : {"seed", "agent_config", "limits", "keep"}) plan.erase(key);
  if (plan.contains("factors") && plan["factors"].is_object()) plan["factors"].erase("agents");
  if (plan.contains("gates") && plan["gates"].is_array()) {
    for (auto& gate : plan["gates"]) {
      if (!gate.is_object()) continue;
      gate.erase("name");
      gate.erase("agent");
    }
  }
  return plan;
}

}  // namespace

Attempt attempt_of(const CampaignRecord& campaign) {
  Attempt attempt;
  attempt.campaign = campaign.name;
  attempt.software = hex_text(name_hash(campaign.engine.program_sha256 + "\n" + campaign.engine.libraries));
  Json plan = read_json(campaign.plan_json);
  if (plan.is_object()) {
    plan.erase("name");
    if (!has_fixed_gate(plan)) plan.erase("replicates");
  }
  attempt.worlds = hex_text(name_hash(plan.is_object() ? json_text(plan) : campaign.plan_json));
  attempt.conditions = hex_text(name_hash(json_text(conditions_of(std::move(plan)))));
  attempt.agents = joined(campaign.agents_under_test);
  attempt.seed = campaign.seed;
  attempt.plan_hash = campaign.plan_hash;
  return attempt;
}

}  // namespace fleetproof
