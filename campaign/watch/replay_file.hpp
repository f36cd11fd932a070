#pragma once

#include <string>
#include <vector>

#include "campaign/watch/film_recorder.hpp"
#include "core/outcome/outcome.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// What a replay page says of its run besides what the scenario and the outcome say.
struct ReplayWords {
  std::string command;               // that simulates the run again
  std::vector<web::FilmFact> facts;  // before those of the scenario
};

// The replay page of the run that the recorder has listened to. `remark`: what stands first on the page, for instance
// that this is not the run of the archive; may be empty.
std::string replay_html(FilmRecorder& recorder, const Scenario& scenario, const Outcome& outcome,
                        const ReplayWords& words, const std::string& remark);

}  // namespace fleetproof
