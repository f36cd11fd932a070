#include "reports/markup/film_strip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/round_step.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof::html {
namespace {

constexpr double kSide_px = 156.0, kFrameLeft_px = 30.0, kFrameTop_px = 24.0, kFrameBottom_px = 42.0;
constexpr double kStripWidth_px = kFrameLeft_px + kSide_px + 2.0;
constexpr double kBottomOfFloor_px = kFrameTop_px + kSide_px;
constexpr double kRoom_m = 1.5, kMostSide_m = 120.0;
constexpr double kNamesUpTo_m = 24.0;
constexpr double kNameHeight_px = 9.0, kNameLetter_px = 5.4;  // of a name, bold
constexpr double kTouchOnPage_m = 1e-5;                       // as near as the judge measures
constexpr std::size_t kMostLanes = 300, kMostStations = 200;

// The square part of the floor that the frames show.
struct Window {
  FloorPoint low;
  double side_m = 1.0;

  double scale() const { return kSide_px / side_m; }
  double x(double x_m) const { return kFrameLeft_px + (x_m - low.x_m) * scale(); }
  double y(double y_m) const { return kBottomOfFloor_px - (y_m - low.y_m) * scale(); }
  bool has(const FloorPoint& p) const {
    return p.x_m >= low.x_m && p.x_m <= low.x_m + side_m && p.y_m >= low.y_m && p.y_m <= low.y_m + side_m;
  }
  // Whether some of the body may be in the window.
  bool is_near(const FilmBody& body) const {
    const double reach_m = std::hypot(body.length_m, body.width_m) / 2.0;
    return body.centre.x_m > low.x_m - reach_m && body.centre.x_m < low.x_m + side_m + reach_m &&
           body.centre.y_m > low.y_m - reach_m && body.centre.y_m < low.y_m + side_m + reach_m;
  }
};

Window window_of(const FilmStrip& strip) {
  FloorPoint low{1e300, 1e300}, high{-1e300, -1e300};
  const auto take = [&](bool only_involved) {
    for (const auto& frame : strip.frames) {
      for (const auto& body : frame.bodies) {
        if (only_involved ? !body.is_involved : !body.is_agv) continue;
        const double reach_m = std::hypot(body.length_m, body.width_m) / 2.0;
        low = {std::min(low.x_m, body.centre.x_m - reach_m), std::min(low.y_m, body.centre.y_m - reach_m)};
        high = {std::max(high.x_m, body.centre.x_m + reach_m), std::max(high.y_m, body.centre.y_m + reach_m)};
      }
    }
  };
  take(true);
  if (high.x_m < low.x_m) take(false);
  Window window{{0.0, 0.0}, strip.least_side_m};
  if (high.x_m < low.x_m) return window;
  const double side_m = std::max(high.x_m - low.x_m, high.y_m - low.y_m) + 2.0 * kRoom_m;
  window.side_m = std::clamp(std::ceil(side_m), strip.least_side_m, kMostSide_m);
  window.low = {(low.x_m + high.x_m - window.side_m) / 2.0, (low.y_m + high.y_m - window.side_m) / 2.0};
  return window;
}

Element note_at(const std::string& text, double x, double y, const char* anchor, double size, const char* weight) {
  return text_element("text", text,
                      {{"x", x},
                       {"y", y},
                       {"text-anchor", anchor},
                       {"font-size", size},
                       {"font-weight", weight},
                       {"fill", "currentColor"}});
}

// Three to eight squares of the grid fit into the window.
double step_of(const Window& window) { return round_step(window.side_m / 8.0); }

void add_axes(Element& svg, const Window& window) {
  const double step_m = step_of(window);
  const auto ticks = [&](double low_m, const auto& mark) {
    int number = 0;
    for (double at = std::ceil(low_m / step_m) * step_m; at <= low_m + window.side_m + 1e-9; at += step_m)
      mark(at, number++ % 2 == 0);
  };
  ticks(window.low.x_m, [&](double x_m, bool named) {
    const double x = window.x(x_m);
    svg.add(Element("path", {{"d", fmt::format("M{:.1f} {}V{}", x, kFrameTop_px, kBottomOfFloor_px)},
                             {"stroke", "currentColor"},
                             {"stroke-opacity", "0.1"}}));
    if (named) svg.add(note_at(fmt::format("{:g}", x_m + 0.0), x, kBottomOfFloor_px + 12.0, "middle", 10, "400"));
  });
  ticks(window.low.y_m, [&](double y_m, bool named) {
    const double y = window.y(y_m);
    svg.add(Element("path", {{"d", fmt::format("M{} {:.1f}H{}", kFrameLeft_px, y, kFrameLeft_px + kSide_px)},
                             {"stroke", "currentColor"},
                             {"stroke-opacity", "0.1"}}));
    if (named) svg.add(note_at(fmt::format("{:g}", y_m + 0.0), kFrameLeft_px - 4.0, y + 3.5, "end", 10, "400"));
  });
}

// A bar as long as a square of the grid, above the frame: how large the bodies are, without reading the axes.
void add_scale(Element& svg, const Window& window) {
  constexpr double kAbove_px = 11.5, kTick_px = 3.0;
  const double length_m = step_of(window), right = kFrameLeft_px + kSide_px, left = right - length_m * window.scale();
  const double y = kFrameTop_px - kAbove_px;
  svg.add(Element("path", {{"class", "scale"},
                           {"d", fmt::format("M{0:.1f} {2}v{3}M{0:.1f} {4}H{1:.1f}M{1:.1f} {2}v{3}", left, right,
                                             y - kTick_px, 2.0 * kTick_px, y)},
                           {"fill", "none"},
                           {"stroke", "currentColor"}}));
  svg.add(note_at(fmt::format("{:g} m", length_m), left - 4.0, y + 3.5, "end", 10, "400"));
}

// A lane that reaches into the window; what is outside is clipped.
std::string lane_path(const std::vector<FloorPoint>& lane, const Window& window) {
  FloorPoint low{1e300, 1e300}, high{-1e300, -1e300};
  for (const FloorPoint& p : lane) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  const bool is_outside = high.x_m < window.low.x_m || low.x_m > window.low.x_m + window.side_m ||
                          high.y_m < window.low.y_m || low.y_m > window.low.y_m + window.side_m;
  std::string path;
  if (is_outside) return path;
  for (const FloorPoint& p : lane)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", window.x(p.x_m), window.y(p.y_m));
  return path;
}

void add_map(Element& svg, const FilmStrip& strip, const Window& window) {
  std::string lanes;
  std::size_t shown = 0;
  for (const auto& lane : strip.lanes) {
    const std::string path = lane_path(lane, window);
    if (path.empty()) continue;
    if (++shown > kMostLanes) break;
    lanes += path;
  }
  if (!lanes.empty())
    svg.add(Element("path", {{"d", lanes}, {"fill", "none"}, {"stroke", "#9aa3ad"}, {"stroke-width", 1.2}}));
  std::string stations;
  shown = 0;
  for (const auto& station : strip.stations) {
    if (!window.has(station) || ++shown > kMostStations) continue;
    stations += fmt::format("M{:.1f} {:.1f}h4v4h-4z", window.x(station.x_m) - 2.0, window.y(station.y_m) - 2.0);
  }
  if (!stations.empty()) svg.add(Element("path", {{"d", stations}, {"fill", "#7b8590"}}));
}

// The corners of a body, each side moved outwards by `margin_m`, as a closed path.
std::string outline(const FilmBody& body, double margin_m, const Window& window) {
  const double half_length_m = body.length_m / 2.0 + margin_m, half_width_m = body.width_m / 2.0 + margin_m;
  std::string path;
  for (const auto& [along, aside] : {std::pair{1, 1}, std::pair{1, -1}, std::pair{-1, -1}, std::pair{-1, 1}}) {
    const double x_m =
        body.centre.x_m + along * half_length_m * body.heading.x_m - aside * half_width_m * body.heading.y_m;
    const double y_m =
        body.centre.y_m + along * half_length_m * body.heading.y_m + aside * half_width_m * body.heading.x_m;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", window.x(x_m), window.y(y_m));
  }
  return path + "Z";
}

// A wedge from the middle to the front, so that the heading shows without colours.
std::string nose(const FilmBody& body, const Window& window) {
  const auto point = [&](double along_m, double aside_m) {
    return fmt::format("{:.1f} {:.1f}",
                       window.x(body.centre.x_m + along_m * body.heading.x_m - aside_m * body.heading.y_m),
                       window.y(body.centre.y_m + along_m * body.heading.y_m + aside_m * body.heading.x_m));
  };
  const double front_m = 0.46 * body.length_m, back_m = 0.1 * body.length_m, half_m = 0.34 * body.width_m;
  return fmt::format("M{}L{}L{}Z", point(front_m, 0.0), point(back_m, half_m), point(back_m, -half_m));
}

void add_body(Element& svg, const FilmBody& body, double safety_distance_m, const Window& window) {
  if (body.is_involved && safety_distance_m > 0.0) {
    svg.add(Element("path", {{"d", outline(body, safety_distance_m, window)},
                             {"fill", "none"},
                             {"stroke", "#c4562f"},
                             {"stroke-width", 1},
                             {"stroke-dasharray", "3 2"}}));
  }
  const char* fill = body.is_involved ? "#e08a5b" : (body.is_agv ? "#a9bdd2" : "#b9b3a4");
  svg.add(Element("path", {{"d", outline(body, 0.0, window)},
                           {"fill", fill},
                           {"stroke", "#2b3138"},
                           {"stroke-width", body.is_involved ? 1.4 : 0.7}}));
  if (body.is_agv) svg.add(Element("path", {{"d", nose(body, window)}, {"fill", "#2b3138"}}));
}

// The names in one frame. A name that would cover one before it is left out.
class Names {
 public:
  explicit Names(const Window& window) : window_(window) {}

