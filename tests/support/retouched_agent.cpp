// A reference agent that thinks 5 ms longer at each event: a change of its timing, and of nothing else. Its parameters
// begin with the name of that agent. "NAME numbered": each message has a kind of its own, too.
#include <algorithm>
#include <cstdint>
#include <string>

#include "core/agents/agents.h"

namespace {

constexpr std::int64_t kLonger_ns = 5'000'000;

struct Retouched {
  const fp_agent_type* type = nullptr;
  void* inner = nullptr;
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
};

void (*describe)(fp_controller*, const char*) = nullptr;
void (*describe_message)(fp_controller*, const fp_message_fields*) = nullptr;
std::uint64_t described = 0;

// The first word is the kind.
void describe_with_number(fp_controller* controller, const char* text) {
  std::string numbered = text;
  numbered.insert(std::min(numbered.find_first_of(": "), numbered.size()), std::to_string(described++));
  describe(controller, numbered.c_str());
}

void describe_message_with_number(fp_controller* controller, const fp_message_fields* fields) {
  const std::string numbered = fields->kind + std::to_string(described++);
  fp_message_fields changed = *fields;
  changed.kind = numbered.c_str();
  describe_message(controller, &changed);
}

// The host of the process, with other notes of messages.
const fp_host* numbering(const fp_host* host) {
  static const fp_host copy = [&] {
    describe = host->describe;
    describe_message = host->describe_message;
    fp_host changed = *host;
    changed.describe = describe_with_number;
    changed.describe_message = describe_message_with_number;
    return changed;
  }();
  return &copy;
}

const fp_agent_type* named(const std::string& name) {
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_faulty_agent(i); ++i) {
    if (name == agent->name) return agent;
  }
  return nullptr;
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  const std::string config = briefing->config;
  const fp_agent_type* type = named(config.substr(0, config.find(' ')));
  if (type == nullptr) return nullptr;
  const bool numbered = config.find(" numbered") != std::string::npos;
  if (numbered && briefing->self == 0) described = 0;
  return new Retouched{type, type->create(numbered ? numbering(host) : host, controller, briefing), host, controller};
}

void on_event(void* instance, const fp_event* event) {
  const auto& agent = *static_cast<Retouched*>(instance);
  agent.host->declare_cost_ns(agent.controller, kLonger_ns);
  agent.type->on_event(agent.inner, event);
}

void destroy(void* instance) {
  auto* agent = static_cast<Retouched*>(instance);
  agent->type->destroy(agent->inner);
  delete agent;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.abi_minor = FP_ABI_MINOR;
  type.flags = FP_DETERMINISTIC;
  type.name = "retouched";
  type.description = "a reference agent that thinks 5 ms longer";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
