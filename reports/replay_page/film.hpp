#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/markup/film_strip.hpp"

namespace fleetproof::web {

// One run as the replay page needs it: plain data, in whole numbers. Times count from the start of the run. Places are
// micrometres on the floor, directions microradians from the x axis to the left. `body` is an index into Film::bodies.

// A line on the floor that AGVs drive, by points in order of the way along it. Between two points it is the cubic curve
// that has their places and directions, and whose speed at both ends is the way between them.
struct TrackPoint {
  std::int64_t x_um = 0, y_um = 0, heading_urad = 0, way_um = 0;
};
struct Track {
  std::string name;
  std::vector<TrackPoint> points;
};

struct FilmStation {
  std::string name;
  std::int64_t x_um = 0, y_um = 0;
};

enum class BodyKind : std::uint8_t { Agv, Obstacle, Load, Computer };
struct FloorPlace {
  std::int64_t x_um = 0, y_um = 0;
};
struct Body {
  std::string name;
  BodyKind kind = BodyKind::Agv;
  std::optional<FloorPlace> antenna = std::nullopt;  // of a computer that is not connected everywhere
};

// The length along the heading, and from the reference point to the centre.
struct Outline {
  std::int64_t length_um = 0, width_um = 0, centre_ahead_um = 0;
  friend bool operator==(const Outline&, const Outline&) = default;
};

// A part of a motion with constant acceleration: from `begin_us` after the beginning of the piece, the way is
// way + speed d + acceleration d^2 / 2 after d seconds. In micrometres of a drive, in microradians of a turn.
struct Phase {
  std::int64_t begin_us = 0, way = 0, speed = 0, acceleration = 0;
};

// A body rests, drives or turns. The pieces of a body follow each other while it is on the floor.
enum class Moving : std::uint8_t { Rests, Drives, Turns };
struct MotionPiece {
  std::size_t body = 0, outline = 0;
  Moving moving = Moving::Rests;
  std::int64_t begin_us = 0, end_us = 0;              // the true end, also if the motion was cut short
  std::int64_t x_um = 0, y_um = 0, heading_urad = 0;  // at the beginning
  std::size_t track = 0;                              // of a drive
  bool against_track = false, tail_first = false;     // of a drive
  std::int64_t way_begin_um = 0;                      // of a drive, from its own first end of the track
  std::int64_t planned_way = 0;                       // of a drive in micrometres; of a turn in microradians, signed
  std::vector<Phase> phases;
};

// `order`: the place in the trace of the run. Of two things at one instant, the cause has the smaller one.
struct ActivityBar {
  std::size_t body = 0;
  std::int64_t begin_us = 0, end_us = 0;
  std::string kind, details;
  std::uint64_t begin_order = 0, end_order = 0;
  std::optional<std::int64_t> commanded_us = std::nullopt;  // when the agent called for it, if that is known
  std::uint64_t commanded_order = 0;
};

// What an agent says of itself from this instant on. An empty word: nothing.
struct Declared {
  std::size_t body = 0;
  std::int64_t at_us = 0;
  std::string word;
  std::uint64_t order = 0;
};
struct Waiting {
  std::size_t body = 0;
  std::int64_t at_us = 0;
  std::optional<std::size_t> for_whom;
  std::uint64_t order = 0;
};
// Whether an AGV has a load from this instant on.
struct Loaded {
  std::size_t body = 0;
  std::int64_t at_us = 0;
  bool on = false;
};

enum class Receipt : std::uint8_t {
  Received,
  LostByChance,
  LostInOutage,
  LostByInterference,
  LostToSource,
  LostAsGiven
};
// A message that arrives twice at one receiver has two arrivals there. An arrival after the end of the run: the message
// is still under way.
struct Arrival {
  std::size_t receiver = 0;
  Receipt receipt = Receipt::Received;
  std::int64_t after_us = 0;  // since the message was sent, also of a loss
  std::uint64_t order = 0;
  bool is_given = false;  // the scenario decides it
};
struct Message {
  std::uint32_t number = 0, bytes = 0;
  std::size_t sender = 0;
  std::optional<std::size_t> receiver;  // none: all in range
  std::int64_t sent_us = 0;
  std::string kind;
  std::string content;  // in the words of its sender; may be empty
  std::vector<Arrival> arrivals;
  std::uint64_t order = 0;
  bool is_described = true;  // else its kind is its size
};

// Where an agent believes another AGV to have been at `as_of_us`, from `at_us` on.
struct Belief {
  std::size_t body = 0, about = 0;
  std::int64_t at_us = 0, as_of_us = 0, x_um = 0, y_um = 0;
  std::optional<std::int64_t> heading_urad;
};

struct Happening {
  std::size_t body = 0;
  std::int64_t at_us = 0;
  std::string what, details;
  bool is_fault = false, is_note = false;  // a note: what an agent wrote for its authors
  std::uint64_t order = 0;
};

struct TooClose {
  std::size_t a = 0, b = 0;
  std::int64_t first_us = 0, last_us = 0, closest_us = 0, clearance_um = 0, relative_speed_um_s = 0, x_um = 0, y_um = 0;
  bool contact = false;
  std::string level;
};

struct ClearancePoint {
  std::int64_t at_us = 0, clearance_um = 0;
};
// The clearance of two bodies over some time.
struct ClearanceCurve {
  std::size_t a = 0, b = 0;
  std::vector<ClearancePoint> points;
};

// The two bodies of a run without a violation that came closest.
struct Nearest {
  std::size_t a = 0, b = 0;
  std::int64_t at_us = 0, clearance_um = 0;
};

struct Order {
  std::size_t body = 0;
  std::uint32_t number = 0;
  std::string from, to;
  std::int64_t released_us = 0;
  std::optional<std::int64_t> done_us;
};

// A name and what it is: a line of the head of the page, or of its glossary.
struct FilmFact {
  std::string name, value;
};

// From when to when the page has all of something: of the bodies involved, and of the others. An end beyond that of the
// run: to its end.
struct Kept {
  static constexpr std::int64_t kAlways_us = std::int64_t{1} << 50;
  std::int64_t involved_from_us = 0, involved_to_us = kAlways_us, others_from_us = 0, others_to_us = kAlways_us;
};

struct Film {
  std::string title, command;
  bool failed = false;
  std::vector<std::string> story;  // what happened, in sentences, the most important first
  std::vector<FilmFact> facts;
  std::vector<FilmFact> glossary;                      // what words of agents mean, if somebody says so
  std::int64_t end_us = 0, focus_us = 0, open_us = 0;  // of the run; of the failure; what the page shows first
  std::vector<std::size_t> involved;                   // in the failure
  std::int64_t safety_distance_um = 0;
  std::int64_t floor_low_x_um = 0, floor_low_y_um = 0, floor_high_x_um = 0, floor_high_y_um = 0;
  std::vector<Track> tracks;
  std::vector<FilmStation> stations;
  std::vector<Body> bodies;
  std::vector<Outline> outlines;
  std::vector<MotionPiece> pieces;
  std::vector<ActivityBar> activities;
  std::vector<Declared> states;
  std::vector<Waiting> waits;
  std::vector<Loaded> loads;
  std::vector<Message> messages;
  std::vector<Belief> beliefs;
  std::vector<Happening> happenings;
  std::vector<TooClose> violations;
  std::vector<ClearanceCurve> clearances;  // of the first violations; without one, of the nearest pair
  std::optional<Nearest> nearest;
  std::vector<Order> orders;
  Kept kept_messages, kept_beliefs, kept_states, kept_waits;
  std::vector<std::string> left_out;  // what the page does not have of the run, in sentences
  html::FilmStrip strip;

  bool is_computer(std::size_t body) const { return bodies[body].kind == BodyKind::Computer; }
  // Nothing went wrong: the pair that came closest is all there is to show.
  bool is_about_nearest() const { return !failed && involved.empty() && nearest.has_value(); }
  // The bodies that the page is about.
  std::vector<std::size_t> subject() const {
    if (!involved.empty() || !nearest) return involved;
    return {nearest->a, nearest->b};
  }
};

}  // namespace fleetproof::web
