#include "storage/run_bytes.hpp"

#include <bit>

#include "core/base/byte_text.hpp"

namespace fleetproof {

std::string encode(const RunRecord& run) {
  ByteSink sink;
  sink.u64(run.run_index);
  sink.u32(run.cell);
  sink.u64(run.replicate);
  sink.u64(run.scenario_digest);
  for (const double value : run.factors.values) sink.u64(std::bit_cast<std::uint64_t>(value));
  sink.text(encode(run.outcome));
  sink.text(run.recording);
  return sink.take();
}

RunRecord decode_run(std::string_view bytes) {
  ByteSource source(bytes, "an encoded run");
  RunRecord run;
  run.run_index = source.u64();
  run.cell = source.u32();
  run.replicate = source.u64();
  run.scenario_digest = source.u64();
  for (double& value : run.factors.values) value = std::bit_cast<double>(source.u64());
  run.outcome = decode_outcome(source.text());
  run.recording = source.text();
  source.end();
  return run;
}

}  // namespace fleetproof
