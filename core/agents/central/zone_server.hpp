#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/agent_type.hpp"
#include "core/agents/central/fleet_planner.hpp"
#include "core/agents/central/floor_book.hpp"
#include "core/agents/central/messages.hpp"
#include "core/agents/central/server_disk.hpp"
#include "core/agents/central/zone_options.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/settings.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::central {

// The program of the computer of a central fleet: it plans for all followers and grants each its next steps. It keeps
// the book of the floor (floor_book.hpp), and repeats what an AGV does not seem to have.
class ZoneServer {
 public:
  ZoneServer(const fp_host& host, fp_controller* handle, const fp_briefing& briefing,
             const ServerOptions& options = {});
  ZoneServer(const ZoneServer&) = delete;
  ZoneServer& operator=(const ZoneServer&) = delete;

  void on_event(const fp_event& event);

 private:
  // What has to be on the disk anew when it changes.
  struct Kept {
    std::uint32_t boot = FP_NONE, granted = 0, orders = 0;
    friend bool operator==(const Kept&, const Kept&) = default;
  };

  void tick();
  void lose_the_silent();
  void write_late();
  bool hear(std::uint32_t sender, std::span<const std::byte> bytes);
  bool is_possible(std::uint32_t sender, const State& state) const;
  void plan();
  Kept kept_now(std::uint32_t agv) const {
    return {book_.way(agv).boot, book_.way(agv).granted(), planner_.orders_of(agv)};
  }
  bool has_work(std::uint32_t agv) const { return planner_.work_of(agv) != FP_NONE; }
  bool keep(std::uint32_t agv);
  void send(std::uint32_t agv);
  void declare();

  ServerOptions options_;
  Controller controller_;
  Settings settings_;
  Facts facts_;
  MapView map_;
  HullGeometry geometry_;
  ServerDisk disk_;
  FloorBook book_;
  FleetPlanner planner_;
  struct Declared {
    std::uint32_t work = FP_NONE, waits_for = FP_NONE;
  };
  std::vector<Declared> declared_;      // by AGV
  std::vector<Kept> kept_;              // by AGV: what is on the disk
  std::vector<bool> owes_;              // by AGV: an answer to what it told
  std::vector<std::uint32_t> told_;     // by AGV: so many steps were sent at least once
  std::vector<std::int64_t> heard_ns_;  // by AGV: when; only a faulty server looks
  std::int64_t written_ns_ = 0;         // only a faulty server looks
};

// Returns null, and says why, if it is to serve an AGV, or if the plant is too large for paths.
void* create_zone_server(const fp_host* host, fp_controller* controller, const fp_briefing* briefing,
                         const ServerOptions& options);

// The zone-server with a fault. Requires: `options` differ from the defaults in one member.
template <ServerOptions options>
constexpr fp_agent_type faulty_zone_server(const char* name, const char* description) {
  fp_agent_type type = agent_type<ZoneServer>(
      name, description, [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
        return create_zone_server(host, controller, briefing, options);
      });
  type.flags |= FP_SERVES_COMPUTERS;
  return type;
}

}  // namespace fleetproof::agents::central
