#include "campaign/workers/disturbance.hpp"

#include <malloc.h>
#include <sys/resource.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

#include "core/base/random.hpp"

namespace fleetproof {
namespace {

// Sizes that objects, nodes and small arrays have. Enough blocks of each that a run does not use them up.
constexpr std::uint32_t kGrain = 16, kSizes = 64, kBlocksPerSize = 64;
constexpr std::size_t kStackBytes = std::size_t{256} << 10;

std::uint64_t mixed(std::uint64_t key) { return Draws(key, 0x4155'4449).next(); }

[[gnu::noinline]] void paint_stack(unsigned char byte) {
  std::array<unsigned char, kStackBytes> below;
  below.fill(byte);
  asm volatile("" : : "r"(below.data()) : "memory");  // or the compiler would leave the fill out
}

}  // namespace

void Disturbance::renew(std::uint64_t key, Fill fill) {
  const std::uint64_t bits = mixed(key);
  const int byte = 1 + static_cast<int>(bits % 255);
  ::mallopt(M_PERTURB, fill == Fill::All ? byte : 0);
  scatter_heap(bits, byte);
  rlimit stack{};
  if (::getrlimit(RLIMIT_STACK, &stack) == 0 && stack.rlim_cur >= 8 * kStackBytes)
    paint_stack(static_cast<unsigned char>(byte));
}

// Blocks of all sizes in a drawn order; then every second of them goes back in another drawn order. `malloc` hands out
// again what was freed, so that two objects made one after the other lie in any order and far apart.
void Disturbance::scatter_heap(std::uint64_t key, int byte) {
  between_.clear();
  Draws draws(key);
  std::vector<std::unique_ptr<char[]>> blocks(std::size_t{kSizes} * kBlocksPerSize);
  for (auto& block : blocks) {
    const std::size_t size = kGrain * (1 + draws.below(kSizes));
    block.reset(new char[size]);
    std::memset(block.get(), byte, size);
  }
  for (std::uint32_t last = static_cast<std::uint32_t>(blocks.size()); last > 1; --last)
    std::swap(blocks[last - 1], blocks[draws.below(last)]);
  for (std::size_t i = 0; i < blocks.size(); i += 2) {
    between_.push_back(std::move(blocks[i + 1]));
    blocks[i].reset();
  }
}

}  // namespace fleetproof
