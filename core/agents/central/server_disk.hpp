#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/agents/central/messages.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents::central {

// The disk of the zone-server: a record for each AGV, and one that says which start of the server wrote last. Each is
// sealed with a checksum over its content, its number and the sizes of the plant, so that a torn record, or one of
// another plant, is not believed.
class ServerDisk {
 public:
  // `start`: how often the computer has started before.
  ServerDisk(Controller& controller, const MapView& map, std::uint32_t fleet_count, std::uint32_t start)
      : controller_(controller), map_(map), fleet_count_(fleet_count), start_(start) {}

  // The records of all AGVs; empty if the disk is not to be believed. It is believed if all records are of one boot of
  // ways, and the last start of the server went on with that boot: an older image of the disk lacks later grants.
  std::vector<AgvRecord> recall();
  // To be called at the start, and again until it is true: this start goes on with the ways of this boot.
  bool open(std::uint32_t server_boot);
  // True if whatever is sent from now on is sent after the record is on the disk. Never before `open` was true.
  bool keep(std::uint32_t agv, const AgvRecord& record) { return opened_ && put(1 + agv, encode(record)); }

 private:
  std::uint64_t seal(std::uint32_t number, std::span<const std::byte> bytes) const;
  bool put(std::uint32_t number, std::vector<std::byte> bytes);
  // What was put there; empty if there is no such record, or if its seal is wrong.
  std::span<const std::byte> get(std::uint32_t number);

  Controller& controller_;
  const MapView& map_;
  std::uint32_t fleet_count_, start_;
  bool opened_ = false;
};

}  // namespace fleetproof::agents::central
