#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/engine/agv.hpp"
#include "core/engine/briefings.hpp"
#include "core/engine/event_queue.hpp"
#include "core/engine/simulation.hpp"
#include "core/engine/world.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_channel.hpp"

namespace fleetproof {

class Engine;

// What the draws of the motion stream are for; each is keyed by topic, AGV and number.
enum class MotionTopic : std::uint32_t { Speed = 1, Settling, Transfer, Position };

}  // namespace fleetproof

// The handle an agent holds: which AGV of which run.
struct fp_controller {
  fleetproof::Engine* engine = nullptr;
  fleetproof::AgvId agv;
};

namespace fleetproof {

// The event loop of one run. A local variable of simulate(); thousands can live at once.
// Its member functions stand in files by subject: engine.cpp (the loop), engine_motion.cpp (actions), engine_drive.cpp
// (drives), engine_battery.cpp, engine_faults.cpp (faults, halts, bodies that come and go), engine_operator.cpp,
// engine_scanner.cpp, engine_radio.cpp (messages), engine_agents.cpp (activations and the agent's clock).
// controller_table.cpp translates the C interface.
class Engine {
 public:
  Engine(const Scenario& scenario, const fp_agent_type& agent, std::span<const std::unique_ptr<Law>> laws,
         TraceSink* sink, const char* agent_config);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  void run();
  Outcome outcome();

  // ---- what a controller call does, called by the C interface
  Agv& agv(AgvId id) { return agvs_[id.index()]; }
  // Counts the call against the activation's limit; false: the agent has been given up.
  bool admit_call(Agv& agv);
  std::int32_t act(Agv& agv, fp_call call, std::uint32_t segment);
  std::int32_t send(Agv& agv, std::string_view bytes, std::uint32_t receiver);
  std::int32_t read_message(Agv& agv, fp_message& out);
  std::int32_t set_timer(Agv& agv, std::uint32_t number, std::int64_t at_ns);
  std::int32_t declare_safe_mode(Agv& agv, bool on);
  std::int32_t declare_waiting(Agv& agv, std::uint32_t for_whom);
  void note(Agv& agv, TraceKind kind, std::string_view text);
  Pose perceived_pose(const Agv& agv) const;
  fp_action action_of(const Agv& agv) const;
  std::int64_t agent_now_ns(const Agv& agv) const { return agv.clock.shows_ns(now_); }
  double battery_of(const Agv& agv) const;
  bool is_loaded(const Agv& agv) const { return world_.carried_load(agv.id).valid(); }
  std::uint64_t random(const Agv& agv, std::uint32_t purpose, std::uint64_t index) const;

 private:
  void trace(EntityId entity, TraceKind kind, std::uint64_t a = 0, std::uint64_t b = 0, std::string_view text = {},
             std::uint32_t bytes = 0);
  void handle(const Event& event);
  void start();
  void close_books();
  void file_findings();

  const VehicleType& type_of(const Agv& agv) const { return scenario_.type_of(scenario_.agvs[agv.id.index()]); }
  void progressed(Agv& agv) { last_progress_ = agv.last_progress = now_; }
  double motion_draw(MotionTopic topic, const Agv& agv, std::uint32_t number) const;

  // ---- actions
  void begin_action(Agv& agv, fp_call call, std::uint32_t segment);
  void begin_plan(Agv& agv, fp_call call, const Lane* lane, double entry_mps);
  void continue_plan(Agv& agv, double entry_mps);
  void finish_action(Agv& agv, double speed_mps);
  void turn_or_drive(Agv& agv, double entry_mps);
  void begin_settling(Agv& agv);
  void begin_stay(Agv& agv);
  Piece standing_piece(const Agv& agv, const Pose& pose) const;
  void set_piece(Agv& agv, const Piece& piece);
  void stand(Agv& agv, const Pose& pose);
  void begin_activity(Agv& agv, Activity activity, std::uint64_t subject);
  void activity_ends(Agv& agv);
  void end_activity(Agv& agv, bool as_planned);
  void transfer(Agv& agv, const ContainmentEvolution& transfer);
  void bodies_touch(EntityId a, std::uint64_t prediction);
  void stop_for_good(EntityId id);
  void predict_touches(EntityId id);
  bool is_current(const TouchPrediction& touch) const;
  void action_done(Agv& agv, fp_result result);

  // ---- drives
  bool aligned(const Lane& arriving, const Lane& leaving) const;
  void begin_drive(Agv& agv, double entry_mps);
  void plan_rest_of_drive(Agv& agv, double from_m, double speed_mps);
  double exit_speed_mps(const Agv& agv) const;
  Piece first_leg_piece(const Agv& agv) const;
  void begin_leg(Agv& agv);
  void replan_drive(Agv& agv);
  void leg_ends(Agv& agv);
  void roll_on(Agv& agv, double speed_mps);
  void drive_halts(Agv& agv, double way_m);
  void take_next(Agv& agv, fp_call call, std::uint32_t segment);

