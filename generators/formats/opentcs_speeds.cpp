#include "generators/formats/opentcs_speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "core/base/outside_text.hpp"
#include "core/scenario/vehicle_fields.hpp"
#include "generators/text/name_list.hpp"
#include "generators/text/xml_text.hpp"

namespace fleetproof {
namespace {

constexpr double kLongDrive_s = 600.0;  // an AGV that drives along one path for longer is told

std::optional<double> velocity_mps(const XmlText& xml, const pugi::xml_node& path, const char* name) {
  const auto velocity = path.attribute(name);
  if (!xml.has(path, name)) return std::nullopt;
  double velocity_mmps = 0.0;
  if (!read_number(velocity.value(), velocity_mmps) || !(velocity_mmps >= 0.0))
    xml.refuse(path, fmt::format("{} is {}; expected a whole number of mm/s, or 0", name, in_quotes(velocity.value())));
  return velocity_mmps / 1000.0;
}

double limit_mps(double velocity_mps) { return velocity_mps <= kFastest ? velocity_mps : 0.0; }

// The longer one of its two directions; 0 if neither has a limit.
double drive_s(const Layout& layout, const Segment& segment) {
  double slowest_mps = segment.speed_limit_mps;
  if (const double back_mps = segment.back_speed_limit_mps; segment.bidirectional && back_mps > 0.0)
    slowest_mps = slowest_mps > 0.0 ? std::min(slowest_mps, back_mps) : back_mps;
  return slowest_mps > 0.0 ? segment_curve(layout, segment).length_m() / slowest_mps : 0.0;
}

}  // namespace

bool OpenTcsSpeeds::say_travel(const pugi::xml_node& path, Segment& segment) {
  const auto forward = velocity_mps(xml_, path, "maxVelocity"),
             backward = velocity_mps(xml_, path, "maxReverseVelocity");
  if (!forward) silent_.push_back(segment.name);
  if (std::max(forward.value_or(0.0), backward.value_or(0.0)) > kFastest) unlimited_.push_back(segment.name);
  const bool reverses = backward.value_or(0.0) > 0.0;
  if (forward.value_or(1.0) > 0.0) {
    segment.speed_limit_mps = limit_mps(forward.value_or(0.0));
    segment.bidirectional = reverses;
    if (!reverses) return true;
    segment.back_travel = Travel::Backward;
    segment.back_speed_limit_mps = limit_mps(*backward);
    return true;
  }
  if (!reverses) return false;
  std::swap(segment.from, segment.to);
  std::ranges::reverse(segment.control_points_m);
  segment.travel = Travel::Backward;
  segment.speed_limit_mps = limit_mps(*backward);
  return true;
}

std::vector<std::string> OpenTcsSpeeds::sentences(const Layout& layout) const {
  std::vector<std::string> sentences, slow;
  if (!silent_.empty())
    sentences.push_back(fmt::format("{} paths give no maxVelocity; they are driven forward without a limit ({})",
                                    silent_.size(), name_list(silent_)));
  if (!unlimited_.empty())
    sentences.push_back(fmt::format("{} paths have a velocity above {:g} m/s, which counts as no limit ({})",
                                    unlimited_.size(), kFastest, name_list(unlimited_)));
  double longest_s = 0.0;
  std::string slowest;
  for (const auto& segment : layout.segments) {
    const double time_s = drive_s(layout, segment);
    if (time_s > kLongDrive_s) slow.push_back(segment.name);
    if (time_s > longest_s) longest_s = time_s, slowest = segment.name;
  }
  if (!slow.empty())
    sentences.push_back(
        fmt::format("an AGV takes longer than {:g} minutes for {} paths ({}), and {:.0f} minutes for the slowest, {}; "
                    "check maxVelocity and maxReverseVelocity, which are in mm/s",
                    kLongDrive_s / 60.0, slow.size(), name_list(slow), longest_s / 60.0, in_quotes(slowest)));
  return sentences;
}

}  // namespace fleetproof
