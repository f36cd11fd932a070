#include "core/engine/agent_caller.hpp"

#include <string>

#include "core/engine/agv_controller.hpp"
#include "core/engine/call_tape.hpp"
#include "core/engine/controller_table.hpp"
#include "core/engine/fleet_software.hpp"
#include "core/engine/foreign_table.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof {

AgentCaller::AgentCaller(const RunWatch& watch)
    : counter_(watch),
      tape_(watch.play.empty() ? watch.record : nullptr),
      host_(tape_ != nullptr || watch.foreign != nullptr ? &kForeignHost : &kHost),
      foreign_agents_(watch.foreign != nullptr),
      is_plain_(watch.record == nullptr && watch.play.empty() && watch.foreign == nullptr),
      is_watched_(!is_plain_ || watch.note != nullptr || !watch.known_ends.empty()) {
  if (!watch.play.empty()) {
    player_.emplace(watch.play);
  } else if (host_ == &kForeignHost) {
    if (watch.foreign == nullptr) own_handles_ = std::make_unique<ForeignHandles>();
    foreign_.emplace(watch.foreign != nullptr ? *watch.foreign : *own_handles_);
  }
}

const AgentFailure* AgentCaller::start(const AgentCall& call, void*& agent) {
  return make_otherwise(call, counter_.next(call.agv, call.kind(), call.at), agent);
}

const AgentFailure* AgentCaller::destroy(const AgentCall& call, void* agent) {
  return make_otherwise(call, counter_.next(call.agv, call.kind(), call.at), agent);
}

const AgentFailure* AgentCaller::end_run(const AgentCall& call) {
  void* no_agent = nullptr;
  return make_otherwise(call, counter_.next(call.agv, call.kind(), call.at), no_agent);
}

const AgentFailure* AgentCaller::ask(const AgentCall& question, void* agent) {
  return make_otherwise(question, counter_.next(question.agv, question.kind(), question.at), agent);
}

[[gnu::noinline]] const AgentFailure* AgentCaller::tell_watched(const AgentCall& call, void* agent) {
  const KnownEnd* known = counter_.next(call.agv, call.kind(), call.at);
  return known != nullptr || !is_plain_ ? make_otherwise(call, known, agent) : hear(call.type, *call.event, agent);
}

[[gnu::noinline]] const AgentFailure* AgentCaller::make_otherwise(const AgentCall& call, const KnownEnd* known,
                                                                  void*& agent) {
  if (player_) {
    const auto failure = player_->play(call, agent);
    return failure ? failed(failure->hang, failure->message) : nullptr;
  }
  if (tape_ != nullptr) return record(call, known, agent);
  return known != nullptr ? failed(known->hang, known->message) : own_failure(call, make(call, agent));
}

const AgentFailure* AgentCaller::own_failure(const AgentCall& call, const AgentFailure* otherwise) {
  if (call.controller == nullptr || call.controller->failure == nullptr) return otherwise;
  failure_ = *call.controller->failure;
  return &failure_;
}

const AgentFailure* AgentCaller::record(const AgentCall& call, const KnownEnd* known, void*& agent) {
  const std::uint64_t changes_before = processor_changes();
  tape_->call_begins(call.agv, call.kind());
  if (call.controller != nullptr) call.controller->tape = tape_;
  const AgentFailure* failure =
      known != nullptr ? failed(known->hang, known->message) : own_failure(call, make(call, agent));
  if (call.controller != nullptr) call.controller->tape = nullptr;
  if (processor_changes() > changes_before) tape_->processor_changed();
  if (failure != nullptr) {
    tape_->call_failed(failure->hang, failure->message);
  } else {
    if (call.is_question() && *call.question.knows) tape_->fault_is_known();
    tape_->call_returned();
  }
  return failure;
}

std::uint64_t AgentCaller::processor_changes() const {
  if (player_) return player_->processor_changes();
  return foreign_ ? foreign_->processor_changes() : 0;
}

const AgentFailure* AgentCaller::make_foreign(const AgentCall& call, void*& agent) {
  if (call.is_run_end) {
    const AgentFailure* failure = reach(call, nullptr, agent);
    foreign_->look_at_processor();
    return failure;
  }
  fp_controller* handle = call.is_start() ? foreign_->lend(call.agv, call.controller) : nullptr;
  const AgentFailure* failure = nullptr;
  {
    const ForeignCalls::UnderWay under_way(*foreign_, call.agv);
    failure = reach(call, handle, agent);
  }
  const bool is_gone = call.is_end() || (call.is_start() && agent == nullptr);
  if (!is_gone) return failure;
  const std::string fault = foreign_->take_back(call.agv);
  return failure != nullptr || fault.empty() ? failure : failed(false, fault);
}

const AgentFailure* AgentCaller::reach(const AgentCall& call, fp_controller* handle, void*& agent) {
  if (call.is_start()) return create_and_start(call, handle, agent);
  if (call.is_question()) return guarded([&] { *call.question.knows = knows_fault(call.type, call.question.word); });
  if (call.event != nullptr) return hear(call.type, *call.event, agent);
  if (const fp_bridge* bridge = bridge_of(call.type); call.is_run_end)
    return guarded([&] { bridge->run_ends(bridge->own); });
  try {
    call.type.destroy(agent);
    return nullptr;
  } catch (...) {
    return failed(false, "exception in destroy()");
  }
}

const AgentFailure* AgentCaller::create_and_start(const AgentCall& call, fp_controller* handle, void*& agent) {
  std::string why_not;
  call.controller->why_not = &why_not;
  const AgentFailure* failure = guarded([&] { agent = create_agent(call.type, host_, handle, call.briefing); });
  call.controller->why_not = nullptr;
  if (failure != nullptr) return failure;
  if (call.controller->failure != nullptr) {
    if (tape_ != nullptr && agent != nullptr) tape_->agent_created();
    return nullptr;  // it has said so itself
  }
  if (agent == nullptr) return failed(false, "create() returned null" + (why_not.empty() ? "" : ": " + why_not));
  if (tape_ != nullptr) tape_->agent_created();
  return hear(call.type, *call.event, agent);
}

// An agent may throw a text of any length. What is filed are its first 200 characters, which are at most 800 bytes.
[[gnu::noinline]] const AgentFailure* AgentCaller::failed(bool hang, std::string_view message) {
  failure_ = {hang, std::string(message.substr(0, 1024))};
  return &failure_;
}

void AgentCaller::finish() const {
  if (player_) player_->finish();
}

}  // namespace fleetproof
