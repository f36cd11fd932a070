#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// A transport from a user's list, with names of stations.
struct ListedOrder {
  Duration release{};
  std::string from, to;
  std::optional<std::uint32_t> agv;  // none: the n-th order without an AGV goes to AGV n modulo fleet size
  std::uint64_t line = 0;            // in its file

  friend bool operator==(const ListedOrder&, const ListedOrder&) = default;
};

struct OrderList {
  std::string source;  // name of the file, without its folder
  std::vector<ListedOrder> orders;
};

// Reads a table with the columns release_s, from, to and, optionally, agv (a number from 0). Throws InputError with
// file, line, column and remedy.
OrderList read_order_list(const std::string& path);
OrderList parse_order_list(std::string_view text, std::string_view source);

// Gives the listed orders to the fleet of the scenario, for each AGV in order of release. Orders after the horizon are
// left out. Throws InputError, with file and line, if an AGV is not in the fleet or a station is not suitable. A
// station must exist, all other stations must reach it, an AGV must be able to pick or drop there, and it must not be
// for charging or parking only.
void assign_listed_orders(Scenario& scenario, const OrderList& list, const Reachability& reachability);

}  // namespace fleetproof
