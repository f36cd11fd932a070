#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fleetproof {

// A kind of thing in a file of another program that the import does not use, or changes. In its sentence {0} is how
// many there are, and {1} the names of the first.
struct Topic {
  std::string_view sentence;
};

// What an import does not use or changes, by topic. A topic is identified by its address.
class LeftOutThings {
 public:
  // `place` is "file:line". A name counts once in each topic.
  void add(const Topic& topic, const std::string& place, const std::string& name);
  // Adds one sentence for each topic, in the order in which they came up.
  void tell(std::vector<std::string>& warnings) const;

 private:
  struct Found {
    const Topic* topic;
    std::string place;               // of the first
    std::vector<std::string> names;  // in the order in which they came up
    std::set<std::string> known;     // the same
  };
  std::vector<Found> found_;
};

}  // namespace fleetproof