  void add(Element& svg, const FilmBody& body, bool above) {
    if (window_.side_m > kNamesUpTo_m || !window_.has(body.centre)) return;
    const double reach_m = std::hypot(body.length_m, body.width_m) / 2.0;
    const double over = window_.y(body.centre.y_m + reach_m) - 2.0;
    const double under = window_.y(body.centre.y_m - reach_m) + kNameHeight_px;
    // Near an edge a name moves inwards, so that it is not cut.
    const double half_px = std::min(kNameLetter_px * static_cast<double>(body.name.size()), kSide_px) / 2.0;
    const double x =
        std::clamp(window_.x(body.centre.x_m), kFrameLeft_px + half_px, kFrameLeft_px + kSide_px - half_px);
    for (int line = 0; line < (body.is_involved ? kMostLines : 1); ++line) {
      const double aside = kNameHeight_px * line;
      for (const bool is_over : {above, !above}) {
        const Place place{x, is_over ? over - aside : under + aside, half_px};
        if ((is_over != above && !body.is_involved) || !is_free(place)) continue;
        taken_.push_back(place);
        svg.add(note_at(body.name, x, place.y, "middle", 9, body.is_involved ? "600" : "400"));
        return;
      }
    }
  }

 private:
  static constexpr int kMostLines = 6;  // that the name of a body involved may stand away from it
  struct Place {
    double x, y, half_px;
  };
  bool is_free(const Place& wanted) const {
    const bool is_inside = wanted.y - kNameHeight_px >= kFrameTop_px && wanted.y <= kBottomOfFloor_px;
    return is_inside && std::ranges::none_of(taken_, [&](const Place& place) {
             return std::abs(place.x - wanted.x) < place.half_px + wanted.half_px &&
                    std::abs(place.y - wanted.y) < kNameHeight_px;
           });
  }
  const Window& window_;
  std::vector<Place> taken_;
};

// Of two bodies side by side, one has its name above it and one below, so that the names do not cover each other.
void add_bodies(Element& svg, const FilmStrip& strip, const FilmFrame& frame, const Window& window) {
  const FilmBody* highest = nullptr;
  for (const auto& body : frame.bodies) {
    if (body.is_involved && (highest == nullptr || body.centre.y_m > highest->centre.y_m)) highest = &body;
  }
  const auto each = [&](bool involved, auto draw_it) {
    for (const auto& body : frame.bodies) {
      if (body.is_involved == involved && window.is_near(body)) draw_it(body);
    }
  };
  for (const bool involved : {false, true})
    each(involved, [&](const FilmBody& body) { add_body(svg, body, strip.safety_distance_m, window); });
  Names names(window);
  for (const bool involved : {true, false})
    each(involved, [&](const FilmBody& body) { names.add(svg, body, &body == highest); });
}

std::string clearance_line(const FilmFrame& frame) {
  if (!frame.clearance_m) return frame.without_clearance;
  if (*frame.clearance_m <= kTouchOnPage_m) return "they touch";
  // As the archive files it, in whole micrometres rounded down, and then as every page does. A sum of doubles may miss
  // the micrometre by its last digits.
  constexpr double kLastDigits_um = 1e-5;
  return metres_text(static_cast<std::int64_t>(std::floor(*frame.clearance_m * 1e6 + kLastDigits_um))) + " apart";
}

// A drawing in a drawing shows nothing outside its own borders.
Element floor_of(const FilmStrip& strip, const FilmFrame& frame, const Window& window) {
  Element floor("svg", {{"x", kFrameLeft_px},
                        {"y", kFrameTop_px},
                        {"width", kSide_px},
                        {"height", kSide_px},
                        {"viewBox", fmt::format("{} {} {} {}", kFrameLeft_px, kFrameTop_px, kSide_px, kSide_px)}});
  add_map(floor, strip, window);
  add_bodies(floor, strip, frame, window);
  return floor;
}

Element frame_of(const FilmStrip& strip, const FilmFrame& frame, const Window& window) {
  const std::string time = fmt::format("{:.3f} s", frame.time_s), apart = clearance_line(frame);
  Element svg("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                      {"role", "img"},
                      {"aria-label", "at " + time + (apart.empty() ? "" : ", " + apart)},
                      {"class", "frame"},
                      {"width", kStripWidth_px},
                      {"height", kBottomOfFloor_px + kFrameBottom_px},
                      {"viewBox", fmt::format("0 0 {} {}", kStripWidth_px, kBottomOfFloor_px + kFrameBottom_px)},
                      {"font-family", "system-ui, sans-serif"}});
  add_axes(svg, window);
  add_scale(svg, window);
  svg.add(floor_of(strip, frame, window));
  svg.add(Element("rect", {{"x", kFrameLeft_px},
                           {"y", kFrameTop_px},
                           {"width", kSide_px},
                           {"height", kSide_px},
                           {"fill", "none"},
                           {"stroke", frame.is_worst ? "#c4562f" : "currentColor"},
                           {"stroke-opacity", frame.is_worst ? "1" : "0.5"},
                           {"stroke-width", frame.is_worst ? 3 : 1}}));
  svg.add(note_at("m", kFrameLeft_px - 4.0, kFrameTop_px - 8.0, "end", 10, "400"));
  svg.add(note_at("m", kFrameLeft_px + kSide_px, kBottomOfFloor_px + 22.0, "end", 10, "400"));
  svg.add(note_at(time, kFrameLeft_px, kFrameTop_px - 8.0, "start", 12, "600"));
  if (!apart.empty()) svg.add(note_at(apart, kFrameLeft_px, kBottomOfFloor_px + 34.0, "start", 12, "600"));
  return svg;
}

