#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// The control software a campaign may test: the reference agents, and shared objects loaded by path. Owns the loaded
// objects.
class AgentPrograms {
 public:
  AgentPrograms();
  ~AgentPrograms();
  AgentPrograms(const AgentPrograms&) = delete;
  AgentPrograms& operator=(const AgentPrograms&) = delete;

  // Loads a shared object and returns the name its agent gives itself. Throws InputError: no such file, no
  // fp_agent_query, another ABI, a name taken.
  std::string load(const std::string& path);

  // Throws InputError with the nearest known name.
  const fp_agent_type& find(std::string_view name, std::string_view where) const;
  const std::vector<const fp_agent_type*>& all() const { return types_; }
  bool is_loaded(std::string_view name) const;  // from a shared object, not built in
  // "NAME sha256 HEX" of every shared object loaded: part of the engine's identity in the archive.
  const std::vector<std::string>& loaded() const { return loaded_; }

 private:
  std::vector<const fp_agent_type*> types_;
  std::vector<void*> objects_;
  std::vector<std::string> loaded_;
};

}  // namespace fleetproof
