#include "core/engine/trace_writer.hpp"

#include <gtest/gtest.h>

#include "core/outcome/trace_records.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof {
namespace {

class Reads : public Law {
 public:
  explicit Reads(TraceKinds kinds) : kinds_(kinds) {}
  void piece_ended(const Piece&) override {}
  TraceKinds reads() const override { return kinds_; }
  void happened(const TraceRecord& record) override { heard.push_back(record.kind); }
  LawFindings findings() const override { return {}; }

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

// Hears messages together, and a contact on its own.
class Listens final : public Reads {
 public:
  Listens() : Reads(kMessageKinds | TraceKinds{TraceKind::Contact}) {}
  bool hears_messages_together() const override { return true; }
  void messages(std::span<const TraceRecord> records) override {
    for (const TraceRecord& record : records) heard.push_back(record.kind);
    ++times;
  }
  int times = 0;
};

TEST(TraceWriter, HandsMessagesOverTogetherAndInOrder) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(std::make_unique<Listens>());
  laws.push_back(std::make_unique<Reads>(TraceKinds{TraceKind::Lost, TraceKind::Contact}));
  TraceWriter writer(laws, nullptr);
  std::vector<TraceKind> all, lost;
  const auto write = [&](TraceKind kind) {
    TraceRecord record;
    record.kind = kind;
    writer.write(record, "");
    if (kind != TraceKind::Log) all.push_back(kind);
    if (kind == TraceKind::Lost || kind == TraceKind::Contact) lost.push_back(kind);
  };
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 300; ++i)
      for (const TraceKind kind : {TraceKind::Sent, TraceKind::Lost, TraceKind::Received}) write(kind);
    write(TraceKind::Log);
    if (round < 2) write(TraceKind::Contact);
  }
  const auto& listens = static_cast<const Listens&>(*laws[0]);
  EXPECT_LT(listens.heard.size(), all.size());
  writer.hand_over();
  EXPECT_EQ(listens.heard, all);
  EXPECT_LT(listens.times, 20);
  EXPECT_EQ(static_cast<const Reads&>(*laws[1]).heard, lost);
}

}  // namespace
}  // namespace fleetproof
