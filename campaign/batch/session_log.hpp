#pragma once

#include <string>

#include "campaign/batch/campaign.hpp"

namespace fleetproof {

// Writes where and when runs were made into NAME.sessions.jsonl beside the campaign file, one line for each call of
// `run`. The campaign file itself then has the same bytes on every machine. `started_utc` is the wall clock before the
// first run. Throws EngineError if the disk fails.
void append_session(const std::string& archive_path, const std::string& started_utc, const RunOptions& options,
                    const CampaignResult& result);

std::string utc_now();  // 2026-11-21T06:14:00Z

}  // namespace fleetproof
