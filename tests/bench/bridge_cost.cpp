// What an activation costs through each way in: one small agent, `ticker`, which looks where it is and sets its timer,
// 20 times a second. tests/bench/bridge_table builds its twins and makes the table.
//
//   bridge_cost WAY RUNS      WAY: built-in, a shared object, "lockstep:COMMAND", or one of
//     pipes                   lines go to a process and back with nothing else, as long as those of lockstep
//     replay:FILE:COMMAND     a process gets the lines of a run again, as overheard.py recorded them, from a partner
//                             that does nothing but wait for each answer
//
// CPU time of this process and of those that it has started, which other jobs disturb less than the time on the wall.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/run/program_door.hpp"
#include "core/base/error.hpp"
#include "core/engine/simulation.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kPeriod_ns = 50'000'000;
constexpr std::uint32_t kFleet = 5;
constexpr double kHorizon_s = 60.0;
constexpr std::size_t kLineThere = 230, kLineBack = 55;  // bytes of an event and of an answer, as a run has them

// ---- the agent

struct Ticker {
  const fp_host* host;
  fp_controller* controller;
};

void on_event(void* agent, const fp_event* event) {
  const auto& [host, controller] = *static_cast<const Ticker*>(agent);
  if (event->kind != FP_EVENT_START && event->kind != FP_EVENT_TIMER) return;
  fp_pose pose{};
  host->get_position(controller, &pose);
  host->set_timer(controller, 0, event->now_ns + kPeriod_ns);
}

constexpr fp_agent_type kTicker = {sizeof(fp_agent_type),
                                   FP_ABI_MAJOR,
                                   FP_ABI_MINOR,
                                   FP_DETERMINISTIC,
                                   "ticker",
                                   "looks where it is",
                                   [](const fp_host* host, fp_controller* c, const fp_briefing*) -> void* {
                                     return new Ticker{host, c};
                                   },
                                   on_event,
                                   [](void* agent) { delete static_cast<Ticker*>(agent); },
                                   nullptr,
                                   nullptr};

// ---- the cost

double cpu_s_of(int who) {
  rusage use{};
  ::getrusage(who, &use);
  const auto in_s = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return in_s(use.ru_utime) + in_s(use.ru_stime);
}

// Of processes only those that have been waited for.
double cpu_s() { return cpu_s_of(RUSAGE_SELF) + cpu_s_of(RUSAGE_CHILDREN); }

double wall_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Cost {
  std::uint64_t activations = 0, digest = 0;
  double cpu = 0.0, wall = 0.0;
};

void add_run(const Scenario& scenario, const fp_agent_type& agent, Cost& cost) {
  const Outcome outcome = simulate(scenario, agent, {});
  if (outcome.crash) throw EngineError(outcome.message);
  cost.activations += outcome.counters.activations;
  cost.digest ^= outcome.digest;
}

Cost cost_of(const std::string& way, int runs) {
  WorldSpec spec;
  spec.layout = "aisle-grid";
  spec.fleet_size = kFleet;
  spec.horizon = seconds(kHorizon_s);
  RejectionCounts counts;
  const Scenario scenario = generate_world(spec, 1, counts);
  std::optional<OpenedProgram> program;
  if (way != "built-in") program = open(source_of(way, false), way);
  const fp_agent_type& agent = program ? *program->type : kTicker;
  Cost warm_up, cost;
  add_run(scenario, agent, warm_up);
  const double started_cpu_s = cpu_s(), started_wall_s = wall_s();
  for (int run = 0; run < runs; ++run) add_run(scenario, agent, cost);
  cost.wall = wall_s() - started_wall_s;
  program.reset();  // waits for its process
  cost.cpu = cpu_s() - started_cpu_s;
  cost.digest = warm_up.digest;
  return cost;
}

void move_all(ssize_t (*call)(int, char*, std::size_t), int file, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t moved = call(file, bytes, size);
    if (moved <= 0) ::_exit(0);  // the other end is gone
    bytes += moved;
    size -= static_cast<std::size_t>(moved);
  }
}
ssize_t read_some(int file, char* bytes, std::size_t size) { return ::read(file, bytes, size); }
ssize_t write_some(int file, char* bytes, std::size_t size) { return ::write(file, bytes, size); }

