#include <cstddef>
#include <cstdint>

#include "readers.hpp"

// What libFuzzer calls: whatever leaves it other than by returning is a finding.
extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto& reader = fleetproof::fuzz::reader(FLEETPROOF_FUZZED_READER);
  reader.accepts({reinterpret_cast<const char*>(data), size});
  return 0;
}
