#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// Which side reports that something was met in a run: the world (a law that counts), or an agent through its host's
// `sometimes`. The names of the world's probes are in probe_names.hpp.
enum class ProbeSource : std::uint8_t { World = 0, Agent = 1 };
const char* name_of(ProbeSource source);

// How often something was met in a run.
struct ProbeCount {
  ProbeSource source = ProbeSource::World;
  std::string name;
  std::uint64_t count = 0;

  friend bool operator==(const ProbeCount&, const ProbeCount&) = default;
};

// What the agents of a run declare, summed by name. Bounded: an agent that invents names costs its run no memory.
class ProbeTally {
 public:
  static constexpr std::size_t kNamesMax = 64;  // different names in a run
  static constexpr std::size_t kNameBytesMax = 64;

  // `hash` identifies the name.
  void declare(std::string_view name, std::uint64_t hash);
  std::vector<ProbeCount> counts() const;               // by name
  std::uint64_t left_out() const { return left_out_; }  // declarations beyond the bounds

 private:
  struct Seen {
    std::uint64_t hash = 0, count = 0;
    std::string name;
  };
  std::vector<Seen> seen_;
  std::uint64_t left_out_ = 0;
};

}  // namespace fleetproof
