#include <fmt/format.h>

#include <memory>

#include "campaign/cli/output_file.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/random.hpp"
#include "generators/layout_family.hpp"
#include "generators/layout_file.hpp"
#include "generators/layout_svg.hpp"

namespace fleetproof::cli {
namespace {

struct GenerateWords {
  std::string family, out, picture;
  std::optional<std::uint64_t> seed;
};

// The layout of the world with this seed: the same that a scenario of that seed holds, unless its first draw was refused.
int generate(const GenerateWords& words) {
  Draws draws(stream_key(words.seed.value_or(1), Stream::Layout));
  const Layout layout = layout_family(words.family).make(draws);
  if (!words.picture.empty()) write_whole(words.picture, layout_svg(layout), "--svg");
  if (words.out.empty()) {
    fmt::print("{}", to_text(layout));
  } else {
    write_whole(words.out, to_text(layout), "--output");
  }
  return kDemonstrated;
}

}  // namespace

Action prepare_generate(Options& options) {
  auto words = std::make_shared<GenerateWords>();
  options.positional("FAMILY", words->family, "layout family (see: fleetproof list generators)");
  options.option("--seed", words->seed, "seed of the drawn layout (default: 1)");
  options.option("-o,--output", words->out, "write the layout to this file (JSON) instead of standard output");
  options.option("--svg", words->picture, "draw the layout into this file as well (SVG)");
  return [words] { return generate(*words); };
}

}  // namespace fleetproof::cli
