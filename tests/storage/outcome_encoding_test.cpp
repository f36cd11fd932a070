#include <gtest/gtest.h>

#include <set>

#include "core/base/error.hpp"
#include "core/outcome/outcome.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::outcome_encoding_test {
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
  EXPECT_EQ(bytes.substr(0, 4), std::string("\x06\0\0\0", 4));
  EXPECT_EQ(bytes.substr(4, 8), std::string("\0\0\1\0\0\0\0\0", 8));  // seven end points, then "no clearance"
  EXPECT_EQ(bytes.substr(12, 3), std::string("\x02\x01\0", 3));       // events
}

TEST(OutcomeEncoding, holds_the_counters_in_the_order_of_their_table) {
  for (std::size_t i = 0; i < kCounters.size(); ++i) {
    Outcome outcome;
    outcome.counters.*kCounters[i].member = 0x0102;
    EXPECT_EQ(encode(outcome).substr(12 + 8 * i, 3), std::string("\x02\x01\0", 3)) << kCounters[i].name;
  }
}

TEST(Counters, have_a_unit_and_a_meaning) {
  for (const CounterInfo& counter : kCounters) {
    EXPECT_FALSE(counter.unit.empty()) << counter.name;
    EXPECT_FALSE(counter.meaning.empty()) << counter.name;
  }
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
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(decode_outcome(bytes.substr(0, length)), EngineError) << length;
  EXPECT_THROW(decode_outcome(bytes + '\0'), EngineError);
}

