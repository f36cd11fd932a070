#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "reports/campaign_page/html_report.hpp"
#include "storage/archive_reader.hpp"

namespace fleetproof::cli {

// Film strips of the worst run of each group of failures, by run index, for the first kMostStrips groups. Each of these
// runs is simulated again: from its recording if the archive has one; else a reference agent in this process, and a
// plug-in in a worker process. A strip without frames says why: a run that comes out differently is not shown.
inline constexpr std::size_t kMostStrips = 10;
std::map<std::uint64_t, html::FilmStrip> film_strips(const ArchiveReader& archive, const std::string& archive_path,
                                                     const FailureGroups& failures);

}  // namespace fleetproof::cli
