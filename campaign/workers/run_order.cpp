#include "campaign/workers/run_order.hpp"

#include "core/base/byte_text.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kShortestEndBytes = 8 + 1 + 4;

}  // namespace

std::string encode(const RunOrder& order) {
  ByteSink sink;
  sink.u64(order.run_index);
  sink.u32(static_cast<std::uint32_t>(order.known_ends.size()));
  for (const KnownEnd& end : order.known_ends) {
    sink.u64(end.call);
    sink.u8(end.hang ? 1 : 0);
    sink.text(end.message);
  }
  sink.u8(order.record ? 1 : 0);
  return sink.take();
}

RunOrder decode_order(std::string_view bytes) {
  ByteSource source(bytes, "an order to a worker");
  RunOrder order;
  order.run_index = source.u64();
  order.known_ends.resize(source.count(kShortestEndBytes));
  for (KnownEnd& end : order.known_ends) {
    end.call = source.u64();
    end.hang = source.flag();
    end.message = source.text();
  }
  order.record = source.flag();
  source.end();
  return order;
}

std::string encode(const RunAnswer& answer) {
  ByteSink sink;
  sink.u8(answer.failed ? 1 : 0);
  sink.text(answer.message);
  sink.u64(answer.cpu_ns);
  sink.u64(answer.scenario_digest);
  sink.text(encode(answer.outcome));
  sink.text(answer.recording);
  return sink.take();
}

RunAnswer decode_answer(std::string_view bytes) {
  ByteSource source(bytes, "an answer of a worker");
  RunAnswer answer;
  answer.failed = source.flag();
  answer.message = source.text();
  answer.cpu_ns = source.u64();
  answer.scenario_digest = source.u64();
  answer.outcome = decode_outcome(source.text());
  answer.recording = source.text();
  source.end();
  return answer;
}

}  // namespace fleetproof
