#include "campaign/cli/layout_output.hpp"

#include "campaign/cli/output_file.hpp"
#include "campaign/cli/streams.hpp"
#include "generators/formats/csv_layout.hpp"
#include "generators/formats/importer.hpp"
#include "generators/formats/layout_file.hpp"
#include "generators/formats/lif_text.hpp"

namespace fleetproof::cli {
namespace {

OutputKind kind_of(const std::string& path) {
  if (has_ending(path, ".lif.json")) return OutputKind::LifLayout;
  return has_ending(path, ".csv") ? OutputKind::CsvLayout : OutputKind::Layout;
}

std::string text_of(const Layout& layout, OutputKind kind) {
  if (kind == OutputKind::CsvLayout) return to_csv(layout);
  return printable_json(kind == OutputKind::LifLayout ? to_lif(layout) : to_text(layout));
}

}  // namespace

void put_layout(const Layout& layout, const std::string& path) {
  const OutputKind kind = kind_of(path);
  if (kind == OutputKind::LifLayout) {
    for (const std::string& sentence : lost_in_lif(layout)) talk("warning: {}: {}\n", path, sentence);
  }
  const std::string text = text_of(layout, kind);
  if (path.empty()) {
    put_text(text);
  } else {
    write_whole({path, "--output", kind}, text);
  }
}

}  // namespace fleetproof::cli
