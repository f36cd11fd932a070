#include "reports/campaign_page/failure_part.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "reports/markup/section_tables.hpp"
#include "reports/page/wording.hpp"
#include "reports/sections/failure_section.hpp"

namespace fleetproof::html {
namespace {

constexpr std::size_t kMostGroups = 50;

Element worst_of_group(const ReportInput& input, const FailureGroup& group, const FilmStrips& strips) {
  Element block("div", {{"class", "case"}});
  block.add(text_element("h3", fmt::format("{}: {}; first cause: {}; before it: {}", printable(group.agent, 40),
                                           group.end_point, printable(group.first_cause, 80), name_of(group.before))));
  const Remark remark = worst_of(input, group);
  block.add(paragraph(remark.text));
  if (!remark.command.empty()) block.add(Element("pre").add(text_element("code", remark.command)));
  if (const auto strip = strips.find(group.worst.run_index); strip != strips.end()) block.add(draw(strip->second));
  return block;
}

}  // namespace

Element failure_part(const ReportInput& input, const FilmStrips& strips) {
  Element part = titled(kFailuresTitle);
  auto groups = input.failures.list(input.evidence.gates());
  if (groups.empty()) return part.add(paragraph("No run failed."));
  const std::size_t all = groups.size();
  groups.resize(std::min(all, kMostGroups));
  part.add(paragraph(std::string(kFailureColumns)));
  part.add(table_of(failure_table(groups)));
  part.add(
      paragraph("Below, the worst run of each group with the command that replays it. With --html FILE added, the "
                "command writes a page that shows the run in a browser."));
  if (!strips.empty()) {
    part.add(paragraph(
        "A film strip shows the floor from above, in metres, around the worst instant, which has a thick frame. The "
        "AGVs in orange are those that went wrong; the dark wedge points to the front, the dashed line is the safety "
        "distance, lanes are grey."));
  }
  for (const FailureGroup& group : groups) part.add(worst_of_group(input, group, strips));
  if (all > kMostGroups) part.add(paragraph(fmt::format("{} more groups are left out here.", all - kMostGroups)));
  return part;
}

}  // namespace fleetproof::html