// A child that reads the first pipe and writes the second one.
template <class Serve>
pid_t start(std::array<int, 2>& there, std::array<int, 2>& back, const Serve& serve) {
  if (::pipe(there.data()) != 0 || ::pipe(back.data()) != 0) throw MachineError("no pipe can be made");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(there[1]);
    ::close(back[0]);
    serve();
    ::_exit(127);
  }
  ::close(there[0]);
  ::close(back[1]);
  return child;
}

// One write and one read of each side for each line there and back: what no bridge can save.
Cost cost_of_pipes(std::uint64_t lines) {
  std::array<int, 2> there{}, back{};
  std::array<char, kLineThere> line{};
  const double started_cpu_s = cpu_s(), started_wall_s = wall_s();
  const pid_t child = start(there, back, [&] {
    for (;;) {
      move_all(read_some, there[0], line.data(), kLineThere);
      move_all(write_some, back[1], line.data(), kLineBack);
    }
  });
  for (std::uint64_t i = 0; i < lines; ++i) {
    move_all(write_some, there[1], line.data(), kLineThere);
    move_all(read_some, back[0], line.data(), kLineBack);
  }
  const double spent_wall_s = wall_s() - started_wall_s;
  ::close(there[1]);
  ::waitpid(child, nullptr, 0);
  return {lines, 0, cpu_s() - started_cpu_s, spent_wall_s};
}

void read_line(int file) {
  std::array<char, 4096> room{};
  do {
    const ssize_t count = ::read(file, room.data(), room.size());
    if (count <= 0) throw EngineError("the program ended");
    if (room[static_cast<std::size_t>(count) - 1] == '\n') return;
  } while (true);
}

// A line to the program, or one that it wrote, which is waited for.
struct Overheard {
  bool is_to_program;
  std::string line;
};

Cost cost_of_replay(const std::string& path, const std::string& command, int runs) {
  std::vector<Overheard> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back({line.starts_with('<'), line.substr(1) + "\n"});
  std::array<int, 2> there{}, back{};
  const double started_cpu_s = cpu_s(), started_wall_s = wall_s();
  const pid_t child = start(there, back, [&] {
    ::dup2(there[0], STDIN_FILENO);
    ::dup2(back[1], STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), static_cast<char*>(nullptr));
  });
  Cost cost;
  for (int run = 0; run < runs; ++run) {
    for (auto& [is_to_program, line] : lines) {
      if (is_to_program) {
        move_all(write_some, there[1], line.data(), line.size());
        cost.activations += line.starts_with("{\"event\"") ? 1 : 0;
      } else {
        read_line(back[0]);
      }
    }
  }
  cost.wall = wall_s() - started_wall_s;
  ::close(there[1]);
  ::waitpid(child, nullptr, 0);
  cost.cpu = cpu_s() - started_cpu_s;
  return cost;
}

Cost measure(const std::string& way, int runs) {
  constexpr std::string_view kReplay = "replay:";
  if (way == "pipes") return cost_of_pipes(static_cast<std::uint64_t>(runs) * 6005);
  if (!way.starts_with(kReplay)) return cost_of(way, runs);
  const auto colon = way.find(':', kReplay.size());
  return cost_of_replay(way.substr(kReplay.size(), colon - kReplay.size()), way.substr(colon + 1), runs);
}

}  // namespace
}  // namespace fleetproof

int main(int argc, char** argv) {
  using namespace fleetproof;
  if (argc != 3) return fmt::print("bridge_cost WAY RUNS\n"), 2;
  const int runs = std::atoi(argv[2]);
  const std::string way = argv[1];
  try {
    const Cost cost = measure(way, runs);
    const auto lines = static_cast<double>(cost.activations);
    fmt::print("activations {} cpu_us {:.3f} wall_us {:.3f} runs_per_s {:.1f} digest {:016x}\n", cost.activations,
               1e6 * cost.cpu / lines, 1e6 * cost.wall / lines, runs / cost.cpu, cost.digest);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  }
  return 0;
}
