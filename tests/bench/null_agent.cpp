#include "tests/bench/null_agent.hpp"

#include <array>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"

namespace fleetproof {
namespace {

constexpr std::int64_t kPeriod_ns = 300'000'000;

class NullAgent {
 public:
  NullAgent(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle), next_ns_(kPeriod_ns * (briefing.self % 8) / 8) {}

  void on_event(const fp_event& event) {
    if (event.kind == FP_EVENT_START) controller_.set_timer(0, next_ns_);
    if (event.kind == FP_EVENT_TIMER) {
      controller_.broadcast(std::array<std::byte, 64>{});
      controller_.set_timer(0, next_ns_ += kPeriod_ns);
    }
    controller_.drain_inbox([](std::uint32_t, std::span<const std::byte>) {});
  }

 private:
  agents::Controller controller_;
  std::int64_t next_ns_;
};

}  // namespace

const fp_agent_type kNullAgent = agents::agent_type<NullAgent>(
    "null", "sends and listens", [](const fp_host* host, fp_controller* handle, const fp_briefing* briefing) -> void* {
      return new NullAgent(*host, handle, *briefing);
    });

}  // namespace fleetproof
