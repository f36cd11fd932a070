#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A scenario on its way to a worker. Its layout is most of its text, and most scenarios of a search share one.
struct CaseText {
  std::uint64_t layout_digest = 0;
  std::string layout, scenario;  // the scenario without its layout

  bool is_empty() const { return scenario.empty(); }
};

// What was made of the layouts that came last, by their digests.
template <class Made>
class RecentLayouts {
 public:
  template <class Make>
  const Made& find(std::uint64_t digest, Make make) {
    for (const auto& [known, made] : recent_) {
      if (known == digest) return made;
    }
    if (recent_.size() == kMost) recent_.pop_back();
    return recent_.emplace_front(digest, make()).second;
  }

 private:
  static constexpr std::size_t kMost = 8;
  std::deque<std::pair<std::uint64_t, Made>> recent_;
};

// Writes a layout once for all scenarios on it. Threads: any number.
class CaseWriter {
 public:
  CaseText write(const Scenario& scenario);

 private:
  std::mutex mutex_;
  RecentLayouts<std::string> layouts_;
};

// Reads a layout once. Throws InputError if the texts are none that a CaseWriter wrote.
class CaseReader {
 public:
  Scenario read(const CaseText& text);

 private:
  RecentLayouts<std::shared_ptr<const LogicalMap>> maps_;
};

}  // namespace fleetproof
