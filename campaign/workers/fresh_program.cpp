#include "campaign/workers/fresh_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/personality.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "campaign/plan/plan_text.hpp"
#include "campaign/workers/disturbance.hpp"
#include "campaign/workers/fatal_signals.hpp"
#include "campaign/workers/worker.hpp"
#include "core/base/byte_text.hpp"
#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kCallWord = "take-orders";  // then channel, slots, number of slots, slot
constexpr int kCallWords = 6;
constexpr unsigned long kAskPersonality = 0xffffffff;
constexpr std::size_t kShortestPlugin = 4 + 4 + 1;

void keep_over_exec(int fd) { ::fcntl(fd, F_SETFD, ::fcntl(fd, F_GETFD) & ~FD_CLOEXEC); }

int number_in(const char* word) {
  int value = -1;
  const char* end = word + std::strlen(word);
  const auto [stop, error] = std::from_chars(word, end, value);
  return error == std::errc{} && stop == end ? value : -1;
}

struct Setup {
  CampaignPlan plan;
  std::vector<AgentProgram> plugins;
};

Setup decode_setup(std::string_view bytes) {
  ByteSource source(bytes, "the setup of a worker");
  Setup setup;
  setup.plan = parse_plan(source.text());
  setup.plugins.resize(source.count(kShortestPlugin));
  for (AgentProgram& plugin : setup.plugins) {
    plugin.file = source.text();
    plugin.sha256 = source.text();
    plugin.global_symbols = source.flag();
  }
  source.end();
  return setup;
}

[[noreturn]] void serve(Channel channel, int slots_fd, int count, int slot) {
  answer_failures(channel, [&] {
    const SharedSlots slots(count, slots_fd);
    note_fatal_signals(slots[slot]);
    Channel::Wait state = Channel::Wait::NotYet;
    while (state == Channel::Wait::NotYet) state = channel.wait(std::chrono::hours(1));
    if (state == Channel::Wait::Gone) return;
    const Setup setup = decode_setup(channel.received());
    Disturbance disturbance;
    disturbance.renew(0);
    std::uint64_t own_bytes = mapped_bytes();  // as in a worker of the campaign: before the plug-ins are loaded
    AgentPrograms programs;
    for (const AgentProgram& plugin : setup.plugins) programs.load_unchanged(plugin);
    std::optional<std::uint64_t> before_unlimited;  // what was mapped before the last run, if that had no limit
    take_orders(setup.plan, programs, slots[slot], channel, [&](const RunOrder& order) {
      // What a reference agent leaves mapped does not count against the plug-ins of the runs that follow.
      if (before_unlimited) own_bytes += std::max(mapped_bytes(), *before_unlimited) - *before_unlimited;
      disturbance.renew(order.run_index);
      // Reference agents have no limit in a campaign either: there they run in the main process.
      const bool limited = programs.is_plugin(setup.plan.agent_of_cell(order.run_index).program);
      before_unlimited = limited ? std::nullopt : std::optional(mapped_bytes());
      limit_memory(limited ? setup.plan.limits.memory_mb : 0, own_bytes);
    });
  });
}

}  // namespace

std::string encode_setup(const CampaignPlan& plan, const AgentPrograms& programs) {
  ByteSink sink;
  sink.text(plan_text(plan));
  std::uint32_t count = 0;
  for (const AgentProgram& program : programs.all()) count += program.is_plugin() ? 1 : 0;
  sink.u32(count);
  for (const AgentProgram& program : programs.all()) {
    if (!program.is_plugin()) continue;
    sink.text(program.file);
    sink.text(program.sha256);
    sink.u8(program.global_symbols ? 1 : 0);
  }
  return sink.take();
}

void become_fresh_program(const std::string& program, const SharedSlots& slots, int slot, Channel channel) {
  const int persona = ::personality(kAskPersonality);
  if (persona >= 0) ::personality(static_cast<unsigned long>(persona) & ~static_cast<unsigned long>(ADDR_NO_RANDOMIZE));
  keep_over_exec(channel.fd());
  keep_over_exec(slots.fd());
  const std::string word(kCallWord), channel_word = std::to_string(channel.fd()),
                                     slots_word = std::to_string(slots.fd()),
                                     count_word = std::to_string(slots.count()), slot_word = std::to_string(slot);
  ::execl(program.c_str(), program.c_str(), word.c_str(), channel_word.c_str(), slots_word.c_str(), count_word.c_str(),
          slot_word.c_str(), nullptr);
  const std::string reason = std::strerror(errno);
  answer_failures(channel, [&] {
    throw EngineError(fmt::format("{}: the program of an audit cannot be started: {}", program, reason));
  });
}

void serve_if_called(int argc, const char* const* argv) {
  if (argc != kCallWords || argv[1] != kCallWord) return;
  const int channel = number_in(argv[2]), slots_fd = number_in(argv[3]), count = number_in(argv[4]),
            slot = number_in(argv[5]);
  if (channel < 0 || slots_fd < 0 || slot < 0 || slot >= count || ::fcntl(channel, F_GETFD) < 0) return;
  ::fcntl(channel, F_SETFD, FD_CLOEXEC);
  serve(Channel(channel), slots_fd, count, slot);
}

}  // namespace fleetproof
