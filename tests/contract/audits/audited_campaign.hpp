#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.hpp"

namespace fleetproof::test {

// Campaigns with audits, of plug-ins that are not deterministic (unsteady.so) or fail (failing.so).
class AuditedCampaign : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::filesystem::copy_file(FLEETPROOF_UNSTEADY_AGENT, path("unsteady.so"));
    std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  }
  void write_campaign(const std::string& agents, int replicates, double share, const std::string& more = "") const {
    write("c.toml",
          fmt::format("name = \"c\"\nreplicates = {}\nhorizon_s = 60\ndefault_gates = false\n[factors]\nagents = [{}]\n"
                      "layouts = [\"aisle-grid\"]\nfleet_sizes = [3]\nloss = [0.4]\ndelay_s = [2]\n"
                      "[audit]\nshare = {}\n{}",
                      replicates, agents, share, more));
  }
  // What the report says about the audits of each agent.
  std::map<std::string, nlohmann::json> audits(const std::string& archive) const {
    std::map<std::string, nlohmann::json> by_agent;
    const auto report = nlohmann::json::parse(run("report " + archive + " --format json").out);
    for (const auto& audit : report.at("audits")) by_agent[audit.at("agent")] = audit;
    return by_agent;
  }
};

// An agent of a campaign file, named after what makes it unsteady.
inline std::string unsteady(const std::string& kind) {
  return fmt::format("{{ file = \"unsteady.so\", name = \"{0}\", config = \"{0}\" }}", kind);
}
inline std::string failing(const std::string& how) {
  return fmt::format("{{ file = \"failing.so\", name = \"failing\", config = \"{}\" }}", how);
}

}  // namespace fleetproof::test
