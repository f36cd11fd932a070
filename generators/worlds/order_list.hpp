#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// A transport that a user lists, by names of stations.
struct ListedOrder {
  Duration release{};
  std::string from, to;
  std::optional<std::uint32_t> agv;  // none: the n-th such order goes to AGV n modulo fleet size
  std::uint64_t line = 0;            // in its file

  friend bool operator==(const ListedOrder&, const ListedOrder&) = default;
};

struct OrderList {
  std::string source;  // name of the file, without its folder
  std::vector<ListedOrder> orders;
};

// Reads a table with the columns release_s, from, to and, if wanted, agv (a number from 0). InputError with file, line,
// column and remedy.
OrderList read_order_list(const std::string& path);
OrderList parse_order_list(std::string_view text, std::string_view source);

// Gives the listed orders to the scenario's fleet, each AGV's by time of release, those after the horizon left out.
// InputError, with file and line: a station that is not there, cannot be reached by all others or is for charging or
// parking only; an AGV beyond the fleet.
void assign_listed_orders(Scenario& scenario, const OrderList& list, const Reachability& reachability);

}  // namespace fleetproof
