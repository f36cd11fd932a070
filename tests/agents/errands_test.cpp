#include "core/agents/errands.hpp"

#include <gtest/gtest.h>

namespace fleetproof::agents::errands_test {
namespace {

// A host that says which load is on board; one of an older minor version says only whether there is one.
struct Host {
  explicit Host(std::uint32_t minor = FP_ABI_MINOR) {
    table.abi_minor = minor;
    table.is_loaded = [](fp_controller* c, std::uint32_t* out) -> std::int32_t {
      *out = *reinterpret_cast<std::uint32_t*>(c) != FP_NONE;
      return FP_OK;
    };
    table.get_load = [](fp_controller* c, std::uint32_t* out) -> std::int32_t {
      *out = *reinterpret_cast<std::uint32_t*>(c);
      return FP_OK;
    };
  }
  fp_host table{};
  std::uint32_t on_board = FP_NONE;
  Controller controller{table, reinterpret_cast<fp_controller*>(&on_board)};
};

fp_event order(std::uint32_t id, std::uint32_t from, std::uint32_t to) {
  fp_event event{};
  event.kind = FP_EVENT_ORDER;
  event.order_id = id;
  event.from = from, event.to = to;
  return event;
}

std::vector<std::uint32_t> stations(const Errands& errands) {
  std::vector<std::uint32_t> all;
  for (const Goal& goal : errands.goals()) all.push_back(goal.station);
  return all;
}

TEST(Errands, ALoadOnBoardAfterARestartBelongsToTheOrderThatTheHostNames) {
  Host host;
  host.on_board = 7;
  Errands errands(host.controller, 1);
  errands.take(order(5, 10, 11)), errands.take(order(7, 20, 21));
  EXPECT_EQ(stations(errands), (std::vector<std::uint32_t>{10, 11, 21}));
}

TEST(Errands, AnOlderHostMeansTheFirstOrder) {
  Host host(1);
  host.on_board = 7;
  Errands errands(host.controller, 1);
  errands.take(order(7, 20, 21)), errands.take(order(5, 10, 11));
  EXPECT_EQ(stations(errands), (std::vector<std::uint32_t>{21, 10, 11}));
}

TEST(Errands, WithoutARestartEveryLoadIsFetched) {
  Host host;
  host.on_board = 7;
  Errands errands(host.controller, 0);
  errands.take(order(8, 20, 21));
  EXPECT_EQ(stations(errands), (std::vector<std::uint32_t>{20, 21}));
}

TEST(Errands, OnlyTheOwnLoadIsPutDown) {
  Host host;
  Errands errands(host.controller, 1);
  const Leg pick{Leg::Kind::Pick, FP_NONE, 5}, drop{Leg::Kind::Drop, FP_NONE, 5};
  EXPECT_FALSE(errands.is_needless(pick));
  EXPECT_TRUE(errands.is_needless(drop)) << "nothing is on board";
  host.on_board = 5;
  EXPECT_TRUE(errands.is_needless(pick));
  EXPECT_FALSE(errands.is_needless(drop));
  host.on_board = 6;
  EXPECT_TRUE(errands.is_needless(drop)) << "another load";
}

TEST(Errands, AForgottenOrderIsNotCarriedOut) {
  Host host;
  Errands errands(host.controller, 1);
  errands.take(order(5, 10, 11)), errands.take(order(6, 20, 21));
  errands.forget(5);
  EXPECT_EQ(stations(errands), (std::vector<std::uint32_t>{20, 21}));
}

TEST(Errands, ChargingComesFirstAndAtOneChargerOnly) {
  Host host;
  Errands errands(host.controller, 0);
  errands.take(order(5, 10, 11));
  errands.charge_at(30), errands.charge_at(31);
  EXPECT_EQ(stations(errands), (std::vector<std::uint32_t>{31, 10, 11}));
  errands.reached(1);
  EXPECT_TRUE(errands.next_is(Leg::Kind::Pick));
}

}  // namespace
}  // namespace fleetproof::agents::errands_test