// Of frames in a row that show the same, the worst instant, else the first one.
std::vector<const FilmFrame*> frames_that_differ(const FilmStrip& strip, const Window& window) {
  std::vector<const FilmFrame*> kept;
  std::string before;
  for (const FilmFrame& frame : strip.frames) {
    std::string now = floor_of(strip, frame, window).str() + clearance_line(frame);
    if (kept.empty() || now != before) {
      kept.push_back(&frame);
    } else if (frame.is_worst) {
      kept.back() = &frame;
    }
    before = std::move(now);
  }
  return kept;
}

}  // namespace

Element draw(const FilmStrip& strip) {
  Element whole("div", {{"class", "film"}});
  const Window window = window_of(strip);
  const std::vector<const FilmFrame*> kept = frames_that_differ(strip, window);
  for (const FilmFrame* frame : kept) whole.add(frame_of(strip, *frame, window));
  if (kept.size() < strip.frames.size())
    whole.add(text_element("p",
                           fmt::format("From {:.3f} s to {:.3f} s. While nothing moves here, there is no further "
                                       "picture.",
                                       strip.frames.front().time_s, strip.frames.back().time_s),
                           {{"class", "key"}}));
  if (!strip.note.empty()) whole.add(text_element("p", strip.note, {{"class", "key"}}));
  return whole;
}

}  // namespace fleetproof::html
