#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// The control software that a campaign may test: the reference agents, and shared objects that are loaded by path. The
// object owns the loaded shared objects.
class AgentPrograms {
 public:
  AgentPrograms();
  ~AgentPrograms();
  AgentPrograms(const AgentPrograms&) = delete;
  AgentPrograms& operator=(const AgentPrograms&) = delete;

  // Loads a shared object and returns the name that its agent gives itself. Throws InputError if there is no such file,
  // if it has no fp_agent_query or another ABI, and if the name is taken, longer than 100 bytes, or not plain UTF-8.
  std::string load(const std::string& path);

  // Throws InputError with the nearest known name if there is no such agent.
  const fp_agent_type& find(std::string_view name, std::string_view where) const;
  const std::vector<const fp_agent_type*>& all() const { return types_; }
  bool is_loaded(std::string_view name) const;  // whether the agent comes from a shared object
  // "NAME sha256 HEX" of every shared object loaded: part of the engine's identity in the archive.
  const std::vector<std::string>& loaded() const { return loaded_; }

 private:
  std::vector<const fp_agent_type*> types_;
  std::vector<void*> objects_;
  std::vector<std::string> loaded_;
};

}  // namespace fleetproof
