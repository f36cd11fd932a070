#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/catalogue.hpp"
#include "core/motion/activity.hpp"
#include "core/motion/piece.hpp"
#include "core/outcome/outcome.hpp"
#include "core/outcome/trace.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The perimeter checks that a published law makes for one drive activity.
struct DriveChecks {
  EntityId agv;
  SimTime begin{}, end{};
  std::uint64_t perimeter_checks = 0;
};

struct LawResults {
  std::vector<Violation> violations;      // ordered by (first, a, b); one entry per uninterrupted episode
  std::vector<Incident> incidents;        // everything else that the law accuses
  std::vector<ProbeCount> met;            // what the run met; from a law that counts and accuses nothing
  std::optional<double> min_clearance_m;  // exact below 0.5 m, otherwise absent; always absent in snapshot laws
  std::uint64_t perimeter_checks = 0;
  std::uint64_t distance_evaluations = 0;
  std::vector<DriveChecks> drives;  // from a law that looks at drive activities one after the other
};

// A set of kinds, of which the numbers are below 64.
template <class Kind>
class KindSet {
 public:
  constexpr KindSet() = default;
  constexpr KindSet(std::initializer_list<Kind> kinds) {
    for (const Kind kind : kinds) bits_ |= bit(kind);
  }
  static constexpr KindSet all() {
    KindSet kinds;
    kinds.bits_ = ~std::uint64_t{0};
    return kinds;
  }
  constexpr bool has(Kind kind) const { return (bits_ & bit(kind)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr std::uint64_t bits() const { return bits_; }  // that of a kind is 1 << its number
  constexpr KindSet operator|(KindSet other) const {
    other.bits_ |= bits_;
    return other;
  }

 private:
  static constexpr std::uint64_t bit(Kind kind) { return std::uint64_t{1} << (static_cast<std::uint32_t>(kind) & 63U); }
  std::uint64_t bits_ = 0;
};

// Of trace records that a law wants to read; and of activities.
using TraceKinds = KindSet<TraceKind>;
using ActivityKinds = KindSet<ActivityKind>;

// All kinds of records about messages.
inline constexpr TraceKinds kMessageKinds{TraceKind::Sent,         TraceKind::Lost,
                                          TraceKind::LostInOutage, TraceKind::LostByInterference,
                                          TraceKind::LostToSource, TraceKind::Received};

// Where laws hear records together.
class TraceSource {
 public:
  // They hear now all that has happened so far. A law calls it in `happened` if it must know that first.
  virtual void hand_over() = 0;

 protected:
  ~TraceSource() = default;
};

// A rule about what must never happen: a read-only observer of the pieces of a run, and of the records of its trace. A
// law cannot change the world or the trace.
//
// `happened` is called for records of the kinds in `reads`, and for no others: a record that no law reads costs
// nothing. Order at one instant: a record comes before the pieces that follow from it, such as the piece of a body that
// appears, or of an AGV that a load makes larger. It is the other way round for ActivityBegins and ActivityEnds, and
// for Appears and Leaves of an AGV: there, the pieces come first. But if an AGV rolls through a station, ActivityEnds
// comes before the end of the piece.
//
// The pieces of a body are contiguous while the body is on the floor. An obstacle is there from its appearance until it
// leaves. An AGV is there from kStart to the end of the run, except between `Leaves` and `Appears`, when the operator
// carries it to another place. A piece is announced when it begins, with its planned end, and again when it ends, with
// its true end. The object stays at its address until the next piece of the body begins; a law may keep a pointer to
// it. Pieces that end at the same instant are announced one after the other. At the end of the run, all pieces that are
// under way end, although their bodies stay on the floor: no record says `Leaves`. Then `finish` is called once.
class Law {
 public:
  virtual ~Law() = default;
  // How far from a piece the law looks for other bodies, from planned box to planned box: nearer ones are its company.
  // Called before the run. 0: it does not look.
  virtual double looks_within_m() const { return 0.0; }
  // A piece ends, and other bodies are near it. `others` are the pieces of these bodies that are under way, in
  // ascending order of bodies: all that are as near as the law looks, and perhaps some that are farther. So the law
  // hears of two pieces near each other once, when the first of them ends. Called before `piece_ended`.
  virtual void had_company(const Piece& piece, std::span<const Piece* const> others) { (void)piece, (void)others; }
  // Whether the law is told when a piece begins, and when one ends. Some laws need neither, and some only where a body
  // is now. Called once, before the run.
  enum class Pieces : std::uint8_t { None, Beginnings, Ends, All };
  virtual Pieces hears_pieces() const { return Pieces::All; }
  virtual void piece_started(const Piece& piece) { (void)piece; }
  virtual void piece_ended(const Piece& piece) { (void)piece; }
  virtual TraceKinds reads() const { return {}; }  // called once, before the run
  // Of the records about activities that it reads: those about activities of these kinds. Called once, before the run.
  virtual ActivityKinds reads_about() const { return ActivityKinds::all(); }
  virtual void happened(const TraceRecord& record) { (void)record; }
  // Most records are about messages, and most of those matter little. If a law returns true here, it also hears all
  // records together: in their order, a part of the trace at a time, later than pieces and `happened`, but before
  // `finish`.
  virtual bool hears_together() const { return false; }
  virtual void together(const TracePart& part) { (void)part; }
  // Called once for such a law, before the run. The source outlives the run, not the law.
  virtual void hears_from(TraceSource& source) { (void)source; }
  virtual void finish(SimTime end) { (void)end; }
  virtual LawResults findings() const = 0;
};

// Makes a law for one run of `scenario`. Requires: the scenario outlives the law.
using MakeLaw = std::unique_ptr<Law> (*)(const Scenario& scenario);

}  // namespace fleetproof
