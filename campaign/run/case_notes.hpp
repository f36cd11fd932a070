#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/byte_text.hpp"
#include "core/outcome/note_records.hpp"
#include "core/outcome/trace.hpp"

namespace fleetproof {

// A state or a probe that an agent declared. Of a note: the last time before the failure.
struct Declared {
  EntityId agv;
  std::string word;
  SimTime at{};
};
void put(ByteSink& sink, const std::vector<Declared>& all);
std::vector<Declared> take_declared(ByteSource& source);
// The last message that one AGV received from another before the failure.
struct Heard {
  EntityId by, of;
  std::uint32_t number = 0;
  std::string kind;     // empty: its sender did not describe it
  std::string content;  // what it says, as its sender describes it; may be empty
  SimTime sent{}, received{};
};
// Where one AGV last believed another to be before the failure. `as_of` is by its own clock.
struct Believed {
  EntityId by, about;
  NotedPose where;
  SimTime as_of{};
};

// What the agents of a run said and knew until an instant.
struct CaseNotes {
  std::vector<Declared> declared;
  std::vector<Heard> heard;
  std::vector<Believed> believed;
};
void put(ByteSink& sink, const CaseNotes& notes);
CaseNotes take_notes(ByteSource& source);

// Keeps them while the run goes on.
class NoteKeeper {
 public:
  void record(const TraceRecord& record, std::string_view text);
  CaseNotes until(SimTime t) const;

 private:
  struct Message {
    std::string text;
    SimTime sent{};
  };
  std::vector<Declared> declared_;
  std::vector<Heard> heard_;
  std::vector<std::pair<SimTime, Believed>> believed_;
  std::map<std::uint64_t, std::string> texts_;  // what a message is, by its hash
  std::map<std::uint32_t, Message> messages_;   // by number
};

}  // namespace fleetproof
