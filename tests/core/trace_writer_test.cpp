#include "core/engine/trace_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/outcome/trace_records.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::trace_writer_test {
namespace {

class Reads : public Law {
 public:
  explicit Reads(TraceKinds kinds) : kinds_(kinds) {}
  void piece_ended(const Piece&) override {}
  TraceKinds reads() const override { return kinds_; }
  void happened(const TraceRecord& record) override { heard.push_back(record.kind); }
  LawResults findings() const override { return {}; }

  std::vector<TraceKind> heard;

 private:
  TraceKinds kinds_;
};

TEST(TraceWriter, HandsEachLawTheKindsThatItReads) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::Contact}));
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::Contact, TraceKind::Log}));
  laws.push_back(std::make_unique<Reads>(TraceKinds{}));
  test::Recorder sink;
  TraceWriter writer(laws, &sink);
  for (const TraceKind kind : {TraceKind::Log, TraceKind::Contact, TraceKind::Probe}) {
    TraceRecord record;
    record.kind = kind;
    writer.write(record, "");
  }
  const auto heard = [&](std::size_t law) { return static_cast<const Reads&>(*laws[law]).heard; };
  EXPECT_EQ(heard(0), (std::vector<TraceKind>{TraceKind::Contact}));
  EXPECT_EQ(heard(1), (std::vector<TraceKind>{TraceKind::Log, TraceKind::Contact}));
  EXPECT_EQ(heard(2), std::vector<TraceKind>{});
  for (const TraceKind kind : {TraceKind::Log, TraceKind::Contact, TraceKind::Probe})
    EXPECT_EQ(sink.of(kind).size(), 1U);
}

// Two runs that differ only in what the scenario did not get have the same digest.
TEST(TraceWriter, LeavesTheDigestAsItIsWhenNothingHappens) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::Denied}));
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::Log}));
  test::Recorder sink;
  TraceWriter writer(laws, &sink);
  const std::uint64_t before = writer.digest().value();
  writer.write_aside(trace_record(kStart, EntityId{0U}, traced::Denied{Denial::NoRoom, 3}));
  EXPECT_EQ(writer.digest().value(), before);
  EXPECT_EQ(writer.digest().record_count(), 0U);
  EXPECT_EQ(static_cast<const Reads&>(*laws[0]).heard, std::vector<TraceKind>{TraceKind::Denied});
  EXPECT_EQ(static_cast<const Reads&>(*laws[1]).heard, std::vector<TraceKind>{});
  EXPECT_EQ(sink.of(TraceKind::Denied).size(), 1U);
}

class ReadsAboutTurns final : public Reads {
 public:
  ReadsAboutTurns() : Reads(TraceKinds{TraceKind::ActivityBegins, TraceKind::ActivityEnds, TraceKind::Contact}) {}
  ActivityKinds reads_about() const override { return {ActivityKind::Turn}; }
};

TEST(TraceWriter, HandsALawRecordsAboutTheActivitiesThatItNames) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<ReadsAboutTurns>());
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::ActivityBegins, TraceKind::Contact}));
  TraceWriter writer(laws, nullptr);
  for (const ActivityKind activity : {ActivityKind::Drive, ActivityKind::Turn, ActivityKind::Dock}) {
    writer.write(trace_record(kStart, EntityId{0U}, traced::ActivityBegins{activity, 0}), "");
    writer.write(trace_record(kStart, EntityId{0U}, traced::ActivityEnds{activity, true}), "");
    writer.write(trace_record(kStart, EntityId{0U}, traced::Contact{EntityId{1U}}), "");
  }
  const auto heard = [&](std::size_t law, TraceKind kind) {
    return std::ranges::count(static_cast<const Reads&>(*laws[law]).heard, kind);
  };
  EXPECT_EQ(heard(0, TraceKind::ActivityBegins), 1);
  EXPECT_EQ(heard(0, TraceKind::ActivityEnds), 1);
  EXPECT_EQ(heard(0, TraceKind::Contact), 3);
  EXPECT_EQ(heard(1, TraceKind::ActivityBegins), 3);
  EXPECT_EQ(heard(1, TraceKind::ActivityEnds), 0);
}

