#include <gtest/gtest.h>

#include <set>

#include "core/error.hpp"
#include "core/outcome.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof {
namespace {

TEST(OutcomeEncoding, comes_back_as_it_went) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    const auto outcome = samples::random_outcome(random);
    const auto bytes = encode(outcome);
    const auto decoded = decode_outcome(bytes);
    ASSERT_EQ(decoded, outcome);
    ASSERT_EQ(encode(decoded), bytes);
  }
}

TEST(OutcomeEncoding, is_little_endian_with_its_version_first) {
  Outcome outcome;
  outcome.stuck = true;
  outcome.counters.events = 0x0102;
  const auto bytes = encode(outcome);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\x02\0\0\0", 4));
  EXPECT_EQ(bytes.substr(4, 8), std::string("\0\0\1\0\0\0\0\0", 8));    // seven end points, then "no clearance"
  EXPECT_EQ(bytes.substr(12, 3), std::string("\x02\x01\0", 3));         // events
}

TEST(OutcomeEncoding, two_outcomes_that_differ_in_one_bit_differ_in_their_bytes) {
  std::mt19937_64 random(2);
  auto outcome = samples::random_outcome(random);
  const auto before = encode(outcome);
  outcome.counters.perimeter_checks ^= 1;
  EXPECT_NE(encode(outcome), before);
}

TEST(OutcomeEncoding, refuses_every_truncation_and_every_tail) {
  std::mt19937_64 random(3);
  auto outcome = samples::random_outcome(random);
  outcome.violations.resize(2);
  const auto bytes = encode(outcome);
  for (std::size_t length = 0; length < bytes.size(); ++length) EXPECT_THROW(decode_outcome(bytes.substr(0, length)), EngineError) << length;
  EXPECT_THROW(decode_outcome(bytes + '\0'), EngineError);
}

TEST(OutcomeEncoding, refuses_another_version_and_lengths_beyond_the_end) {
  auto bytes = encode(Outcome{});
  auto newer = bytes;
  newer[0] = 3;
  EXPECT_THROW(decode_outcome(newer), EngineError);
  auto flag = bytes;
  flag[4] = 2;
  EXPECT_THROW(decode_outcome(flag), EngineError);
  auto many = bytes;
  many.replace(many.size() - 4, 4, "\xff\xff\xff\xff");  // four thousand million violations
  EXPECT_THROW(decode_outcome(many), EngineError);
}

TEST(OutcomeClass, is_the_worst_end_point) {
  Outcome outcome;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Clean);
  outcome.stuck = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Stuck);
  outcome.indeterminate = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Indeterminate);
  outcome.hang = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Hang);
  outcome.crash = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Crash);
  outcome.violation = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Violation);
  outcome.contact = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::Contact);
  outcome.engine_error = true;
  EXPECT_EQ(outcome.outcome_class(), OutcomeClass::EngineError);
}

TEST(OutcomeClass, names_are_all_different) {
  std::set<std::string> names;
  for (int i = 0; i <= static_cast<int>(OutcomeClass::Clean); ++i) names.insert(name_of(static_cast<OutcomeClass>(i)));
  EXPECT_EQ(names.size(), 8u);
}

TEST(FileViolations, sets_the_end_points_and_the_smallest_clearance_and_sorts) {
  Violation late, early;
  late.first = at_seconds(5);
  late.min_clearance_um = 40'000;
  early.first = at_seconds(2);
  early.min_clearance_um = -3'000;
  early.contact = true;
  Outcome outcome;
  outcome.min_clearance_um = 20'000;
  file_violations(outcome, {late, early});
  EXPECT_TRUE(outcome.violation);
  EXPECT_TRUE(outcome.contact);
  EXPECT_EQ(outcome.min_clearance_um, -3'000);
  ASSERT_EQ(outcome.violations.size(), 2u);
  EXPECT_EQ(outcome.violations.front().first, at_seconds(2));
}

TEST(FileViolations, none_leave_the_outcome_clean) {
  Outcome outcome;
  file_violations(outcome, {});
  EXPECT_EQ(outcome, Outcome{});
}

}  // namespace
}  // namespace fleetproof
