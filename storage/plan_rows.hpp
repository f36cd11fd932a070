#pragma once

#include <cstdint>

#include "storage/records.hpp"

namespace fleetproof {

class Insert;
class Query;
class Row;

// As rows.hpp, for the rows of the plan.
void bind_campaign(Insert& insert, const CampaignRecord& campaign, std::uint64_t plan_checksum);
void bind_cell(Insert& insert, const CellRecord& cell);
void bind_gate(Insert& insert, const GateRecord& gate);

CampaignRecord read_campaign(const Row& row);
std::uint64_t read_plan_checksum(const Query& row);
CellRecord read_cell(const Row& row);
// Throws EngineError if the word is not a word of a gate.
GateRecord read_gate(const Row& row);

}  // namespace fleetproof
