#include "campaign/watch/moment_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "campaign/watch/run_text.hpp"
#include "campaign/watch/trace_context.hpp"
#include "core/base/outside_text.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostLetters = 135, kMostActivityLines = 8, kMostMeetings = 10;
constexpr double kTouching_m = 1e-5;  // as near as the judge measures

std::string interval_text(SimTime begin, SimTime end) { return instant_text(begin) + " to " + instant_text(end); }

std::string clearance_text(const Meeting& meeting, const Scenario& scenario) {
  if (meeting.clearance_m <= kTouching_m) return "now they touch";
  // Cut: what is below the safety distance never reads as if it were not. A sum of doubles may miss the micrometre.
  constexpr double kLastDigits_um = 1e-5;
  const double shown_m = std::floor((meeting.clearance_m * 1e6 + kLastDigits_um) / 1e3) / 1e3;
  return fmt::format(
      "now {:.3f} m apart{}", shown_m,
      meeting.is_too_close ? ", below the safety distance of " + distance_text(scenario.law.safety_distance_m) : "");
}

std::string meeting_text(const Meeting& meeting, const Scenario& scenario) {
  const std::string a = moment_name(scenario, meeting.a), b = moment_name(scenario, meeting.b);
  std::string text = a + " and " + b + ": ";
  if (meeting.perimeters_overlap)
    text += "activity perimeters overlap, both in progress " + interval_text(meeting.common_begin, meeting.common_end) +
            "; ";
  if (meeting.stands_in_perimeter) text += fmt::format("{} stands in the activity perimeter of {}; ", b, a);
  return text + clearance_text(meeting, scenario);
}

// As many to a line as fit; beyond the last line their number.
void add_activities(std::vector<std::string>& lines, const std::vector<std::string>& activities) {
  std::string line;
  for (std::size_t i = 0; i < activities.size(); ++i) {
    if (!line.empty() && line.size() + activities[i].size() + 2 > kMostLetters) {
      lines.push_back(std::move(line));
      line.clear();
      if (lines.size() == kMostActivityLines) {
        lines.push_back(fmt::format("and {} more", activities.size() - i));
        return;
      }
    }
    line += (line.empty() ? "" : "; ") + activities[i];
  }
  if (!line.empty()) lines.push_back(std::move(line));
}

}  // namespace

std::string moment_name(const Scenario& scenario, EntityId id) {
  return printable(body_name(scenario, id, "load of "), 20);
}

std::string activity_text(const Scenario& scenario, const Piece& piece) {
  const LogicalMap& map = *scenario.map;
  std::string what = "turns";
  if (piece.manner == Manner::Drive) {
    const Lane& lane = lane_of(map, piece);
    what = fmt::format("drives{} from {} to {}", lane.is_backward() ? " backward" : "",
                       printable(map.station(lane.from).name, 20), printable(map.station(lane.to).name, 20));
  }
  return fmt::format("{} {}, {}", moment_name(scenario, piece.entity), what, interval_text(piece.begin, piece.end));
}

std::vector<std::string> moment_lines(const Moment& moment, const Scenario& scenario) {
  std::vector<std::string> lines, activities;
  for (const MomentBody& body : moment.bodies) {
    for (const MomentPiece& one : body.pieces) {
      if (one.moves()) activities.push_back(activity_text(scenario, one.piece));
    }
  }
  if (activities.empty()) lines.emplace_back("No activity moves a body at this instant.");
  add_activities(lines, activities);
  const std::size_t shown = std::min(moment.meetings.size(), kMostMeetings);
  for (std::size_t i = 0; i < shown; ++i) lines.push_back(meeting_text(moment.meetings[i], scenario));
  if (shown < moment.meetings.size())
    lines.push_back(fmt::format("and {} more such pairs", moment.meetings.size() - shown));
  if (moment.meetings.empty() && !activities.empty())
    lines.emplace_back("No activity perimeter has another one or a body in it.");
  return lines;
}

}  // namespace fleetproof
