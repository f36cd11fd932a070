// Every kind of record keeps what is put into it, in the words that the digest has always had.
#include "core/outcome/trace_records.hpp"

#include <gtest/gtest.h>

#include <set>

namespace fleetproof::trace_records_test {
namespace {

constexpr AgvId kAgv{3U};

template <class What>
TraceRecord record_of(const What& what) {
  return trace_record(at_ns(7), kAgv, what);
}

// The words of a record are part of every digest that was ever published.
void expect_words(const TraceRecord& record, TraceKind kind, std::uint64_t a, std::uint64_t b) {
  EXPECT_EQ(record.at, at_ns(7));
  EXPECT_EQ(record.entity, kAgv);
  EXPECT_EQ(record.kind, kind);
  EXPECT_EQ(record.a, a) << name_of(kind);
  EXPECT_EQ(record.b, b) << name_of(kind);
}

TEST(TraceRecords, WriteTheWordsOfTheDigest) {
  using enum TraceKind;
  const std::uint64_t none = 0xffffffffU;
  expect_words(record_of(traced::ActivityBegins{ActivityKind::Pick, 9}), ActivityBegins, 4, 9);
  expect_words(record_of(traced::ActivityEnds{ActivityKind::Settle, true}), ActivityEnds, 8, 1);
  expect_words(record_of(traced::ActivityEnds{ActivityKind::Drive, false}), ActivityEnds, 1, 0);
  expect_words(record_of(traced::OrderReleased{TransportId{5U}}), OrderReleased, 5, 0);
  expect_words(record_of(traced::TransportDone{TransportId{5U}}), TransportDone, 5, 0);
  expect_words(record_of(traced::OrderWithdrawn{TransportId{5U}}), OrderWithdrawn, 5, 0);
  expect_words(record_of(traced::WorksOn{TransportId{5U}}), WorksOn, 5, 0);
  expect_words(record_of(traced::WorksOn{}), WorksOn, none, 0);
  expect_words(record_of(traced::Sent{{}, 0x1234567890abcdefU, 100}), Sent, none, 0x1234567890abcdefU);
  expect_words(record_of(traced::Reception{LostToSource, AgvId{2U}, 77}), LostToSource, 2, 77);
  expect_words(record_of(traced::Reception{Received, AgvId{2U}, 77}), Received, 2, 77);
  expect_words(record_of(traced::TimerWentOff{6}), TimerWentOff, 6, 0);
  expect_words(record_of(traced::CallRefused{1, {}}), CallRefused, 1, none);
  expect_words(record_of(traced::Contact{EntityId{4U}}), Contact, 4, 0);
  expect_words(record_of(traced::SafeMode{true}), SafeMode, 1, 0);
  expect_words(record_of(traced::StoppedByAgent{true}), StoppedByAgent, 1, 0);
  expect_words(record_of(traced::Kept{3, 9, 77}), Kept, 77, (9ULL << 32) + 3);
  expect_words(record_of(traced::WaitingFor{}), WaitingFor, none, 0);
  expect_words(record_of(traced::Probe{88}), Probe, 88, 0);
  expect_words(record_of(traced::Log{99}), Log, 99, 0);
  expect_words(record_of(traced::AgentCrashed{}), AgentCrashed, 0, 0);
  expect_words(record_of(traced::AgentHung{}), AgentHung, 0, 0);
  expect_words(record_of(traced::LoadMoves{LoadId{8U}, {Holder::Kind::Floor, 12}}), LoadMoves, 8, (2ULL << 32) + 12);
  expect_words(record_of(traced::LoadMoves{LoadId{8U}, {Holder::Kind::Withdrawn, 0}}), LoadMoves, 8, 4ULL << 32);
  expect_words(record_of(traced::BatteryEmpty{}), BatteryEmpty, 0, 0);
  expect_words(record_of(traced::FaultStrikes{Fault::Kind::Freeze, 11}), FaultStrikes, 5, 11);
  expect_words(record_of(traced::FaultOver{Fault::Kind::LoadDrop, 11}), FaultOver, 3, 11);
  expect_words(record_of(traced::ScannerStops{EntityId{10U}}), ScannerStops, 10, 0);
  expect_words(record_of(traced::OperatorAssists{Assist::Standstill}), OperatorAssists, 4, 0);
  expect_words(record_of(traced::Appears{}), Appears, 0, 0);
  expect_words(record_of(traced::Appears{StationId{13U}}), Appears, 13, 0);
  expect_words(record_of(traced::Leaves{}), Leaves, 0, 0);
  expect_words(record_of(traced::Denied{Denial::NoSuchLoad, 11}), Denied, 3, 11);
}

TEST(TraceRecords, ReadWhatWasWritten) {
  const auto begun = read<traced::ActivityBegins>(record_of(traced::ActivityBegins{ActivityKind::Drive, 9}));
  EXPECT_EQ(begun.activity, ActivityKind::Drive);
  EXPECT_EQ(begun.segment(), SegmentId{9U});
  EXPECT_FALSE(read<traced::ActivityEnds>(record_of(traced::ActivityEnds{ActivityKind::Drive, false})).as_planned);
  const auto sent = read<traced::Sent>(record_of(traced::Sent{{}, 5, 100}));
  EXPECT_TRUE(sent.to_all());
  EXPECT_EQ(sent.message_hash, 5U);
  EXPECT_EQ(sent.bytes, 100U);
  const auto lost = read<traced::Reception>(record_of(traced::Reception{TraceKind::LostInOutage, AgvId{2U}, 7}));
  EXPECT_TRUE(lost.is_lost());
  EXPECT_EQ(lost.delivery, TraceKind::LostInOutage);
  EXPECT_EQ(lost.sender, AgvId{2U});
  const auto [load, to] =
      read<traced::LoadMoves>(record_of(traced::LoadMoves{LoadId{8U}, {Holder::Kind::ClearedAway, 12}}));
  EXPECT_EQ(load, LoadId{8U});
  EXPECT_EQ(to, (Holder{Holder::Kind::ClearedAway, 12}));
  EXPECT_FALSE(read<traced::WaitingFor>(record_of(traced::WaitingFor{})).agv.valid());
  EXPECT_EQ(read<traced::FaultOver>(record_of(traced::FaultOver{Fault::Kind::LoadDrop, 11})).number, 11U);
  EXPECT_EQ(read<traced::Appears>(record_of(traced::Appears{StationId{13U}})).station, StationId{13U});
}

TEST(TraceRecords, AreNotReadAsSomethingElse) {
  EXPECT_THROW(read<traced::FaultOver>(record_of(traced::FaultStrikes{})), InvariantViolation);
  EXPECT_THROW(read<traced::Reception>(record_of(traced::Sent{})), InvariantViolation);
  EXPECT_THROW(traced::activity_of(record_of(traced::Leaves{})), InvariantViolation);
}

TEST(TraceRecords, EveryKindHasAName) {
  std::set<std::string> names;
  for (std::uint32_t kind = 1; kind <= 25; ++kind) names.insert(name_of(static_cast<TraceKind>(kind)));
  for (std::uint32_t kind = 32; kind <= 34; ++kind) names.insert(name_of(static_cast<TraceKind>(kind)));
  for (std::uint32_t kind = 40; kind <= 46; ++kind) names.insert(name_of(static_cast<TraceKind>(kind)));
  EXPECT_EQ(names.size(), 35U);
}

}  // namespace
}  // namespace fleetproof::trace_records_test
