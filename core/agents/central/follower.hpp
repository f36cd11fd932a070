#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/agents/agent_type.hpp"
#include "core/agents/central/messages.hpp"
#include "core/agents/central/zone_options.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"
#include "core/agents/settings.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents::central {

// The program of a vehicle whose fleet has a zone-server: it carries out the steps that the server grants, one after
// the other, and stands where they end. It tells the server what it has done, and its orders. floor_book.hpp says what
// it promises and why this is enough. The first computer of the fleet is its server.
class Follower {
 public:
  Follower(const fp_host& host, fp_controller* handle, const fp_briefing& briefing,
           const FollowerOptions& options = {});
  Follower(const Follower&) = delete;
  Follower& operator=(const Follower&) = delete;

  void on_event(const fp_event& event);

 private:
  // Lost: since a restart, it does not know its place, or actions of its former self are under way. Ending: it has
  // heard of another boot of the server, and finishes what is under way.
  enum class Phase : std::uint8_t { Lost, Ending, OnWay };
  struct OwnOrder {
    Order order;
    bool on_board = false;  // when it came: after a restart
    bool done = false;
  };

  void start();
  void tick();
  void find_place();
  void lose_patience();
  void begin_way();
  void obey(std::span<const std::byte> bytes);
  void follow_boot(std::uint32_t server_boot);
  void take_steps(const Grant& grant);
  void action_done(std::int32_t result);
  void act();
  bool begin(const Step& step);
  bool is_needless(const Step& transfer);
  void roll_on();
  std::uint32_t server() const { return facts_.shared().fleet_count; }
  bool is_restarted() const { return way_.way.agv_boot > 0; }
  void finish_step();
  void finish_order(std::uint32_t id);
  void report();
  const char* activity();

  FollowerOptions options_;
  Controller controller_;
  Facts facts_;
  MapView map_;
  Settings settings_;

  Phase phase_ = Phase::Lost;
  bool seen_idle_ = false;          // Lost: at the last look, and no action has ended since
  std::int64_t rests_from_ns_ = 0;  // Lost: then a position shows how it stands
  State way_;                       // what it says of its way, in its newest message
  Path held_;                       // from where it stands or drives, as far as it has steps
  std::deque<Step> steps_;          // not done
  std::uint32_t under_way_ = 0;     // of these: the first one, and perhaps the move that has been given to follow it
  std::vector<OwnOrder> orders_;
  std::uint32_t orders_told_ = 0;   // the server has so many of them
  std::int64_t waits_from_ns_ = 0;  // since then, it has waited for a Grant; only the impatient look
};

// Returns null, and says why, if there is no server, or if the plant is too large for paths.
void* create_follower(const fp_host* host, fp_controller* controller, const fp_briefing* briefing,
                      const FollowerOptions& options);

// The follower with a fault. Requires: `options` differ from the defaults in one member.
template <FollowerOptions options>
constexpr fp_agent_type faulty_follower(const char* name, const char* description) {
  return agent_type<Follower>(name, description,
                              [](const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
                                return create_follower(host, controller, briefing, options);
                              });
}

}  // namespace fleetproof::agents::central
