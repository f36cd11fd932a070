// A claim without gates is judged by those that every fleet has to meet.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/support/program.hpp"

namespace fleetproof::default_gates_test {
namespace {

class DefaultGates : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::filesystem::copy_file(FLEETPROOF_FAULTY_AGENT, path("faulty.so"));
  }
  // The verdict of each end point that is judged for this agent; "" is the exit code.
  std::map<std::string, std::string> verdicts(const std::string& agents, const std::string& agent, int replicates,
                                              const std::string& more = "") {
    write("c.toml", fmt::format("replicates = {}\n{}[factors]\nagents = [{}]\nlayouts = [\"aisle-grid\"]\n"
                                "fleet_sizes = [4]\nloss = [0.0, 0.4]\ndelay_s = [1]\n",
                                replicates, more, agents));
    std::map<std::string, std::string> found;
    found[""] = std::to_string(run("run c.toml --db c.db --overwrite").exit_code);
    const auto report = nlohmann::json::parse(run("report c.db --format json").out);
    for (const auto& gate : report.at("gates")) {
      if (gate.at("agent") == agent) found[gate.at("end_point")] = gate.at("verdict");
    }
    return found;
  }
};

std::string faulty(const std::string& kind) {
  return fmt::format("{{ file = \"faulty.so\", name = \"{0}\", config = \"{0}\" }}", kind);
}

struct Fault {
  std::string kind, end_point;
};

TEST_F(DefaultGates, RefuteAnAgentThatIsSafeAndDoesNotGetItsWorkDone) {
  for (const auto& [kind, end_point] : {Fault{"stop", "deadlock"}, Fault{"starve", "starvation"},
                                        Fault{"slow", "throughput"}, Fault{"misplace", "wrong-load"}}) {
    const auto found = verdicts(faulty(kind), kind, 20);
    EXPECT_EQ(found.at(""), "1") << kind;
    EXPECT_EQ(found.at(end_point), "violated") << kind;
    EXPECT_EQ(found.at("violation"), "not demonstrated") << kind << ": no run broke it, and 20 worlds are few";
  }
}

TEST_F(DefaultGates, FindNothingAgainstSoundSoftware) {
  const auto found = verdicts(faulty("sound"), "sound", 20);
  EXPECT_EQ(found.at(""), "4");
  for (const auto& [end_point, verdict] : found)
    EXPECT_THAT(verdict, testing::AnyOf("not demonstrated", "demonstrated", "4")) << end_point;
  EXPECT_EQ(found.size(), 9U) << "eight gates";
}

TEST_F(DefaultGates, BindTheSoftwareUnderTestAndNoReferenceAgentBesideIt) {
  const std::string both = faulty("sound") + ", \"reckless\"";
  EXPECT_EQ(verdicts(both, "sound", 4).at(""), "4") << "reckless breaks the distance in every run";
  EXPECT_EQ(verdicts(both, "reckless", 4).size(), 1U) << "it has no gates";
  const auto candidate = verdicts("\"hull-lock\", { agent = \"reckless\", role = \"candidate\" }", "reckless", 4);
  EXPECT_EQ(candidate.at(""), "1");
  EXPECT_EQ(candidate.at("violation"), "violated");
  const std::string gate = "default_gates = true\n[[gate]]\nname = \"g\"\nagent = \"reckless\"\nkind = \"none\"\n";
  EXPECT_EQ(verdicts(both, "reckless", 4, gate).at(""), "4") << "its gate is told and does not decide";
  EXPECT_EQ(verdicts(both, "reckless", 4, gate).at("violation"), "violated");
}

// In a second nobody can do anything: that is no fault, and no evidence.
TEST_F(DefaultGates, RunsThatAreTooShortForWorkDemonstrateNothing) {
  const auto found = verdicts("\"hull-lock\"", "hull-lock", 400, "horizon_s = 1\n");
  EXPECT_EQ(found.at(""), "4");
  EXPECT_EQ(found.at("violation"), "not demonstrated");
  EXPECT_EQ(found.count("throughput"), 0U);
}

TEST_F(DefaultGates, CanBeLeftOut) {
  const auto found = verdicts("\"reckless\"", "reckless", 2, "default_gates = false\n");
  EXPECT_EQ(found.at(""), "4");
  EXPECT_EQ(found.size(), 1U);
}

