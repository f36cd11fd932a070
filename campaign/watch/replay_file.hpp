#pragma once

#include <string>
#include <vector>

#include "campaign/watch/film_recorder.hpp"
#include "core/outcome/outcome.hpp"
#include "reports/replay_page/explained.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof {

// What a replay page says of its run besides what the scenario and the outcome say.
struct ReplayWords {
  std::string command;               // that simulates the run again
  std::vector<web::FilmFact> facts;  // before those of the scenario
  web::ExplainedPart explained{};    // why it failed, as far as that was found out
};

// The run that the recorder has listened to, with what the trace says of it in words. `remark`: what stands first, for
// instance that this is not the run of the archive; may be empty.
web::Film film_of(FilmRecorder& recorder, const Scenario& scenario, const Outcome& outcome, const ReplayWords& words,
                  const std::string& remark);

// Its replay page.
std::string replay_html(FilmRecorder& recorder, const Scenario& scenario, const Outcome& outcome,
                        const ReplayWords& words, const std::string& remark);

}  // namespace fleetproof
