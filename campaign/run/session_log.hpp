#pragma once

#include <string>

#include "campaign/run/campaign.hpp"

namespace fleetproof {

// Where and when runs were made goes beside the campaign file, into NAME.sessions.jsonl, one line per call of `run`:
// the campaign file itself stays the same bytes on every machine. `started_utc` is the wall clock before the first run.
// Throws EngineError if the disk refuses.
void append_session(const std::string& archive_path, const std::string& started_utc, const RunOptions& options,
                    const CampaignResult& result);

std::string utc_now();  // 2026-11-21T06:14:00Z

}  // namespace fleetproof
