// Functions with stacks of their own, for blocking.hpp: a thread switches between them and its usual stack. The only
// part of fleetproof that needs Boost.Context.
#pragma once

#include <cxxabi.h>
#include <sys/mman.h>
#include <unistd.h>

#include <boost/context/detail/fcontext.hpp>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <vector>

#ifndef __has_feature
#define __has_feature(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
#define FP_SANITIZES_ADDRESSES
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#elif defined(__SANITIZE_THREAD__) || __has_feature(thread_sanitizer)
#define FP_SANITIZES_THREADS
#include <sanitizer/tsan_interface.h>
#endif

namespace fleetproof::blocking::detail {

// Memory for stacks. Below each lies a page that nobody may touch, so that a stack that grows too far ends the process
// instead of writing elsewhere. Stacks are used again: to map one takes longer than most activations.
template <std::size_t kBytes>
class StackPool {
 public:
  StackPool() = default;
  ~StackPool() {
    for (std::byte* stack : free_) munmap(stack - guard_, guard_ + kBytes);
  }
  StackPool(const StackPool&) = delete;
  StackPool& operator=(const StackPool&) = delete;

  // The pool of this thread: a run stays on its thread.
  [[gnu::visibility("hidden")]] static StackPool& here() {
    static thread_local StackPool pool;
    return pool;
  }

  // The lowest byte of a stack of kBytes.
  std::byte* take() {
    if (!free_.empty()) {
      std::byte* stack = free_.back();
      free_.pop_back();
      return stack;
    }
    void* mapped = mmap(nullptr, guard_ + kBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    std::byte* stack = static_cast<std::byte*>(mapped) + guard_;
    if (mprotect(stack, kBytes, PROT_READ | PROT_WRITE) == 0) return stack;
    munmap(mapped, guard_ + kBytes);
    throw std::bad_alloc();
  }
  void give_back(std::byte* stack) {
#ifdef FP_SANITIZES_ADDRESSES
    __asan_unpoison_memory_region(stack, kBytes);  // an abandoned program leaves its variables there
#endif
    free_.push_back(stack);
  }

 private:
  const std::size_t guard_ = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::vector<std::byte*> free_;
};

// One of the two stacks between which a thread switches, for the sanitizers, which have to know where it is.
struct Side {
  const void* bottom = nullptr;
  std::size_t bytes = 0;
  void* frames = nullptr;  // of the address sanitizer
  void* thread = nullptr;  // of the thread sanitizer: each stack is a thread to it

  // Before a jump from here to there. `for_good`: nobody comes back here.
  void goes_to([[maybe_unused]] const Side& there, [[maybe_unused]] bool for_good = false) {
#if defined(FP_SANITIZES_ADDRESSES)
    __sanitizer_start_switch_fiber(for_good ? nullptr : &frames, there.bottom, there.bytes);
#elif defined(FP_SANITIZES_THREADS)
    __tsan_switch_to_fiber(there.thread, 0);
#endif
  }
  // After a jump from there to here.
  void comes_from([[maybe_unused]] Side& there) {
#if defined(FP_SANITIZES_ADDRESSES)
    __sanitizer_finish_switch_fiber(frames, &there.bottom, &there.bytes);
#endif
  }
};

// A function with a stack of its own. `enter` runs it until it calls `leave` or returns.
class Fiber {
 public:
  using Function = void (*)(void*);

  // Requires: the stack, and what the function uses, outlive the fiber.
  Fiber(std::span<std::byte> stack, Function function, void* argument)
      : function_(function),
        argument_(argument),
        inside_(boost::context::detail::make_fcontext(stack.data() + stack.size(), stack.size(), begin)) {
    inner_.bottom = stack.data();
    inner_.bytes = stack.size();
#ifdef FP_SANITIZES_THREADS
    inner_.thread = __tsan_create_fiber(0);
#endif
  }
  ~Fiber() {
#ifdef FP_SANITIZES_THREADS
    __tsan_destroy_fiber(inner_.thread);
#endif
  }
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  bool is_over() const { return is_over_; }

  // Called by the engine's side. Requires: not is_over().
  void enter() {
    // A thread knows which exceptions it handles. Here each side has its own: a program may wait inside a catch block,
    // and another program must not rethrow what that one has caught.
    void* const handled = abi::__cxa_get_globals();
    HandledExceptions outside;
    std::memcpy(&outside, handled, sizeof outside);
    std::memcpy(handled, &exceptions_, sizeof exceptions_);
#ifdef FP_SANITIZES_THREADS
    outer_.thread = __tsan_get_current_fiber();
#endif
    outer_.goes_to(inner_);
    inside_ = boost::context::detail::jump_fcontext(inside_, this).fctx;
    outer_.comes_from(inner_);
    std::memcpy(&exceptions_, handled, sizeof exceptions_);
    std::memcpy(handled, &outside, sizeof outside);
  }

  // Called by the function. `for_good`: it will not be entered again.
  void leave(bool for_good = false) {
    inner_.goes_to(outer_, for_good);
    outside_ = boost::context::detail::jump_fcontext(outside_, nullptr).fctx;
    inner_.comes_from(outer_);
  }

 private:
  struct HandledExceptions {  // __cxa_eh_globals of the C++ ABI
    void* caught = nullptr;
    unsigned int uncaught_count = 0;
  };

  static void begin(boost::context::detail::transfer_t from) noexcept {
    Fiber& self = *static_cast<Fiber*>(from.data);
    self.outside_ = from.fctx;
    self.inner_.comes_from(self.outer_);
    self.function_(self.argument_);
    self.is_over_ = true;
    self.leave(true);
    std::abort();  // nobody enters it again
  }

  Function function_;
  void* argument_;
  boost::context::detail::fcontext_t inside_, outside_ = nullptr;
  Side inner_, outer_;
  HandledExceptions exceptions_;
  bool is_over_ = false;
};

}  // namespace fleetproof::blocking::detail
