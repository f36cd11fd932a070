#include "campaign/watch/moment_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "campaign/watch/moment_words.hpp"
#include "core/base/markup_text.hpp"
#include "generators/map/layout_svg.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

constexpr double kLine_px = 18.0, kLegend_px = 30.0;
constexpr double kNameInside_px = 16.0;                    // of a body that is so wide
constexpr double kLetter_px = 7.2;                         // of a name
constexpr double kNameHeight_px = 12.0, kMostLines = 4.0;  // so far from its body a name may stand
// An activity perimeter, its border and its hull. Those of activities that conflict are warm.
struct Tint {
  const char *border, *perimeter, *hull;
};
constexpr Tint kCold = {"#5f86ad", "#dbe7f3", "#b9d0e6"}, kWarm = {"#c4562f", "#fbe3d6", "#f2bf9f"};
constexpr const char *kAgv = "#7fa3c7", *kThing = "#b9b3a4", *kLoad = "#c99a3f", *kDark = "#2b3138",
                     *kTooClose = "#c00000";

// The corners anticlockwise on the floor, front left first.
std::vector<Vec2> corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading,
             aside = body.half_width_m * Vec2(-body.heading.y(), body.heading.x());
  return {body.centre_m + along + aside, body.centre_m - along + aside, body.centre_m - along - aside,
          body.centre_m + along - aside};
}

// A name that has its place.
struct Written {
  Vec2 at_px;
  double letters;
};

class MomentPicture {
 public:
  MomentPicture(const Moment& moment, const Scenario& scenario)
      : moment_(moment),
        scenario_(scenario),
        lines_(moment_lines(moment, scenario)),
        view_(view_of(scenario.map->layout(), kLegend_px + kLine_px * static_cast<double>(lines_.size()) + 8.0)),
        reach_px_(scenario.law.safety_distance_m * view_.scale()) {
    for (const Meeting& meeting : moment.meetings) {
      if (meeting.perimeters_overlap || meeting.stands_in_perimeter) conflicting_.insert({meeting.a, meeting.b});
      if (meeting.is_too_close) too_close_.insert({meeting.a, meeting.b});
    }
  }

  std::string draw() {
    OnFloor on_floor;
    on_floor.title = fmt::format("{}, T = {:g} s", scenario_.name, to_seconds(moment_.at));
    for (const MomentBody& body : moment_.bodies) {
      for (const MomentPiece& piece : body.pieces) {
        if (piece.moves()) activity(piece);
      }
    }
    on_floor.under_the_map = std::exchange(text_, {});
    for (const MomentBody& body : moment_.bodies) draw(body);
    legend();
    double y = words_top_px(view_) + kLegend_px + 12.0;
    for (const std::string& line : lines_) {
      add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12.5" fill="#222222">{}</text>)", view_.margin_px(), y,
          escaped_for_markup(line));
      y += kLine_px;
    }
    on_floor.on_the_map = std::move(text_);
    return floor_svg(scenario_.map->layout(), view_, on_floor);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  std::string path(const std::vector<Vec2>& points_m) const {
    std::string path;
    for (const Vec2& point_m : points_m) {
      const Vec2 p = view_.pixel(point_m);
      path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", p.x(), p.y());
    }
    return path + "Z";
  }

  // A stroke as wide as twice the safety distance, with round joins, covers all that is so near to the hull: the
  // activity perimeter. A wider one below it is its border.
  void swept(const std::string& hull, double reach_px, const Tint& tint) {
    const auto stroke = [&](const char* colour, double width_px) {
      add(R"(<path d="{0}" fill="{1}" stroke="{1}" stroke-width="{2:.2f}" stroke-linejoin="round"/>)", hull, colour,
          width_px);
    };
    stroke(tint.border, 2.0 * reach_px + 2.0);
    stroke(tint.perimeter, 2.0 * reach_px);
    stroke(tint.border, 1.0);
    add(R"(<path d="{}" fill="{}"/>)", hull, tint.hull);
  }

  void activity(const MomentPiece& activity) {
    std::string hull;
    for (const Polygon& part : activity.hull.parts) hull += path(part);
    add(R"(<g opacity="0.75"><title>{}</title>)", escaped_for_markup(activity_text(scenario_, activity.piece)));
    swept(hull, reach_px_, conflicting_.contains(activity.piece.entity) ? kWarm : kCold);
    add("</g>");
  }

