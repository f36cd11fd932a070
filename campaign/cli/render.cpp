#include "campaign/cli/render.hpp"

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "reports/formats/report_formats.hpp"

namespace fleetproof::cli {

std::string render(const ReportInput& input, std::string_view format) {
  const auto* entry = find_entry(report_formats(), format);
  if (entry == nullptr) {
    const auto names = names_of(report_formats());
    throw InputError("--format", fmt::format("\"{}\" is not a report format{} (see: fleetproof list reports)", format,
                                             name_hint(format, names)));
  }
  return entry->make(input);
}

}  // namespace fleetproof::cli
