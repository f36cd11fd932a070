#pragma once

#include <vector>

#include "campaign/run/still_camera.hpp"
#include "core/scenario/scenario.hpp"
#include "reports/markup/film_strip.hpp"

namespace fleetproof {

// What a film strip is about: an instant, and the bodies that went wrong there, if there are any.
struct StripSubject {
  SimTime at;
  EntityId a, b;
  bool is_quick = true;      // over in seconds; else it took minutes
  bool stops_there = false;  // a contact after which both stand: nothing comes after
};

// Six instants around `subject.at`, fewer if the run is too short. After it, one if something changes by then, and up
// to four of a jam from the start on. What is over in seconds is shown in steps of seconds, a jam in steps ten times as
// long. A StillCamera fills them.
std::vector<Still> blank_stills(const StripSubject& subject, SimTime end);

html::FilmStrip strip_of(const std::vector<Still>& stills, const StripSubject& subject, const Scenario& scenario);

}  // namespace fleetproof
