#include "core/bridges/lockstep/hosted_process.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace fleetproof::lockstep {
namespace {

constexpr int kProtocol = 1;

constexpr int kMostNested = 64;  // lists in lists

// The parser needs no stack for them, but to write them into an error takes one frame for each.
bool is_too_deep(std::string_view line) {
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (is_text && c == '\\') ++i;
    if (c == '"') is_text = !is_text;
    if (is_text) continue;
    if ((c == '[' || c == '{') && ++depth > kMostNested) return true;
    if (c == ']' || c == '}') --depth;
  }
  return false;
}

Json parsed(std::string_view line) {
  if (is_too_deep(line))
    throw Broken("sent lists in lists, more than " + std::to_string(kMostNested) + " deep: " + cited(line));
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) throw Broken("sent a line that is no JSON object: " + cited(line));
  return json;
}

template <class Value>
void take(const Json& hello, const char* member, Value& value, std::string_view line) {
  const auto found = hello.find(member);
  if (found == hello.end()) return;
  try {
    found->get_to(value);
  } catch (const Json::exception&) {
    throw Broken("introduces itself with a wrong \"" + std::string(member) + "\": " + cited(line));
  }
}

Introduction introduction_in(std::string_view line) {
  const Json json = parsed(line);
  const auto hello = json.find("hello");
  if (hello == json.end() || !hello->is_object()) throw Broken("does not answer hello with hello: " + cited(line));
  int protocol = 0;
  std::string runs = "many";
  std::vector<std::string> roles{"agv", "computer"};
  Introduction found;
  take(*hello, "protocol", protocol, line);
  if (protocol != kProtocol)
    throw Broken("speaks another version of lockstep, not " + std::to_string(kProtocol) + ": " + cited(line));
  take(*hello, "name", found.name, line);
  take(*hello, "description", found.description, line);
  take(*hello, "deterministic", found.is_deterministic, line);
  take(*hello, "roles", roles, line);
  take(*hello, "faults", found.faults, line);
  take(*hello, "runs", runs, line);
  if (found.name.empty()) throw Broken("has no name in its hello: " + cited(line));
  if (runs != "many" && runs != "one") throw Broken("introduces itself with a wrong \"runs\": " + cited(line));
  found.takes_many_runs = runs == "many";
  found.serves_agvs = std::ranges::find(roles, "agv") != roles.end();
  found.serves_computers = std::ranges::find(roles, "computer") != roles.end();
  return found;
}

}  // namespace

HostedProcess::HostedProcess(std::vector<std::string> words) : process_(std::make_unique<Process>(std::move(words))) {
  write_hello(line_);
  process_->send(line_);
  introduction_ = introduction_in(process_->receive());
}

// Nothing that the other side does may end the bridge.
template <class Exchange>
void HostedProcess::guarded(Exchange exchange) {
  if (!trouble_.empty()) return;
  try {
    exchange();
  } catch (const Broken& broken) {
    trouble_ = "the lockstep program " + std::string(broken.what());
    process_.reset();
  }
}

void HostedProcess::begin_run(const fp_briefing& briefing) {
  is_in_run_ = true;
  guarded([&] {
    write_run(briefing, line_);
    process_->send(line_);
  });
}

void HostedProcess::tell(Participant& participant, const fp_event& event) {
  guarded([&] { exchange(participant, event); });
  if (!trouble_.empty()) participant.controller.host->fail(participant.controller.handle, 0, trouble_.c_str());
}

// What was refused unasked comes back as an event of the same activation.
void HostedProcess::exchange(Participant& participant, const fp_event& event) {
  std::vector<RefusedCall> refused;
  do {
    fp_perceived seen{};
    seen.struct_size = sizeof seen;
    const auto& [host, handle] = participant.controller;
    if (host->perceive(handle, &seen) != FP_OK) return;  // it has failed, or has made too many calls
    const std::uint32_t told_before = std::exchange(participant.unread, seen.message_count);
    write_event(*participant.briefing, event, seen, told_before, std::exchange(refused, {}), line_);
    process_->send(line_);
    while (!take_answer(participant, refused)) {
    }
  } while (!refused.empty());
}

// True: the program is done with this event.
bool HostedProcess::take_answer(Participant& participant, std::vector<RefusedCall>& refused) {
  const std::string_view line = process_->receive();
  const Json json = parsed(line);
  const auto calls = json.find("calls"), ask = json.find("ask");
  if (calls == json.end() && ask == json.end()) throw Broken("sent a line without \"calls\": " + cited(line));
  try {
    if (calls != json.end()) make_calls(participant, *calls, refused);
    if (ask == json.end()) return true;
    make_call_of(participant, *ask);
  } catch (const Broken& broken) {
    throw Broken(broken.what() + (line.size() > 200 ? std::string() : " in the line " + cited(line)));
  }
  process_->send(line_);
  return false;
}

// A participant that is suspended is not told: its program need not learn of it.
void HostedProcess::make_calls(Participant& participant, const Json& calls, std::vector<RefusedCall>& refused) {
  if (!calls.is_array()) throw Broken("has calls that are no list");
  for (std::size_t place = 0; place < calls.size(); ++place) {
    const auto [result, is_look] = make_call_of(participant, calls[place]);
    if (!is_look && (result == FP_REFUSED || result == FP_INVALID))
      refused.push_back({place, name_of_call(calls[place]), result});
  }
}

// Its answer is the line.
CallResult HostedProcess::make_call_of(Participant& participant, const Json& call) {
  const CallResult result = make_call(participant.controller, call, line_);
  const std::string name = name_of_call(call);
  if (name == "get_message" && result.result == FP_OK) --participant.unread;
  if (name == "get_messages") participant.unread = 0;
  return result;
}

void HostedProcess::tell_end_of(std::uint32_t participant) {
  guarded([&] {
    write_destroy(participant, line_);
    process_->send(line_);
  });
}

bool HostedProcess::end_run() {
  is_in_run_ = false;
  guarded([&] {
    write_bye(line_);
    process_->send(line_);
    const std::string_view line = introduction_.takes_many_runs ? process_->receive() : process_->receive_or_end();
    if (line.data() == nullptr) return;
    if (!parsed(line).contains("bye")) throw Broken("does not answer bye with bye: " + cited(line));
  });
  return trouble_.empty() && introduction_.takes_many_runs;
}

}  // namespace fleetproof::lockstep
