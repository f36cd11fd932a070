#include "generators/formats/rmf_scale.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/outside_text.hpp"
#include "core/geometry/pose.hpp"
#include "generators/formats/rmf_words.hpp"
#include "generators/text/yaml_text.hpp"

namespace fleetproof {
namespace {

Vec2 pixel_of(const YamlText& yaml, const YAML::Node& list, const std::string& what) {
  return {yaml.number(yaml.item(list, 0, what), "x of " + what), yaml.number(yaml.item(list, 1, what), "y of " + what)};
}

YAML::Node level_of(const YAML::Node& root, const std::string& name) {
  for (const auto entry : root["levels"]) {
    if (entry.first.Scalar() == name) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

double scale_of_measurement(const YamlText& yaml, const YAML::Node& vertices, const YAML::Node& measurement) {
  const auto pixel = [&](std::size_t end) {
    const auto index =
        yaml.index_below(vertices.size(), yaml.item(measurement, end, "a measurement"), "a measurement names vertex");
    return pixel_of(yaml, vertices[index], "a vertex");
  };
  const double pixels = (pixel(0) - pixel(1)).norm();
  const auto words = attributes_of(yaml, measurement, 3, "a measurement [FROM, TO, {ATTRIBUTES}]");
  const auto distance = parameter(words, "distance");
  if (!distance.IsDefined()) yaml.refuse(measurement, "the measurement has no distance; add {distance: [3, METRES]}");
  const double metres = yaml.number(distance, "distance");
  if (!(metres > 0.0 && pixels > 0.0))
    yaml.refuse(measurement, fmt::format("{} m for {} pixels give no scale; correct the measurement", metres, pixels));
  return metres / pixels;
}

// The mean of the measurements of a level; none: it has none.
std::optional<double> measured_scale(const YamlText& yaml, const YAML::Node& level) {
  const auto measurements = level["measurements"];
  if (!measurements.IsDefined() || !measurements.IsSequence() || measurements.size() == 0) return std::nullopt;
  const auto vertices = yaml.list(level, "vertices", "the level");
  double sum = 0.0;
  for (const auto measurement : measurements) sum += scale_of_measurement(yaml, vertices, measurement);
  return sum / static_cast<double>(measurements.size());
}

// Of the fiducials [X, Y, NAME] that two levels have: where each is on one and on the other.
std::vector<std::pair<Vec2, Vec2>> shared_fiducials(const YamlText& yaml, const YAML::Node& reference,
                                                    const YAML::Node& level) {
  std::vector<std::pair<Vec2, Vec2>> shared;
  const auto there = reference["fiducials"], here = level["fiducials"];
  if (!there.IsDefined() || !here.IsDefined()) return shared;
  const auto name_of = [&](const YAML::Node& fiducial) {
    const auto name = yaml.item(fiducial, 2, "a fiducial");
    return name.IsScalar() ? name.Scalar() : "";
  };
  std::multimap<std::string, Vec2> named;
  for (const auto a : there) {
    if (!name_of(a).empty()) named.emplace(name_of(a), pixel_of(yaml, a, "a fiducial"));
  }
  for (const auto b : here) {
    const auto [begin, end] = named.equal_range(name_of(b));
    for (auto a = begin; a != end; ++a) shared.emplace_back(a->second, pixel_of(yaml, b, "a fiducial"));
  }
  return shared;
}

// Pixels of the level for one of the reference level: the mean over all pairs of fiducials.
std::optional<double> relative_scale(const YamlText& yaml, const YAML::Node& reference, const YAML::Node& level) {
  const auto shared = shared_fiducials(yaml, reference, level);
  double sum = 0.0;
  std::size_t pairs = 0;
  for (std::size_t a = 0; a < shared.size(); ++a) {
    for (std::size_t b = a + 1; b < shared.size(); ++b, ++pairs) {
      const double there = (shared[a].first - shared[b].first).norm(),
                   here = (shared[a].second - shared[b].second).norm();
      for (const auto& [pixels, of] : {std::pair{there, reference}, {here, level}}) {
        if (!(pixels > 0.0))
          yaml.refuse(of["fiducials"], "two fiducials are on one spot, and give no scale; correct them");
      }
      sum += here / there;
    }
  }
  return pairs == 0 ? std::nullopt : std::optional(sum / static_cast<double>(pairs));
}

std::string reference_of(const YamlText& yaml, const YAML::Node& root) {
  const auto named = root["reference_level_name"];
  if (!named.IsDefined() || named.IsNull() || !named.IsScalar()) return root["levels"].begin()->first.Scalar();
  if (!level_of(root, named.Scalar()).IsDefined())
    yaml.refuse(named,
                fmt::format("reference_level_name is {}, but there is no such level", in_quotes(named.Scalar())));
  return named.Scalar();
}

}  // namespace

RmfScale scale_of_level(const YamlText& yaml, const YAML::Node& root, const std::string& level_name) {
  const auto level = level_of(root, level_name);
  const auto own = measured_scale(yaml, level);
  const std::string unmeasured = "there are no measurements; a pixel is taken as 1 m";
  const auto reference_name = reference_of(yaml, root);
  if (reference_name == level_name) return {own.value_or(1.0), false, own ? "" : unmeasured};
  const auto reference = level_of(root, reference_name);
  const auto relative = relative_scale(yaml, reference, level);
  if (!relative)
    return {own.value_or(1.0), false,
            own ? fmt::format("the level shares no two fiducials with reference level {}; its measurements count",
                              in_quotes(reference_name))
                : unmeasured};
  const auto measured = measured_scale(yaml, reference);
  const double scale = measured.value_or(1.0) / *relative;
  return {scale, true,
          fmt::format("by the fiducials that the level shares with reference level {}, a pixel has {:.5g} m{}{}",
                      in_quotes(reference_name), scale,
                      measured ? "" : " (there are no measurements on that level; a pixel of it is taken as 1 m)",
                      own ? fmt::format("; by its measurements, which do not count, {:.5g} m", *own) : "")};
}

}  // namespace fleetproof
