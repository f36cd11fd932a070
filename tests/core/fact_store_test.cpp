#include "core/sdk/fact_store.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace fleetproof::fact_store_test {
namespace {

int asked = 0;  // how often one of the functions below worked

std::uint64_t read(const void* bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

void square(const fp_facts* facts, std::uint64_t question, fp_answer* to) {
  ++asked;
  const std::uint64_t value = question * question;
  facts->answer(to, &value, sizeof(value));
}

// n! by the answer to (n - 1)!.
void factorial(const fp_facts* facts, std::uint64_t n, fp_answer* to) {
  ++asked;
  const std::uint64_t value = n == 0 ? 1 : n * read(facts->ask(facts, factorial, n - 1, nullptr));
  facts->answer(to, &value, sizeof(value));
}

// Each of two questions needs the other one.
void circle(const fp_facts* facts, std::uint64_t question, fp_answer* to) {
  const std::uint64_t closed = facts->ask(facts, circle, 1 - question, nullptr) == nullptr ? 1 : 0;
  facts->answer(to, &closed, sizeof(closed));
}

void throw_first(const fp_facts* facts, std::uint64_t question, fp_answer* to) {
  if (++asked == 1) throw std::runtime_error("planted");
  square(facts, question, to);
}

class FactStoreTest : public ::testing::Test {
 protected:
  FactStoreTest() { asked = 0; }
  const void* ask(fp_derive derive, std::uint64_t question, std::uint64_t* size = nullptr) {
    return store.facts().ask(&store.facts(), derive, question, size);
  }

  fp_map map{};
  std::vector<fp_agv> fleet{3};
  FactStore store{map, fleet.data(), 3, sizeof(fp_agv), 0.1};
};

TEST_F(FactStoreTest, WorksEachQuestionOutOnce) {
  std::uint64_t size = 0;
  const void* first = ask(square, 12, &size);
  EXPECT_EQ(read(first), 144U);
  EXPECT_EQ(size, 8U);
  EXPECT_EQ(read(ask(square, 13)), 169U);
  EXPECT_EQ(ask(square, 12), first);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(read(ask(factorial, 12)), 479001600U) << "the same number, another function";
}

TEST_F(FactStoreTest, AnswersStayWhereTheyAreWhenMoreAreKept) {
  const void* first = ask(square, 7);
  EXPECT_EQ(read(ask(factorial, 20)), 2432902008176640000U);
  EXPECT_EQ(asked, 22) << "one, and twenty-one on the way to 20!";
  for (std::uint64_t i = 100; i < 5'000; ++i) ask(square, i);
  EXPECT_EQ(read(first), 49U);
  EXPECT_EQ(ask(square, 7), first);
  for (std::uint64_t i = 0; i < 5'000; ++i)
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(ask(square, i)) % alignof(std::max_align_t), 0U);
}

TEST_F(FactStoreTest, AQuestionThatLeadsBackToItselfHasNoAnswerThere) {
  EXPECT_EQ(read(ask(circle, 0)), 0U);
  EXPECT_EQ(read(ask(circle, 1)), 1U) << "it was asked while 0 was worked out";
}

TEST_F(FactStoreTest, AQuestionThatThrewIsAskedAgain) {
  EXPECT_THROW(ask(throw_first, 5), std::runtime_error);
  EXPECT_EQ(read(ask(throw_first, 5)), 25U);
}

TEST_F(FactStoreTest, AnAnswerMayBeEmpty) {
  std::uint64_t size = 99;
  EXPECT_NE(ask([](const fp_facts*, std::uint64_t, fp_answer*) {}, 1, &size), nullptr);
  EXPECT_EQ(size, 0U);
}

TEST_F(FactStoreTest, TheFactsAreThoseOfTheHost) {
  EXPECT_EQ(store.facts().struct_size, sizeof(fp_facts));
  EXPECT_EQ(store.facts().map, &map);
  EXPECT_EQ(store.facts().fleet, fleet.data());
  EXPECT_EQ(store.facts().fleet_count, 3U);
  EXPECT_EQ(store.facts().agv_stride, sizeof(fp_agv));
  EXPECT_EQ(store.facts().safety_distance_m, 0.1);
}

}  // namespace
}  // namespace fleetproof::fact_store_test
