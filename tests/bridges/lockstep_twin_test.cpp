// A program in a process of its own has the digest of the same program in C.
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/bridges/lockstep/line_writer.hpp"
#include "core/bridges/wrapped/wrapped_program.hpp"
#include "core/engine/simulation.hpp"
#include "core/sdk/agent_table.hpp"
#include "tests/bridges/lockstep_bench.hpp"

namespace fleetproof::lockstep_twin_test {
namespace {

std::string hex(const void* bytes, std::size_t size) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = static_cast<const unsigned char*>(bytes)[i];
    text += {kDigits[byte >> 4U], kDigits[byte & 0xfU]};
  }
  return text;
}

std::string bits_of(double number) {
  std::array<unsigned char, sizeof number> bytes{};
  std::memcpy(bytes.data(), &number, sizeof number);
  std::ranges::reverse(bytes);
  return hex(bytes.data(), bytes.size());
}

// The twin of programs/twin.py.
struct Twin {
  const fp_host& host;
  fp_controller* c;
  const fp_briefing& briefing;
  std::uint32_t station;

  std::string look() const {
    fp_pose pose{};
    double level = 0.0;
    std::uint32_t word = 0;
    host.now_ns(c);
    host.get_position(c, &pose);
    host.get_battery_level(c, &level);
    host.is_loaded(c, &word);
    host.get_load(c, &word);
    return bits_of(pose.x_m) + bits_of(level);
  }
  void read() const {
    fp_message message{};
    message.struct_size = sizeof message;
    while (host.get_message(c, &message) == FP_OK)
      host.log(c, (std::to_string(message.sender) + " " + hex(message.bytes, message.size)).c_str());
  }
  void on_event(const fp_event& event) {
    if (event.kind == FP_EVENT_START) station = briefing.start_station;
    const std::string said = look();
    read();
    const std::string sent = said + std::string("\xff\0\"\\", 4);
    const fp_message_fields fields{sizeof fields, "SAID", "all", "7", nullptr, "\xc3\xa9"};
    host.describe_message(c, &fields);
    host.send_broadcast(c, sent.data(), static_cast<std::uint32_t>(sent.size()));
    host.sometimes(c, "woke");
    host.set_timer(c, 1, event.now_ns + 700'000'000);
    host.declare_state(c, "wandering");
    std::uint32_t action = 0;
    host.get_action(c, &action);
    host.keep(c, 7, said.data(), static_cast<std::uint32_t>(said.size()));
    if (event.kind == FP_EVENT_ORDER) host.works_on(c, briefing.self, event.order_id);
    if (action != FP_IDLE) return;
    const std::uint64_t draw = host.random(c, 3, static_cast<std::uint64_t>(event.now_ns));
    const fp_station& here = *fp_station_at(briefing.map, station);
    const fp_lane& lane = *fp_lane_at(briefing.map, here.lanes[draw % here.lane_count]);
    (draw % 3 != 0 ? host.move : host.pick)(c, lane.segment);
    station = lane.to;
  }
};

const fp_agent_type kTwin = {sizeof(fp_agent_type),
                             FP_ABI_MAJOR,
                             FP_ABI_MINOR,
                             FP_DETERMINISTIC | FP_SERVES_COMPUTERS,
                             "twin",
                             "",
                             [](const fp_host* host, fp_controller* c, const fp_briefing* briefing) -> void* {
                               return new Twin{*host, c, *briefing, briefing->start_station};
                             },
                             [](void* agent, const fp_event* event) { static_cast<Twin*>(agent)->on_event(*event); },
                             [](void* agent) { delete static_cast<Twin*>(agent); },
                             [](const char* word) -> std::uint32_t { return std::string_view(word) == "deaf" ? 1 : 0; },
                             nullptr};

Scenario restless(double call_cost_s) {
  Scenario scenario = test::row_of_tens({0, 3}, 60.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)}};
  scenario.faults = {test::fault(Fault::Kind::Restart, 20.3, 2.0), test::fault(Fault::Kind::Breakdown, 41.1, 3.0)};
  scenario.radio.loss = 0.2;
  scenario.radio.delay_s = 0.3;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  scenario.contact_stops = false;
  scenario.agent_clock.call_cost_s = call_cost_s;
  return scenario;
}

TEST(Lockstep, HasTheTraceOfItsTwinWhateverACallCosts) {
  const lockstep::LockstepProgram program(test::python("twin.py"));
  EXPECT_EQ(program.type().flags, kTwin.flags);
  for (const double call_cost_s : {0.0, 0.003, 0.02}) {
    SCOPED_TRACE(call_cost_s);
    const Scenario scenario = restless(call_cost_s);
    const test::ToldRun twin = test::watched(scenario, kTwin, {});
    EXPECT_GT(twin.outcome.counters.drives, 3U);
    EXPECT_GT(twin.outcome.counters.received, 50U);
    test::expect_same(test::run_of(program, scenario), twin);
    const test::ToldRun recorded = test::recorded(scenario, program.type());
    test::expect_same(recorded, twin);
    test::expect_same(test::played(scenario, recorded.tape), twin);
  }
}