// Keeps every part, and reads it at the end.
class Keeps final : public Reads {
 public:
  Keeps() : Reads(TraceKinds{TraceKind::Contact}) {}
  bool hears_together() const override { return true; }
  void together(const TracePart& part) override { parts.push_back(part); }
  void hears_from(TraceSource& source) override { source_ = &source; }
  void happened(const TraceRecord& record) override {
    if (record.at >= curious_from) source_->hand_over();
    heard_before_contact.push_back(records().size());
  }

  std::vector<TraceRecord> records() const {
    std::vector<TraceRecord> all;
    for (const TracePart& part : parts) {
      for (std::uint32_t place = part.begin; place < part.end; ++place) all.push_back(part.block->record(place));
    }
    return all;
  }

  SimTime curious_from = kForever;
  std::vector<TracePart> parts;
  std::vector<std::size_t> heard_before_contact;

 private:
  TraceSource* source_ = nullptr;
};

TraceRecord record_number(std::uint32_t i) {
  TraceRecord record;
  record.at = kStart + Duration{i};
  record.entity = EntityId{i % 7};
  record.kind = i % 50 == 49 ? TraceKind::Contact : i % 3 == 0 ? TraceKind::Sent : TraceKind::Received;
  record.a = 3 * i;
  record.b = std::uint64_t{i} << 40;
  record.bytes = record.kind == TraceKind::Sent ? i : 0;
  return record;
}

TEST(TraceWriter, HandsAllRecordsOverTogetherAndInOrder) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Keeps>());
  laws.push_back(std::make_unique<Keeps>());
  auto &calm = static_cast<Keeps&>(*laws[0]), &curious = static_cast<Keeps&>(*laws[1]);
  TraceWriter writer(laws, nullptr);
  constexpr std::uint32_t kAll = 3010;
  for (std::uint32_t i = 0; i < kAll; ++i) {
    if (i == 1500) curious.curious_from = kStart + Duration{1600};
    writer.write(record_number(i), "");
  }
  EXPECT_LT(calm.records().size(), kAll);
  writer.hand_over();
  const auto heard = calm.records();
  ASSERT_EQ(heard.size(), kAll);
  for (std::uint32_t i = 0; i < kAll; ++i) {
    const TraceRecord written = record_number(i);
    EXPECT_EQ(heard[i].at, written.at);
    EXPECT_EQ(heard[i].entity, written.entity);
    EXPECT_EQ(heard[i].kind, written.kind);
    EXPECT_EQ(heard[i].a, written.a);
    EXPECT_EQ(heard[i].b, written.b);
  }
  const auto& before = curious.heard_before_contact;  // at 49, 99, ...
  ASSERT_EQ(before.size(), kAll / 50);
  EXPECT_EQ(before[11], 512U) << "as many as filled a block";
  EXPECT_EQ(before[32], 1650U) << "all, because the law asked for them";
  EXPECT_LT(calm.parts.size(), 50U);
}

TEST(TraceBlock, KnowsHowLongItsMessagesAre) {
  TraceDigest digest;
  for (std::uint32_t i = 0; i < 100; ++i) digest.append(record_number(i));
  const TracePart part = digest.take_newest();
  std::vector<std::uint32_t> bytes;
  for (const TraceBlock::Sent& sent : part.block->sent()) {
    EXPECT_EQ(part.block->kind(sent.place), TraceKind::Sent);
    bytes.push_back(sent.bytes);
  }
  ASSERT_EQ(bytes.size(), 33U);
  EXPECT_EQ(bytes[1], 3U);
  EXPECT_EQ(bytes.back(), 96U);
}

}  // namespace
}  // namespace fleetproof::trace_writer_test
