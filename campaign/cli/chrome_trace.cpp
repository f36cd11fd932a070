#include "campaign/cli/chrome_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/cli/run_text.hpp"
#include "campaign/cli/trace_details.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/trace_records.hpp"

namespace fleetproof::cli {
namespace {

using Json = nlohmann::ordered_json;

// The rows of a body, from above.
enum RowNumber : int { kDoes = 1, kSays, kRadio, kHappens, kDistanceRow };
constexpr const char* kRowNames[] = {"", "does", "agent says", "radio", "happens", "below the safety distance"};
constexpr Duration kMessageBar = std::chrono::microseconds(100);  // an arrow begins and ends at a bar

// The format counts in microseconds; three digits more keep the nanosecond.
double microseconds(SimTime t) { return static_cast<double>(to_ns(t)) / 1e3; }

std::string text_of(const Json& json) {
  return printable_json(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Json event(const char* phase, EntityId body, int row, SimTime at, const std::string& name) {
  return {{"ph", phase}, {"pid", body.value}, {"tid", row}, {"ts", microseconds(at)}, {"name", name}};
}

}  // namespace

ChromeTrace::ChromeTrace(const Scenario& scenario) : context_(scenario) {}

void ChromeTrace::begin(const Row& row, SimTime at, std::string name, std::string details) {
  end(row, at);
  open_[row] = {at, std::move(name), std::move(details)};
}

void ChromeTrace::end(const Row& row, SimTime at) {
  const auto open = open_.find(row);
  if (open == open_.end()) return;
  bar(row, open->second.since, at, open->second.name, open->second.details);
  open_.erase(open);
}

void ChromeTrace::bar(const Row& row, SimTime from, SimTime to, const std::string& name, const std::string& details) {
  Json json = event("X", row.first, row.second, from, name);
  json["dur"] = microseconds(to) - microseconds(from);
  json["args"] = {{"details", details}};
  events_.push_back(text_of(json));
}

void ChromeTrace::point(const Row& row, SimTime at, const std::string& name, const std::string& details) {
  Json json = event("i", row.first, row.second, at, name);
  json["s"] = "t";
  json["args"] = {{"details", details}};
  events_.push_back(text_of(json));
}

// An arrow needs a number of its own, because a message may have many receivers, and a copy.
void ChromeTrace::message(const TraceRecord& record) {
  const TracedMessage& message = context_.message_of(record);
  const std::string details = trace_details(record, {}, context_);
  const Row row{record.entity, kRadio};
  if (record.kind == TraceKind::Sent) return bar(row, record.at, record.at + kMessageBar, message.kind, details);
  if (record.kind != TraceKind::Received) return point(row, record.at, name_of(record.kind), details);
  bar(row, record.at, record.at + kMessageBar, message.kind, details);
  ++arrows_;
  for (const bool starts : {true, false}) {
    Json json = starts ? event("s", message.sender, kRadio, message.sent, message.kind)
                       : event("f", record.entity, kRadio, record.at, message.kind);
    json["cat"] = "message";
    json["id"] = arrows_;
    if (!starts) json["bp"] = "e";
    events_.push_back(text_of(json));
  }
}

void ChromeTrace::record(const TraceRecord& record, std::string_view text) {
  context_.note(record, text);
  switch (record.kind) {
    case TraceKind::ActivityBegins:
      return begin({record.entity, kDoes}, record.at, name_of(traced::activity_of(record)),
                   trace_details(record, text, context_));
    case TraceKind::ActivityEnds:
      return end({record.entity, kDoes}, record.at);
    case TraceKind::AgentState:
      end({record.entity, kSays}, record.at);
      if (!text.empty()) begin({record.entity, kSays}, record.at, std::string(text), "");
      return;
    case TraceKind::Sent:
    case TraceKind::Received:
    case TraceKind::Lost:
    case TraceKind::LostInOutage:
    case TraceKind::LostByInterference:
    case TraceKind::LostToSource:
      return message(record);
    case TraceKind::Described:
    case TraceKind::FateDecided:
    case TraceKind::Belief:
    case TraceKind::TimerWentOff:
      return;
    default:
      return point({record.entity, kHappens}, record.at, name_of(record.kind), trace_details(record, text, context_));
  }
}

void ChromeTrace::name_rows() {
  const Scenario& scenario = context_.scenario();
  for (std::size_t i = 0; i < scenario.body_count(); ++i) {
    const EntityId body{i};
    Json name = event("M", body, 0, kStart, "process_name");
    name["args"] = {{"name", body_name(scenario, body)}};
    events_.push_back(text_of(name));
    for (int row = kDoes; row <= kDistanceRow; ++row) {
      Json thread = event("M", body, row, kStart, "thread_name");
      thread["args"] = {{"name", kRowNames[row]}};
      events_.push_back(text_of(thread));
    }
  }
}

std::string ChromeTrace::text(const std::vector<Violation>& violations, SimTime end_of_run) {
  while (!open_.empty()) end(open_.begin()->first, end_of_run);
  for (const Violation& v : violations) {
    const std::string other = body_name(context_.scenario(), v.b);
    bar({v.a, kDistanceRow}, v.first, v.last, "to " + other,
        fmt::format("closest at {} s: {} um", nanosecond_text(v.closest_at), v.min_clearance_um));
  }
  name_rows();
  std::string text = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
  for (const std::string& event : events_) text += event + (&event == &events_.back() ? "\n" : ",\n");
  return text + "]}\n";
}

}  // namespace fleetproof::cli
