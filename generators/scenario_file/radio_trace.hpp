#pragma once

#include <string>
#include <string_view>

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// A recording of a real radio as CSV: a line "sender,receiver,t_send_s,t_recv_s", then one line for each message. AGVs
// by their numbers from 0 on; seconds as decimals (9 digits after the point count); t_recv_s empty or "lost" where the
// message never came. Lines in any order, empty ones and those that begin with # are left out. Times count from the
// earliest t_send_s, so clocks of any epoch will do. InputError (file and line, column, value, remedy) for anything
// else.
RadioTrace read_radio_trace(const std::string& path);
RadioTrace parse_radio_trace(std::string_view text, std::string_view source);

// In the order that RadioTrace asks for; messages of one pair and instant stay as they come.
void put_in_order(RadioTrace& trace);

}  // namespace fleetproof