// What is disturbed around a program does not depend on its way in.
TEST(Lockstep, HasTheTraceOfItsTwinInsideEachFault) {
  const lockstep::LockstepProgram program(test::python("twin.py"));
  const Scenario scenario = restless(0.003);
  for (const char* words : {"drop every 3rd message", "repeat every 3rd message", "stall 3 s every 9 s",
                            "forget memory every 13 s", "position 2 s old", "clock 5 s off"}) {
    SCOPED_TRACE(words);
    const wrapped::Fault fault = wrapped::parse_fault(words);
    const test::ToldRun twin = test::watched(scenario, wrapped::WrappedProgram(kTwin, fault).type(), {});
    EXPECT_NE(twin.outcome, test::watched(scenario, kTwin, {}).outcome);
    test::expect_same(test::watched(scenario, wrapped::WrappedProgram(program.type(), fault).type(), {}), twin);
  }
}

// Lines do not grow with what a program leaves unread, however it reads, and whatever is lost or doubled before it.
TEST(Lockstep, TellsEachMessageOnce) {
  const auto told_and_read = [](const std::string& how, const std::string& fault) {
    const lockstep::LockstepProgram program(test::python("reader.py", how));
    const wrapped::WrappedProgram inside(program.type(), wrapped::parse_fault(fault.empty() ? "clock 1 s off" : fault));
    const fp_agent_type& type = fault.empty() ? program.type() : inside.type();
    std::vector<std::string> told, read;
    for (const std::string& line : test::logged(test::watched(test::row_of_tens({0, 3}, 40.0), type, {}))) {
      if (line.starts_with("0 told ")) told.push_back(line.substr(7));
      if (line.starts_with("0 read ")) read.push_back(line.substr(7));
    }
    return std::pair(told, read);
  };
  std::vector<std::string> all, thirds_missing, thirds_doubled;
  for (int i = 1; i <= 40; ++i) {
    all.push_back(std::to_string(i));
    if (i % 3 != 0) thirds_missing.push_back(all.back());
    thirds_doubled.insert(thirds_doubled.end(), i % 3 == 0 ? 2 : 1, all.back());
  }
  for (const std::string how : {"", "all"}) {
    SCOPED_TRACE(how);
    EXPECT_EQ(told_and_read(how, "").first, all);
    EXPECT_EQ(told_and_read(how, "drop every 3rd message").first, thirds_missing);
    EXPECT_EQ(told_and_read(how, "repeat every 3rd message").first, thirds_doubled);
  }
  const auto [told, read] = told_and_read("", "");
  for (std::size_t i = 0; i < read.size(); ++i)
    EXPECT_TRUE(read[i] == told[i] || read[i] == "unasked") << "oldest first";
  EXPECT_GT(read.size(), 10U);
}

// Every kind of line of a run in which no order is withdrawn, no named fault strikes and no call is refused.
TEST(Lockstep, SpeaksAsItsSchemaSays) {
  const std::string file = testing::TempDir() + "overheard." + std::to_string(::getpid());
  const std::string script = FLEETPROOF_SOURCE_DIR "/tests/bridges/programs/overheard.py";
  {
    const lockstep::LockstepProgram program("python3 -B '" + script + "' record '" + file + "' " +
                                            test::python("twin.py"));
    test::expect_same(test::run_of(program, restless(0.003)), test::watched(restless(0.003), kTwin, {}));
  }
  const std::string said = file + ".said";
  EXPECT_EQ(std::system(("python3 -B '" + script + "' check '" + file + "' > '" + said + "'").c_str()), 0);
  std::ifstream counted(said);
  std::string kinds;
  std::getline(counted, kinds);
  EXPECT_EQ(kinds,
            "<action_done <answer <bye <destroy <hello <message <order <run <start <timer >ask >bye >calls >hello");
  for (const std::string& name : {file, said}) std::filesystem::remove(name);
}

// Also -0, which many readers take for an integer when it has no point.
TEST(Lockstep, WritesNumbersThatReadBackAsTheSameBits) {
  for (const double number : {0.0, -0.0, 0.1, -1.5, 3.0, 5e-324, 1.7976931348623157e308}) {
    std::string line;
    lockstep::LineWriter(line).value(number);
    EXPECT_EQ(bits_of(nlohmann::json::parse(line).get<double>()), bits_of(number)) << line;
  }
}

TEST(Lockstep, KnowsTheFaultsOfItsHello) {
  const lockstep::LockstepProgram program(test::python("twin.py"));
  EXPECT_TRUE(knows_fault(program.type(), "deaf"));
  EXPECT_FALSE(knows_fault(program.type(), "blind"));
}

}  // namespace
}  // namespace fleetproof::lockstep_twin_test
