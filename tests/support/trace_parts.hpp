#pragma once

#include <memory>

#include "core/outcome/trace.hpp"

namespace fleetproof::test {

// A part of a trace that is one record.
inline TracePart part_of(const TraceRecord& record, bool is_copy = false) {
  const auto block = std::make_shared<TraceBlock>();
  if (is_copy) block->mark_copy(block->bytes_to(0));
  block->write(block->bytes_to(0), record);
  return {block, 0, 1};
}

}  // namespace fleetproof::test
