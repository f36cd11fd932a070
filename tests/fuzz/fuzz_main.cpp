#include <cstddef>
#include <cstdint>
#include <string_view>

#include "readers.hpp"

namespace {

// One accepted input in eight is written and read again as well. A function of the bytes, so that a finding is found
// again.
fleetproof::fuzz::Depth depth_for(std::string_view bytes) {
  std::uint32_t hash = 2166136261U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return (hash >> 16) % 8 == 0 ? fleetproof::fuzz::Depth::WrittenToo : fleetproof::fuzz::Depth::Judged;
}

}  // namespace

// What libFuzzer calls: whatever leaves it other than by returning is a finding.
extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                                                             std::size_t size) {
  static const auto& reader = fleetproof::fuzz::reader(FLEETPROOF_FUZZED_READER);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  reader.accepts(bytes, depth_for(bytes));
  return 0;
}
