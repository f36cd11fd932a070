#pragma once

#include <cstdint>

#include "storage/records.hpp"

namespace SQLite {
class Statement;
}

namespace fleetproof {

// As rows.hpp, for the rows of the plan.
void bind_campaign(SQLite::Statement& insert, const CampaignRecord& campaign, std::uint64_t plan_checksum);
void bind_cell(SQLite::Statement& insert, const CellRecord& cell);
void bind_gate(SQLite::Statement& insert, const GateRecord& gate);

CampaignRecord read_campaign(const SQLite::Statement& row);
std::uint64_t read_plan_checksum(const SQLite::Statement& row);
CellRecord read_cell(const SQLite::Statement& row);
// Throws EngineError if the word is not a word of a gate.
GateRecord read_gate(const SQLite::Statement& row);

}  // namespace fleetproof