TEST(OutcomeEncoding, refuses_another_version_and_lengths_beyond_the_end) {
  auto bytes = encode(Outcome{});
  auto newer = bytes;
  newer[0] = 7;
  EXPECT_THROW(decode_outcome(newer), EngineError);
  auto flag = bytes;
  flag[4] = 2;
  EXPECT_THROW(decode_outcome(flag), EngineError);
  auto many = bytes;
  for (const std::size_t tail : {4U, 8U, 12U}) {  // four thousand million probes, incidents, violations
    many = bytes;
    many.replace(many.size() - tail, 4, "\xff\xff\xff\xff");
    EXPECT_THROW(decode_outcome(many), EngineError);
  }
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

TEST(OutcomeClass, follows_the_weights_and_no_two_ends_weigh_the_same) {
  std::set<std::uint32_t> weights, seriousness;
  for (const RunEnd& a : kRunEnds) {
    weights.insert(a.weight);
    seriousness.insert(a.seriousness);
    for (const RunEnd& b : kRunEnds) {
      Outcome outcome;
      outcome.*a.flag = outcome.*b.flag = true;
      EXPECT_EQ(outcome.outcome_class(), a.weight > b.weight ? a.id : b.id);
      EXPECT_EQ(outcome.is_failure(), a.weight > b.weight ? a.is_failure : b.is_failure);
    }
  }
  EXPECT_EQ(weights.size(), kRunEnds.size());
  EXPECT_EQ(seriousness.size(), kRunEnds.size());
  EXPECT_EQ(find_run_end(OutcomeClass::Clean), nullptr);
  EXPECT_FALSE(Outcome().is_failure());
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

TEST(OutcomeEncoding, refuses_an_incident_of_no_known_kind) {
  for (const std::uint32_t kind : {0U, static_cast<std::uint32_t>(incident_kinds().size()) + 1}) {
    Outcome outcome;
    outcome.incidents.emplace_back();
    outcome.incidents[0].kind = static_cast<IncidentKind>(kind);
    EXPECT_THROW(decode_outcome(encode(outcome)), EngineError);
  }
}

TEST(ViolationLevel, has_three_steps) {
  Violation violation;
  violation.relative_speed_um_s = 2'000'000;
  EXPECT_EQ(level_of(violation), ViolationLevel::SafetyDistance);
  violation.contact = true;
  EXPECT_EQ(level_of(violation), ViolationLevel::HazardousContact);
  violation.relative_speed_um_s = 300'000;
  EXPECT_EQ(level_of(violation), ViolationLevel::Contact) << "hazardous is faster than 0.3 m/s";
}

TEST(FileIncidents, sorts_and_keeps_the_earliest) {
  std::vector<Incident> many;
  for (std::uint32_t i = 0; i < kIncidentsMax + 7; ++i)
    many.push_back({IncidentKind::Deadlock, EntityId{i}, {}, at_ns(5000 - i), at_ns(9000), 0});
  Outcome outcome;
  file_incidents(outcome, many);
  ASSERT_EQ(outcome.incidents.size(), kIncidentsMax);
  EXPECT_EQ(outcome.counters.incidents_left_out, 7u);
  EXPECT_EQ(outcome.incidents.front().first, at_ns(5000 - static_cast<std::int64_t>(kIncidentsMax) - 6));
  EXPECT_TRUE(std::ranges::is_sorted(outcome.incidents, {}, &Incident::first));
}

TEST(FileIncidents, what_accuses_nobody_takes_no_room_from_accusations) {
  std::vector<Incident> many;
  for (std::uint32_t i = 0; i < kIncidentsMax + 5; ++i)
    many.push_back({IncidentKind::FaultInjected, EntityId{0U}, {}, at_ns(i), at_ns(i), 4});
  many.push_back({IncidentKind::ForeignBody, EntityId{7U}, {}, at_ns(8000), at_ns(9000), 0});
  for (const std::int64_t first : {6000, 5000})
    many.push_back({IncidentKind::Deadlock, EntityId{0U}, {}, at_ns(first), at_ns(9000), 0});
  Outcome outcome;
  file_incidents(outcome, many);
  ASSERT_EQ(outcome.incidents.size(), kIncidentsMax);
  EXPECT_EQ(outcome.counters.incidents_left_out, 8u);
  EXPECT_TRUE(std::ranges::is_sorted(outcome.incidents, {}, &Incident::first));
  EXPECT_EQ(std::ranges::count(outcome.incidents, IncidentKind::Deadlock, &Incident::kind), 2);
  EXPECT_EQ(std::ranges::count(outcome.incidents, IncidentKind::ForeignBody, &Incident::kind), 1);
  EXPECT_EQ(outcome.incidents[kIncidentsMax - 4].first, at_ns(static_cast<std::int64_t>(kIncidentsMax) - 4))
      << "of the faults, the earliest stay";
}

TEST(FileIncidents, the_earliest_of_each_kind_stays) {
  std::vector<Incident> many;
  for (std::uint32_t i = 0; i < kIncidentsMax + 5; ++i)
    many.push_back({IncidentKind::LoadVanished, EntityId{i}, {}, at_ns(i), at_ns(i), 0});
  for (const std::int64_t first : {7000, 6000}) {
    many.push_back({IncidentKind::Deadlock, EntityId{0U}, {}, at_ns(first), at_ns(9000), 0});
    many.push_back({IncidentKind::FaultInjected, EntityId{0U}, {}, at_ns(first), at_ns(9000), 4});
  }
  Outcome outcome;
  file_incidents(outcome, many);
  ASSERT_EQ(outcome.incidents.size(), kIncidentsMax);
  EXPECT_EQ(outcome.counters.incidents_left_out, 9u);
  EXPECT_EQ(outcome.incidents[kIncidentsMax - 2].kind, IncidentKind::Deadlock);
  EXPECT_EQ(outcome.incidents[kIncidentsMax - 1].kind, IncidentKind::FaultInjected);
  EXPECT_EQ(outcome.incidents.back().first, at_ns(6000));
}

TEST(ProbeTally, is_bounded_and_counts_the_excess) {
  ProbeTally tally;
  for (std::uint64_t i = 0; i < 100; ++i) tally.declare("probe " + std::to_string(i), i);
  for (std::uint64_t i = 0; i < 3; ++i) tally.declare("probe 7", 7);
  EXPECT_EQ(tally.counts().size(), 64u);
  EXPECT_EQ(tally.left_out(), 36u);
  EXPECT_TRUE(std::ranges::is_sorted(tally.counts(), {}, &ProbeCount::name));
  const auto counts = tally.counts();
  EXPECT_EQ(std::ranges::find(counts, "probe 7", &ProbeCount::name)->count, 4u);
  ProbeTally long_names;
  long_names.declare(std::string(64, 'x'), 1);
  long_names.declare(std::string(65, 'y'), 2);
  EXPECT_EQ(long_names.counts().size(), 1u);
  EXPECT_EQ(long_names.left_out(), 1u);
}

TEST(IncidentKinds, have_names_and_units_of_their_own) {
  std::set<std::string_view> names;
  for (const auto& info : incident_kinds()) {
    names.insert(info.name);
    EXPECT_FALSE(info.unit.empty()) << info.name;
    EXPECT_EQ(info.name.find('\''), std::string_view::npos) << "it goes into SQL";
    EXPECT_EQ(info.unit.find('\''), std::string_view::npos) << "it goes into SQL";
    EXPECT_EQ(info_of(info.kind).name, info.name);
  }
  EXPECT_EQ(names.size(), incident_kinds().size());
}

TEST(FileViolations, none_leave_the_outcome_clean) {
  Outcome outcome;
  file_violations(outcome, {});
  EXPECT_EQ(outcome, Outcome{});
}

}  // namespace
}  // namespace fleetproof::outcome_encoding_test
