#include "campaign/batch/same_campaign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/plan/plan_text.hpp"
#include "core/base/error.hpp"
#include "core/base/json_text.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kDifferencesTold = 5;

// What the engine of this session is, without the engines before it.
std::string_view own_libraries(const EngineIdentity& engine) {
  const std::string_view libraries = engine.libraries;
  return libraries.substr(0, libraries.find(kEngineBegun));
}

std::string begun_by(const EngineIdentity& engine) {
  const std::string_view libraries = engine.libraries;
  const auto earlier = libraries.find(kEngineBegun);
  return fmt::format("{}fleetproof {} sha256 {} ({}; {}){}", kEngineBegun, engine.version, engine.program_sha256,
                     engine.compiler, own_libraries(engine),
                     earlier == std::string_view::npos ? "" : libraries.substr(earlier));
}

bool has_fixed_gate(const CampaignRecord& campaign) {
  return std::ranges::any_of(parse_plan(campaign.plan_json).gates,
                             [](const GateRecord& gate) { return gate.method == GateMethod::Fixed; });
}

std::string short_text(const SortedJson& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = json_text(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace

std::string plan_differences(const CampaignRecord& stored, const CampaignRecord& now) {
  // Read and written again: a key that an older version did not know has its default.
  const SortedJson before = read_sorted_json(plan_text(parse_plan(stored.plan_json))).flatten();
  const SortedJson after = read_sorted_json(now.plan_json).flatten();
  std::string text;
  std::size_t count = 0;
  const auto differs = [&](const std::string& key, const std::string& was, const std::string& is) {
    if (key == "/replicates") return;
    if (++count <= kDifferencesTold)
      text += fmt::format("{}plan{}: stored {}, now {}", count > 1 ? "; " : "", key, was, is);
  };
  for (const auto& [key, value] : before.items()) {
    if (!after.contains(key)) {
      differs(key, short_text(value), "nothing");
    } else if (after[key] != value) {
      differs(key, short_text(value), short_text(after[key]));
    }
  }
  for (const auto& [key, value] : after.items()) {
    if (!before.contains(key)) differs(key, "nothing", short_text(value));
  }
  if (count > kDifferencesTold) text += fmt::format("; and {} more", count - kDifferencesTold);
  return text;
}

std::string engine_differences(const EngineIdentity& stored, const EngineIdentity& now) {
  std::string text;
  const auto compare = [&](std::string_view what, std::string_view was, std::string_view is) {
    if (was != is) text += fmt::format("{}{}: stored {}, now {}", text.empty() ? "" : "; ", what, was, is);
  };
  compare("version", stored.version, now.version);
  compare("program sha256", stored.program_sha256, now.program_sha256);
  compare("compiler", stored.compiler, now.compiler);
  compare("flags", stored.flags, now.flags);
  compare("libraries and plug-ins", own_libraries(stored), own_libraries(now));
  return text;
}

namespace {

// Plug-ins stand behind the libraries.
bool differ_only_in_plugins(EngineIdentity stored, EngineIdentity now) {
  for (EngineIdentity* engine : {&stored, &now}) {
    const std::string_view own = own_libraries(*engine);
    engine->libraries = std::string(own.substr(0, own.find(", plug-in ")));
  }
  return engine_differences(stored, now).empty();
}

}  // namespace

bool has_one_engine(const EngineIdentity& stored, const EngineIdentity& now) {
  return engine_differences(stored, now).empty() && !has_several_programs(stored);
}

void require_same_campaign(const std::string& path, const CampaignRecord& stored, CampaignRecord& now,
                           bool allow_drift) {
  if (const auto differences = plan_differences(stored, now); !differences.empty()) {
    throw InputError(path, fmt::format("this file holds runs of another campaign ({}); give another name with --db, or "
                                       "--overwrite to begin again",
                                       differences));
  }
  if (now.replicates < stored.replicates) {
    throw InputError(path, fmt::format("this file holds a campaign of {} replicates, and {} are asked for; a campaign "
                                       "grows and never shrinks",
                                       stored.replicates, now.replicates));
  }
  if (now.replicates != stored.replicates && now.sampling == "latin-hypercube") {
    throw InputError(path,
                     "a campaign whose factors are drawn by \"latin-hypercube\" cannot grow: every replicate's "
                     "draw depends on their number; give another name with --db");
  }
  if (now.replicates != stored.replicates && has_fixed_gate(now)) {
    throw InputError(
        path, fmt::format("a campaign with a gate of the method \"fixed\" cannot grow: its bounds hold for the {} "
                          "replicates that were planned before run 0, and for no other number; give another "
                          "name with --db, or plan with the method \"any-time\"",
                          stored.replicates));
  }
  if (const auto differences = engine_differences(stored.engine, now.engine); !differences.empty()) {
    if (!allow_drift) {
      throw InputError(
          path, fmt::format("{} wrote this file ({}); its runs and those to come could not be compared; "
                            "--overwrite begins again, another name with --db keeps both, and "
                            "--allow-drift goes on and records the change",
                            differ_only_in_plugins(stored.engine, now.engine) ? "another build of the control software"
                                                                              : "another engine",
                            differences));
    }
    now.engine.libraries += begun_by(stored.engine);
    return;
  }
  now.engine.libraries = stored.engine.libraries;  // with the engines before, if there were any
}

}  // namespace fleetproof