  // The safety perimeter: all points at the safety distance from the body.
  std::string perimeter(const OrientedRectangle& body) const {
    const Vec2 along = scenario_.law.safety_distance_m * body.heading,
               aside = scenario_.law.safety_distance_m * Vec2(-body.heading.y(), body.heading.x());
    const auto corner = corners(body);
    const Vec2 outward[] = {along, aside, -along, -aside, along};
    std::string path;
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const Vec2 from = view_.pixel(corner[i] + outward[i]), to = view_.pixel(corner[i] + outward[i + 1]);
      path += fmt::format("{}{:.2f} {:.2f}A{:.2f} {:.2f} 0 0 0 {:.2f} {:.2f}", path.empty() ? "M" : "L", from.x(),
                          from.y(), reach_px_, reach_px_, to.x(), to.y());
    }
    return path + "Z";
  }

  void draw(const MomentBody& body) {
    const bool is_agv = body.entity.index() < scenario_.agvs.size(), close = too_close_.contains(body.entity);
    const std::string name = escaped_for_markup(moment_name(scenario_, body.entity));
    add("<g><title>{}{}</title>", name, body.is_loaded ? ", loaded" : "");
    shape(path(corners(body.place)), is_agv ? kAgv : kThing);
    add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}"{}/>)", perimeter(body.place),
        close ? kTooClose : kDark, close ? 2 : 1, close ? "" : R"( stroke-dasharray="4 3")");
    if (body.is_loaded) shape(path(corners(inner(body.place, -0.15, 0.55, 0.7))), kLoad);
    if (is_agv) add(R"(<path d="{}" fill="{}"/>)", path(nose(body.place)), kDark);
    add("</g>");
    label(body, name);
  }

  void shape(const std::string& path, const char* colour) {
    add(R"(<path d="{}" fill="{}" fill-opacity="0.85" stroke="{}"/>)", path, colour, kDark);
  }

  static OrientedRectangle inner(const OrientedRectangle& body, double ahead, double long_share, double wide_share) {
    return {body.centre_m + 2.0 * ahead * body.half_length_m * body.heading, body.heading,
            long_share * body.half_length_m, wide_share * body.half_width_m};
  }

  // A wedge at the front.
  static std::vector<Vec2> nose(const OrientedRectangle& body) {
    const auto front = corners(inner(body, 0.36, 0.16, 0.6));
    return {body.centre_m + 0.92 * body.half_length_m * body.heading, front[1], front[2]};
  }

  // Inside the body, else below or above it where no other name stands. If there is no room near it, its name shows
  // where a pointer rests on it.
  void label(const MomentBody& body, const std::string& name) {
    const OrientedRectangle& place = body.place;
    const auto letters = static_cast<double>(moment_name(scenario_, body.entity).size());
    const double narrow_px = 2.0 * std::min(place.half_length_m, place.half_width_m) * view_.scale();
    const Vec2 at = view_.pixel(place.centre_m);
    const double below_px = reach_px_ + 13.0 +
                            view_.scale() * (place.half_length_m * std::abs(place.heading.y()) +
                                             place.half_width_m * std::abs(place.heading.x()));
    std::vector<double> places;
    if (narrow_px >= kNameInside_px && letters <= 3.0) places.push_back(at.y() + 4.5);
    for (double aside = 0.0; aside < kMostLines * kNameHeight_px; aside += kNameHeight_px) {
      places.push_back(at.y() + below_px + aside);
      places.push_back(at.y() - below_px + 8.0 - aside);
    }
    const auto free = std::ranges::find_if(places, [&](double y) {
      return std::ranges::none_of(written_, [&](const Written& other) {
        return std::abs(other.at_px.y() - y) < kNameHeight_px &&
               std::abs(other.at_px.x() - at.x()) < kLetter_px / 2.0 * (letters + other.letters);
      });
    });
    if (free == places.end()) return;
    const double y = *free;
    written_.push_back({{at.x(), y}, letters});
    add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" font-weight="bold" text-anchor="middle" fill="#111111" )"
        R"(stroke="#ffffff" stroke-width="2.5" paint-order="stroke">{}</text>)",
        at.x(), y, name);
  }

  void legend() {
    const double y = words_top_px(view_) + 6.0;
    double x = view_.margin_px();
    const auto words = [&](const std::string& text, double width_px) {
      add(R"(<text x="{:.1f}" y="{:.1f}" font-size="12" fill="#222222">{}</text>)", x + 34.0, y + 4.0, text);
      x += width_px;
    };
    const auto box = [&](double by_px) {
      return fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h{:.1f}Z", x + 2.0 - by_px, y - 6.0 - by_px, 24.0 + 2.0 * by_px,
                         12.0 + 2.0 * by_px, -24.0 - 2.0 * by_px);
    };
    shape(box(0.0), kAgv);
    add(R"(<path d="{}" fill="none" stroke="{}" stroke-dasharray="4 3"/>)", box(3.5), kDark);
    words("safety perimeter, " + distance_text(scenario_.law.safety_distance_m), 190.0);
    swept(box(0.0), 3.5, kCold);
    words("hull of an activity, in its activity perimeter", 290.0);
    swept(box(0.0), 3.5, kWarm);
    words("the same, in conflict", 160.0);
    add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"/>)", box(3.5), kTooClose);
    words("too close", 90.0);
    shape(box(-2.0), kLoad);
    words("load", 0.0);
  }

  const Moment& moment_;
  const Scenario& scenario_;
  std::vector<std::string> lines_;
  FloorView view_;
  double reach_px_;
  std::vector<Written> written_;
  std::set<EntityId> conflicting_, too_close_;
  std::string text_;
};

}  // namespace

std::string moment_svg(const Moment& moment, const Scenario& scenario) {
  return MomentPicture(moment, scenario).draw();
}

}  // namespace fleetproof