// A patience that is shorter than a leg takes; legs of a quarter of an hour and turns of twenty minutes; both.
TEST_F(DefaultGates, AccuseNoSoftwareThatGetsOnOfALivelock) {
  const std::string slow =
      "[[vehicle]]\nspeed_mps = 0.01\nacceleration_mps2 = 0.001\ndeceleration_mps2 = 0.001\nturn_speed_radps = 0.002\n";
  for (const auto& [first, vehicle] : {std::pair<std::string, std::string>{"stuck_after_s = 1\n", ""},
                                       {"horizon_s = 7200\n", slow},
                                       {"stuck_after_s = 1\nhorizon_s = 7200\n", slow}}) {
    write("c.toml", "replicates = 6\n" + first +
                        "[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\", \"loop-spurs\", "
                        "\"corridor-sidings\"]\nfleet_sizes = [1]\n" +
                        vehicle);
    ASSERT_EQ(run("run c.toml --db c.db --overwrite").exit_code, 4);
    const SQLite::Database db(path("c.db"));
    SQLite::Statement accused(db, "SELECT count(*) FROM v1_incidents WHERE kind = 'livelock'");
    ASSERT_TRUE(accused.executeStep());
    EXPECT_EQ(accused.getColumn(0).getInt(), 0) << first << vehicle;
  }
}

// A floor that nobody wrote is told with its value, and how it came about: a plant decides it.
TEST_F(DefaultGates, TheFloorStandsAtTheHead) {
  const auto page = [&](const std::string& more) {
    verdicts("\"hull-lock\"", "hull-lock", 2, more);
    return std::regex_replace(run("report c.db").out, std::regex("\\s+"), " ");
  };
  const std::string usual = page("");
  EXPECT_THAT(usual,
              testing::ContainsRegex("The floor of throughput was not written in the campaign. By default it is "
                                     "[0-9.]+ transports .orders. per AGV-hour: a twentieth of the [0-9.]+ that an "
                                     "AGV alone in these warehouses would do; the campaign orders 30."));
  EXPECT_THAT(usual, testing::Not(testing::HasSubstr("what is easier here"))) << "a default is no easier value";
  EXPECT_THAT(page("[world]\ntransports_per_agv_hour = 2\n"),
              testing::HasSubstr("By default it is 1 transports (orders) per AGV-hour: half of the 2 that the campaign "
                                 "orders."));
  EXPECT_THAT(page("[world]\ntransports_per_agv_hour = 0\n"),
              testing::HasSubstr("The default gates ask for no throughput"));
  const std::string slow = page("[[vehicle]]\nspeed_mps = 0.02\n");
  EXPECT_THAT(slow,
              testing::HasSubstr("gate.min_transports_per_agv_hour of the default gates (not written in the campaign) "
                                 "= 0.0"))
      << "it is below 0.1";
  EXPECT_THAT(slow, testing::HasSubstr("By default it is 0.0"));
  EXPECT_THAT(page("[[gate]]\nagent = \"hull-lock\"\nmin_transports_per_agv_hour = 0.05\n"),
              testing::AllOf(testing::Not(testing::HasSubstr("By default it is")),
                             testing::HasSubstr("gate.min_transports_per_agv_hour = 0.05")));
}

// Fallen loads lie in the way, and no control software is told of them.
TEST_F(DefaultGates, BlameNobodyForWhatNoSoftwareIsToldOf) {
  const auto found =
      verdicts("\"hull-lock\"", "hull-lock", 30,
               "seed = 5\nhorizon_s = 300\n[faults]\nload_drops_per_transport = 0.5\nload_lies_s = 200\n");
  for (const auto& [end_point, verdict] : found) EXPECT_NE(verdict, "violated") << end_point;
  EXPECT_EQ(found.at(""), "4");
  const std::string page = std::regex_replace(run("report c.db").out, std::regex("\n +"), " ");
  EXPECT_THAT(page, testing::HasSubstr("No control software is told of such bodies"));
  EXPECT_THAT(page, testing::HasSubstr("broke the safety distance of 0.10 m in 0 of 30 worlds"));
  const auto report = nlohmann::json::parse(run("report c.db --format json").out);
  std::uint64_t contacts = 0;
  for (const auto& cell : report.at("cells")) {
    EXPECT_EQ(cell.at("violating_runs"), 0);
    contacts += cell.at("contact_runs").get<std::uint64_t>();
  }
  EXPECT_GT(contacts, 10U) << "the test is about something";
  for (const auto& group : report.at("failure_groups")) EXPECT_NE(group.at("before"), "no injected fault");
}

}  // namespace
}  // namespace fleetproof::default_gates_test
