#include <fmt/format.h>

#include <memory>
#include <optional>

#include "campaign/cli/interrupts.hpp"
#include "campaign/cli/layout_output.hpp"
#include "campaign/cli/output_file.hpp"
#include "campaign/cli/progress.hpp"
#include "campaign/cli/verbs.hpp"
#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/families/mutated_import.hpp"
#include "generators/formats/importer.hpp"
#include "generators/map/layout_svg.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::cli {
namespace {

constexpr std::uint32_t kAttempts = 32;  // as for worlds

struct GenerateWords {
  std::string family, from, out, picture;
  std::optional<std::uint64_t> seed;
  bool stress = false;
};

Layout mutation(const GenerateWords& words, std::uint64_t key, WorkProgress& progress) {
  if (words.from.empty()) throw InputError("--from", "is missing; name the layout file to begin with");
  if (words.stress)
    throw InputError("--stress", fmt::format("has no meaning for {}; it has one range", kMutatedImport));
  std::vector<std::string> warnings;
  const Layout base = import_layout(words.from, {}, warnings);
  for (const std::string& warning : warnings) progress.say("warning: " + warning);
  RejectionCounts counts;
  for (std::uint32_t number = 0; number < kAttempts; ++number) {
    Draws draws(key, number);
    const auto layout = draw_mutation(base, draws, counts);
    if (!layout) continue;
    if (number > 0) progress.say(fmt::format("{} of {} draws refused: {}", number, number + 1, rejection_text(counts)));
    return *layout;
  }
  throw InputError(
      words.from,
      fmt::format("none of {} mutations is sound ({}); choose another seed or a layout with more ways round", kAttempts,
                  rejection_text(counts)));
}

// The layout of the world with this seed. A scenario with this seed has the same layout, unless its first draw was
// refused.
Layout drawn(const GenerateWords& words, WorkProgress& progress) {
  const auto key = stream_key(words.seed.value_or(1), Stream::Layout);
  if (words.family == kMutatedImport) return mutation(words, key, progress);
  if (!words.from.empty()) throw InputError("--from", fmt::format("belongs to {} alone", kMutatedImport));
  FamilyRange choice = family_range(words.family);
  if (words.stress && choice.provocation)
    throw InputError("--stress",
                     fmt::format("has no meaning for {}, which names another range of plants", words.family));
  if (words.stress) choice.range = Range::Stress;
  // Without a size, draw_layout() draws for five AGVs, for which every knob has room.
  if (const auto small = too_small(choice, 5); !small.empty()) progress.say("warning: " + small);
  Draws draws(key);
  return draw_layout(choice, draws);
}

int generate(const GenerateWords& words) {
  std::optional<WorkProgress> progress;
  progress.emplace("generate", nullptr);
  progress->begin("drawing a layout");
  const Layout layout = drawn(words, *progress);
  const std::string picture = words.picture.empty() ? "" : layout_svg(layout);
  progress.reset();
  listen_to_interrupts();  // a signal waits until the files are whole
  if (!words.picture.empty()) write_whole({words.picture, "--svg", OutputKind::Picture}, picture);
  put_layout(layout, words.out);
  return interrupted() != 0 ? exit_code_of_signal(interrupted()) : kDemonstrated;
}

}  // namespace

Action prepare_generate(Options& options) {
  auto words = std::make_shared<GenerateWords>();
  options.positional("FAMILY", words->family, "layout family (see: fleetproof list generators), or mutated-import");
  options.option("--seed", words->seed, "seed of the drawn layout (default: 1)");
  options.flag("--stress", words->stress, "draw from the family's stress range; the same as FAMILY/stress");
  options.option("--from", words->from, "mutated-import: layout file to begin with");
  options.option("-o,--output", words->out, kLayoutOutputHelp);
  options.option("--svg", words->picture, "draw the layout into this file as well (SVG)");
  return [words] { return generate(*words); };
}

}  // namespace fleetproof::cli
