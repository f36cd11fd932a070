// Makes the controller calls of its script, each at its instant. It ignores their results.
#include <algorithm>
#include <span>

#include "core/agents/agent_type.hpp"
#include "core/agents/controller.hpp"

namespace fleetproof::agents {
namespace {

class Scripted {
 public:
  Scripted(const fp_host& host, fp_controller* handle, const fp_briefing& briefing)
      : controller_(host, handle), calls_(briefing.script, briefing.script + briefing.script_count) {
    std::ranges::stable_sort(calls_, {}, &fp_scripted_call::at_ns);
  }

  void on_event(const fp_event& event) {
    if (event.kind != FP_EVENT_START && event.kind != FP_EVENT_TIMER) return;
    while (next_ < calls_.size() && calls_[next_].at_ns <= event.now_ns) play(calls_[next_++]);
    if (next_ < calls_.size()) controller_.set_timer(0, calls_[next_].at_ns);
  }

 private:
  void play(const fp_scripted_call& call) {
    switch (call.action) {
      case FP_CALL_MOVE:
        controller_.move(call.segment);
        break;
      case FP_CALL_PICK:
        controller_.pick(call.segment);
        break;
      case FP_CALL_DROP:
        controller_.drop(call.segment);
        break;
      case FP_CALL_PARK:
        controller_.park(call.segment);
        break;
      case FP_CALL_CHARGE:
        controller_.charge(call.segment);
        break;
      default:
        break;
    }
  }

  Controller controller_;
  std::vector<fp_scripted_call> calls_;
  std::size_t next_ = 0;
};

}  // namespace

constinit const fp_agent_type kScripted =
    agent_type<Scripted>("scripted", "plays the controller calls that the scenario lists",
                         [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) -> void* {
                           return new Scripted(*host, controller, *briefing);
                         });

}  // namespace fleetproof::agents
