#include "core/engine/foreign_calls.hpp"

#include <utility>

namespace fleetproof {
namespace {

// Its address tells one thread from another.
thread_local const char this_thread = 0;

}  // namespace

bool ForeignHandle::admits() {
  if (caller.load(std::memory_order_relaxed) == &this_thread) [[likely]]
    return true;
  const void* lives_on = thread.load(std::memory_order_relaxed);
  if (lives_on == nullptr) {
    home.late_caller_.store(agv.load(std::memory_order_relaxed), std::memory_order_relaxed);
  } else if (lives_on != &this_thread) {
    called_by_other_thread.store(true, std::memory_order_relaxed);
  }
  return false;
}

ForeignHandle& ForeignHandles::lend(AgvId agv, fp_controller* controller) {
  const std::lock_guard lock(mutex_);
  ForeignHandle* handle = nullptr;
  if (resting_.size() > kMostResting) {
    handle = resting_.front();
    resting_.pop_front();
  } else {
    handle = &all_.emplace_back(*this);
  }
  handle->controller = controller;
  handle->agv.store(agv.value, std::memory_order_relaxed);
  handle->called_by_other_thread.store(false, std::memory_order_relaxed);
  handle->thread.store(&this_thread, std::memory_order_relaxed);
  return *handle;
}

void ForeignHandles::take_back(ForeignHandle& handle) {
  handle.thread.store(nullptr, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  resting_.push_back(&handle);
}

AgvId ForeignHandles::take_late_caller() {
  return AgvId{late_caller_.exchange(AgvId().value, std::memory_order_relaxed)};
}

ForeignCalls::~ForeignCalls() {
  for (ForeignHandle* handle : lent_) {
    if (handle != nullptr) handles_.take_back(*handle);
  }
}

fp_controller* ForeignCalls::lend(AgvId agv, fp_controller* controller) {
  if (lent_.empty() && handles_.changed_processor()) ++processor_changes_;
  if (lent_.size() <= agv.index()) lent_.resize(agv.index() + 1);
  ForeignHandle*& handle = lent_[agv.index()];
  if (handle != nullptr) handles_.take_back(*handle);  // of an agent whose destroy() is not called
  handle = &handles_.lend(agv, controller);
  return reinterpret_cast<fp_controller*>(handle);
}

std::string ForeignCalls::take_back(AgvId agv) {
  ForeignHandle& handle = *std::exchange(lent_[agv.index()], nullptr);
  handles_.take_back(handle);
  if (handle.called_by_other_thread.load(std::memory_order_relaxed))
    return "called its controller from another thread than the one that calls the agent";
  const AgvId late = handles_.take_late_caller();
  if (!late.valid()) return {};
  return "an agent of this software, that of AGV " + std::to_string(late.value) +
         ", called its controller after destroy()";
}

ForeignCalls::UnderWay::UnderWay(ForeignCalls& calls, AgvId agv) : calls_(calls), handle_(*calls.lent_[agv.index()]) {
  handle_.caller.store(&this_thread, std::memory_order_relaxed);
}

ForeignCalls::UnderWay::~UnderWay() {
  handle_.caller.store(nullptr, std::memory_order_relaxed);
  calls_.look_at_processor();
}

void ForeignCalls::look_at_processor() {
  if (has_engine_processor_state()) [[likely]]
    return;
  set_engine_processor_state();
  ++processor_changes_;
}

}  // namespace fleetproof
