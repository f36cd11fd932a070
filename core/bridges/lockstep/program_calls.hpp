#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::lockstep {

using Json = nlohmann::json;

// By what a participant calls its controller.
struct Controller {
  const fp_host* host = nullptr;
  fp_controller* handle = nullptr;
};

// What a call of a program has returned.
struct CallResult {
  std::int32_t result = FP_OK;
  bool is_look = false;  // it acts on nothing: nobody has to be told if it finds nothing
};

// Makes one call, `["name", arguments...]`. `answer` takes the answer to it as a line. Throws Broken if it is none.
CallResult make_call(const Controller& controller, const Json& call, std::string& answer);
// The name of a call that was made.
std::string name_of_call(const Json& call);

}  // namespace fleetproof::lockstep
