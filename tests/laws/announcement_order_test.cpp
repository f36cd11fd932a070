// Two pieces that end at the same instant: whichever is announced first, the exact law files the same to the last
// nanosecond.
#include <gtest/gtest.h>

#include "laws/exact_law.hpp"
#include "tests/laws/teller.hpp"
#include "tests/oracle/known_pairs.hpp"

namespace fleetproof::oracle::announcement_order_test {
namespace {

std::vector<Violation> filed(const Piece& first, const Piece& second) {
  Scenario scenario;
  scenario.agvs.resize(2);
  const auto law = make_exact_law(scenario);
  test::Teller teller(*law, scenario.entity_count());
  teller.begins(first);
  teller.begins(second);
  teller.ends(first);
  teller.ends(second);
  law->finish(first.end);
  return law->findings().violations;
}

TEST(AnnouncementOrder, LeavesNoTraceInTheArithmetic) {
  PairSource source(9);
  std::size_t violations = 0;
  for (int i = 0; i < 1'000; ++i) {
    TrajectoryPair pair = source.next(i % 2 == 0 ? Relation::Crossing : Relation::CutShort, 0.1);
    pair.a.end = pair.b.end = pair.end;
    OwnPiece a(pair.a), b(pair.b);
    a.piece.entity = EntityId{0U}, b.piece.entity = EntityId{1U};
    for (Piece* piece : {&a.piece, &b.piece}) piece->planned_box = piece->swept_box(piece->end);
    const auto expected = filed(a.piece, b.piece);
    violations += expected.size();
    ASSERT_EQ(filed(b.piece, a.piece), expected) << i;
  }
  EXPECT_GT(violations, 200U);
}

}  // namespace
}  // namespace fleetproof::oracle::announcement_order_test
