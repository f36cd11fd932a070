// What memory holds that nobody wrote, and where it lies, must depend on the key. A process of its own makes each
// observation, because it spoils the heap.
#include "campaign/workers/disturbance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <vector>

#include "tests/support/own_process.hpp"

namespace fleetproof::disturbance_test {
namespace {

constexpr std::uint64_t kKeys = 8;

// Whether all bytes are the same and not zero; zero is what the system gives.
bool is_filled(const volatile unsigned char* bytes, std::size_t count) {
  return bytes[0] != 0 && std::all_of(bytes, bytes + count, [&](unsigned char byte) { return byte == bytes[0]; });
}

// The bytes that fill fresh blocks of this size under the keys; 0 where nothing fills them.
std::set<unsigned char> fills_of_heap(std::size_t size) {
  std::set<unsigned char> fills;
  Disturbance disturbance;
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    disturbance.renew(key);
    const std::unique_ptr<unsigned char[]> block(new unsigned char[size]);
    const volatile unsigned char* bytes = block.get();
    fills.insert(is_filled(bytes, size) ? bytes[0] : 0);
  }
  return fills;
}

// The byte that fills the stack below this function, at most so far; 0: none does.
[[gnu::noinline]] unsigned char fill_of_stack() {
  std::array<unsigned char, std::size_t{128} << 10> below;
  asm volatile("" : : "r"(below.data()) : "memory");  // for the compiler, this may write it
  return is_filled(below.data(), below.size() / 2) ? below[0] : 0;
}

std::set<unsigned char> fills_of_stack() {
  std::set<unsigned char> fills;
  Disturbance disturbance;
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    disturbance.renew(key);
    fills.insert(fill_of_stack());
  }
  return fills;
}

// How two blocks lie that were made one after the other, for every size that objects have.
struct Pairs {
  int ascending = 0, adjacent = 0;
};

Pairs disturbed_pairs(std::uint64_t key) {
  constexpr std::size_t kStep = 16;
  Disturbance disturbance;
  disturbance.renew(key);
  Pairs pairs;
  std::vector<std::unique_ptr<char[]>> blocks;
  blocks.reserve(128);
  for (std::size_t size = kStep; size <= 64 * kStep; size += kStep) {
    const char* first = blocks.emplace_back(new char[size]).get();
    const char* second = blocks.emplace_back(new char[size]).get();
    if (first > second) continue;
    ++pairs.ascending;
    pairs.adjacent += static_cast<std::size_t>(second - first) <= size + kStep ? 1 : 0;
  }
  return pairs;
}

class Disturbances : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer has a heap and a stack of its own";
#endif
  }
};

TEST_F(Disturbances, FillFreshMemoryByTheKey) {
  for (const std::size_t size : {std::size_t{2000}, std::size_t{50'000}, std::size_t{1'000'000}}) {
    const int differing = test::in_own_process([&] {
      const auto fills = fills_of_heap(size);
      return fills.contains(0) ? 0 : static_cast<int>(fills.size());
    });
    EXPECT_GE(differing, 6) << "of 8 keys, blocks of " << size << " bytes";
  }
}

TEST_F(Disturbances, FillTheStackByTheKey) {
  EXPECT_GE(test::in_own_process([] {
              const auto fills = fills_of_stack();
              return fills.contains(0) ? 0 : static_cast<int>(fills.size());
            }),
            6)
      << "of 8 keys";
}

TEST_F(Disturbances, PutBlocksInADrawnOrder) {
  std::set<int> ascending;
  for (std::uint64_t key = 0; key < kKeys; ++key) {
    ascending.insert(test::in_own_process([&] { return disturbed_pairs(key).ascending; }));
    EXPECT_LE(test::in_own_process([&] { return disturbed_pairs(key).adjacent; }), 8) << "of 64 pairs, key " << key;
  }
  EXPECT_GE(*ascending.begin(), 16) << "of 64 pairs";
  EXPECT_LE(*ascending.rbegin(), 48);
  EXPECT_GE(ascending.size(), 3U) << "the order depends on the key";
}

}  // namespace
}  // namespace fleetproof::disturbance_test