  // ---- batteries
  void settle_battery(Agv& agv);
  void predict_empty_battery(Agv& agv);
  void battery_empty(Agv& agv);

  // ---- faults
  void schedule_faults();
  void load_taken_up(const Agv& agv, TransportId transport);
  void fault_strikes(Agv& agv, std::uint64_t number);
  void fault_over(Agv& agv, std::uint64_t number);
  void fault_halt_ends(Agv& agv, std::uint64_t number);
  std::uint64_t halt(Agv& agv, Halt::Reason reason);
  void end_halt(Agv& agv, std::uint64_t number);
  void end_halts(Agv& agv, Halt::Reason reason);
  void body_appears(EntityId id);
  void body_leaves(EntityId id);
  bool load_drops(Agv& agv, const Fault& fault, std::uint64_t number);
  void move_load(LoadId id, Holder to);
  void trace_load(LoadId id);
  void agent_goes_away(Agv& agv);
  void agent_comes_back(Agv& agv);

  // ---- the operator
  Duration until_help_comes(const Agv& agv, std::uint32_t topic, std::uint32_t number) const;
  void call_operator(Agv& agv, Assist what, std::uint64_t halt);
  void operator_comes(Agv& agv, Assist what, std::uint64_t stamp);
  void assisted(const Agv& agv, Assist what);
  void change_battery(Agv& agv);
  void take_off_floor(Agv& agv);
  void look_for_place(Agv& agv);
  void is_set_down(Agv& agv);
  bool is_on_the_way(const OrientedRectangle& place, double margin_m) const;
  bool transports_are_open() const;
  bool has_open_transport(const Agv& agv) const;
  bool stands_still() const;
  void operator_looks();
  Agv* longest_idle();
  std::uint64_t standstill_stamp() const;
  void help_at_standstill(Agv& agv, std::uint64_t stamp);

  // ---- scanner
  void scanner_wakes(Agv& agv);
  double field_length_m(const Agv& agv) const;
  std::optional<EntityId> intruder(const Agv& agv, double length_m) const;
  void scanner_looks(Agv& agv);
  void scanner_stops(Agv& agv, EntityId body);

  // ---- radio
  void transmit(Agv& sender, std::uint32_t slot, std::uint32_t receiver);
  void transmit_to(Agv& sender, AgvId receiver, std::uint32_t slot, const Pose& from, std::uint32_t ordinal);
  void message_arrives(Agv& receiver, std::uint32_t payload);
  void air_time_ends(Agv& receiver, std::uint32_t slot);
  bool is_drowned(AgvId receiver, const Message& message) const;
  void drop_message_in_hand(Agv& agv);

  // ---- agents
  void tell(Agv& agv, fp_event event);
  void activate(Agv& agv, const fp_event& event);
  void wake(Agv& agv);
  void agent_is_free(Agv& agv);
  void give_up(Agv& agv, bool hang, std::string_view message);
  bool takes_effect_now(const Agv& agv) const { return agv.cost == Duration::zero(); }
  void take_effect_later(Agv& agv, PendingCall call);
  void call_takes_effect(Agv& agv);
  void order_released(Agv& agv, std::uint64_t transport);
  void tell_order(Agv& agv, TransportId id, const TransportOrder& order);
  void renew_briefing(const Agv& agv);
  void destroy_agent(Agv& agv);
  void timer_goes_off(Agv& agv, std::uint32_t number, std::uint64_t stamp);
  void apply_safe_mode(Agv& agv, bool on, SimTime at);
  void apply_timer(Agv& agv, std::uint32_t number, std::int64_t at_ns);

  const Scenario& scenario_;
  const fp_agent_type& agent_type_;
  std::span<const std::unique_ptr<Law>> laws_;
  std::vector<std::pair<Law*, TraceKinds>> readers_;  // of the trace
  TraceKinds read_by_laws_;
  TraceSink* sink_;
  Briefings briefings_;
  Radio radio_;
  RadioChannel channel_;
  bool unlimited_range_;
  std::uint64_t agent_key_, motion_key_;
  World world_;
  EventQueue queue_;
  MessagePool messages_;
  TraceDigest digest_;
  std::vector<Agv> agvs_;
  std::vector<fp_controller> controllers_;
  std::vector<TouchPrediction> touches_;
  std::vector<std::uint64_t> first_transport_;  // by AGV: number of its first transport
  std::vector<std::uint64_t> fault_halts_;      // by fault: number of the halt it caused
  std::vector<bool> fault_came_;                // likewise: those counted from a pick
  SimTime now_ = kStart;
  SimTime last_progress_ = kStart;
  SimTime still_since_ = kStart;  // when the operator last saw somebody at work, or restarted an agent
  bool standstill_called_ = false;
  std::uint32_t standstills_ = 0;  // he was called to
  ProbeTally probes_;
  Outcome outcome_;
};

extern const fp_host kHost;

}  // namespace fleetproof
