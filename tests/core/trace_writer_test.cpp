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

}  // namespace
}  // namespace fleetproof
