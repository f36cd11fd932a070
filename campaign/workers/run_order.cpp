#include "campaign/workers/run_order.hpp"

#include "core/base/byte_text.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kShortestEndBytes = 8 + 1 + 4, kShortestTextBytes = 4,
                      kShortestDeliveryBytes = 4 * 4 + 4 * 8 + 2 + 4 + 4;

void put(ByteSink& sink, const std::vector<std::string>& texts) {
  sink.u32(static_cast<std::uint32_t>(texts.size()));
  for (const std::string& text : texts) sink.text(text);
}

std::vector<std::string> take_texts(ByteSource& source) {
  std::vector<std::string> texts(source.count(kShortestTextBytes));
  for (std::string& text : texts) text = source.text();
  return texts;
}

void put(ByteSink& sink, const MessageDelivery& message) {
  const auto& [sender, receiver, sent, ordinal, lost, delay, copied, copy_delay] = message.delivery;
  for (const std::uint32_t word : {sender.value, receiver.value, ordinal, message.number}) sink.u32(word);
  for (const Duration time : {sent, delay, copy_delay}) sink.i64(time.count());
  for (const bool flag : {lost, copied}) sink.u8(flag ? 1 : 0);
  sink.text(message.kind);
  sink.text(message.content);
  sink.i64(message.on_its_way.count());
}

void take(ByteSource& source, MessageDelivery& message) {
  auto& [sender, receiver, sent, ordinal, lost, delay, copied, copy_delay] = message.delivery;
  for (std::uint32_t* word : {&sender.value, &receiver.value, &ordinal, &message.number}) *word = source.u32();
  for (Duration* time : {&sent, &delay, &copy_delay}) *time = Duration{source.i64()};
  for (bool* flag : {&lost, &copied}) *flag = source.flag();
  message.kind = source.text();
  message.content = source.text();
  message.on_its_way = Duration{source.i64()};
}

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
  sink.u64(order.scenario.layout_digest);
  sink.text(order.scenario.layout);
  sink.text(order.scenario.scenario);
  sink.u8(order.deliveries ? 1 : 0);
  sink.u8(order.is_audit ? 1 : 0);
  sink.u32(order.choice.end_points);
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
  order.scenario.layout_digest = source.u64();
  order.scenario.layout = source.text();
  order.scenario.scenario = source.text();
  order.deliveries = source.flag();
  order.is_audit = source.flag();
  order.choice.end_points = source.u32();
  source.end();
  return order;
}

std::string encode(const RunAnswer& answer) {
  ByteSink sink;
  sink.u8(answer.failed ? 1 : 0);
  sink.u8(answer.machine ? 1 : 0);
  sink.u8(answer.declined ? 1 : 0);
  sink.u8(answer.is_piece ? 1 : 0);
  sink.text(answer.message);
  sink.u64(answer.cpu_ns);
  sink.u64(answer.scenario_digest);
  sink.text(encode(answer.run.outcome));
  sink.text(answer.recording);
  put(sink, answer.run.states);
  put(sink, answer.run.doing);
  put(sink, answer.run.words);
  put(sink, answer.run.all_words);
  put(sink, answer.run.first_said);
  put(sink, answer.run.notes);
  put(sink, answer.run.itinerary);
  sink.u32(static_cast<std::uint32_t>(answer.run.deliveries.size()));
  for (const MessageDelivery& message : answer.run.deliveries) put(sink, message);
  return sink.take();
}

RunAnswer decode_answer(std::string_view bytes) {
  ByteSource source(bytes, "an answer of a worker");
  RunAnswer answer;
  answer.failed = source.flag();
  answer.machine = source.flag();
  answer.declined = source.flag();
  answer.is_piece = source.flag();
  answer.message = source.text();
  answer.cpu_ns = source.u64();
  answer.scenario_digest = source.u64();
  answer.run.outcome = decode_outcome(source.text());
  answer.recording = source.text();
  answer.run.states = take_texts(source);
  answer.run.doing = take_texts(source);
  answer.run.words = take_texts(source);
  answer.run.all_words = take_texts(source);
  answer.run.first_said = take_declared(source);
  answer.run.notes = take_notes(source);
  answer.run.itinerary = take_itinerary(source);
  answer.run.deliveries.resize(source.count(kShortestDeliveryBytes));
  for (MessageDelivery& message : answer.run.deliveries) take(source, message);
  source.end();
  return answer;
}

}  // namespace fleetproof
