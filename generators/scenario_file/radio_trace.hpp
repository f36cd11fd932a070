#pragma once

#include <string>
#include <string_view>

#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// Reads a recording of a real radio from CSV. The first line is "sender,receiver,t_send_s,t_recv_s"; then there is one
// line for each message, in any order. AGVs are numbers from 0 on. Times are decimal seconds; digits beyond the ninth
// after the point are cut off. If a message was lost, its t_recv_s is empty or "lost". Empty lines and lines that begin
// with # are ignored. Times count from the earliest t_send_s, so the clock may start anywhere. Throws InputError with
// file, line, column, value and remedy.
RadioTrace read_radio_trace(const std::string& path);
RadioTrace parse_radio_trace(std::string_view text, std::string_view source);

// Sorts messages in the order that RadioTrace requires. Messages of one pair and one instant keep their order.
void put_in_order(RadioTrace& trace);

}  // namespace fleetproof
