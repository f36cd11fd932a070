#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "campaign/watch/pieces_file.hpp"
#include "campaign/watch/trace_context.hpp"
#include "core/outcome/trace.hpp"
#include "core/radio/given_deliveries.hpp"
#include "core/scenario/scenario.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// Listens to a run and keeps what the replay page shows of it.
class FilmRecorder final : public TraceSink {
 public:
  // Requires: the scenario outlives the recorder.
  explicit FilmRecorder(const Scenario& scenario);

  void record(const TraceRecord& record, std::string_view text) override;
  void piece_started(const Piece& piece) override;
  void piece_ended(const Piece& piece) override { pieces_.piece_ended(piece); }

  const std::vector<Piece>& pieces() const { return pieces_.pieces(); }
  // Call this once, after the run: what the trace said. The film has no motion yet, and no words.
  web::Film take(SimTime end);

 private:
  void note_activity(const TraceRecord& record);
  void note_message(const TraceRecord& record);
  void note_delivery(const TraceRecord& record);
  void note_arrival(const TraceRecord& record, web::Message& message);
  void note_belief(const TraceRecord& record);
  void note_waiting(const TraceRecord& record);
  void note_load(const TraceRecord& record);
  void note_order(const TraceRecord& record);
  // The body at which a record about an open transport without an AGV is shown: the first participant that hears of it.
  EntityId teller_of(const TraceRecord& record) const;
  void note_happening(const TraceRecord& record, std::string_view text);
  void note_command(const TraceRecord& record);
  void set_command(web::ActivityBar& bar, SegmentId driven);
  void end_activity(std::size_t body, SimTime at);

  struct Command {
    std::int64_t at_us = 0;
    std::uint64_t order = 0;
    SegmentId segment;
  };

  const Scenario& scenario_;
  TraceContext context_;
  PieceKeeper pieces_;
  GivenDeliveries deliveries_;
  web::Film film_;
  std::uint64_t order_ = 0;  // of the record that is told
  // A message by its number, at one receiver.
  using Reception = std::pair<std::uint32_t, std::size_t>;
  std::map<Reception, std::vector<std::int64_t>> under_way_;  // when it will arrive, since it was sent
  std::set<Reception> given_;                                 // the scenario decides its delivery
  std::map<std::size_t, web::ActivityBar> open_;              // by body
  std::map<std::size_t, std::vector<Command>> commands_;      // by body: those that have not led to a drive yet
  std::map<std::size_t, std::size_t> order_of_;               // a transport's place in film_.orders
  std::map<std::uint32_t, std::size_t> message_of_;           // a number's place in film_.messages
  std::map<std::size_t, std::optional<std::size_t>> waits_;
  std::map<EntityId, std::string> way_of_;  // "A to B", of the drive that an AGV began last
  std::map<LoadId, std::size_t> carrier_of_;
};

}  // namespace fleetproof
