#include "campaign/watch/chrome_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/watch/run_text.hpp"
#include "campaign/watch/trace_details.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/outcome/trace_records.hpp"

namespace fleetproof {
namespace {

// The rows of a body, from above. Episodes below the safety distance that lie across each other have a row each.
enum RowNumber : int { kDoes = 1, kSays, kRadio, kHappens, kDistanceRow };
constexpr const char* kRowNames[] = {"", "does", "agent says", "radio", "happens", "below the safety distance"};
constexpr int kMostAtOnce = 200, kGoesOn = 10'000;  // things at one instant on one row; from it to the row that goes on
constexpr std::uint64_t kRowsOfABody = 1'000'000;

// The format counts in microseconds; three digits more keep the nanosecond.
double microseconds(SimTime t) { return static_cast<double>(to_ns(t)) / 1e3; }

std::string text_of(const Json& json) { return printable_json(json_text(json)); }

// A process 0 is the idle one, and a thread with the number of its process is its main thread: none of them is a row.
Json event(const char* phase, EntityId body, int row, SimTime at, const std::string& name) {
  const std::uint64_t process = body.value + std::uint64_t{1};
  return {{"ph", phase},
          {"pid", process},
          {"tid", kRowsOfABody * process + static_cast<std::uint64_t>(row)},
          {"ts", microseconds(at)},
          {"name", name}};
}

std::vector<Violation> in_order_of_begin(std::vector<Violation> violations) {
  std::ranges::stable_sort(violations, {}, &Violation::first);
  return violations;
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

ChromeTrace::Row ChromeTrace::with_room(const Row& row, SimTime at) {
  auto& [last, count] = at_once_.try_emplace(row, at, 0).first->second;
  if (last != at) count = 0;
  last = at;
  const Row found{row.first, row.second + kGoesOn * (count++ / kMostAtOnce)};
  if (found != row) more_rows_.insert(found);
  return found;
}

void ChromeTrace::bar(const Row& row, SimTime from, SimTime to, const std::string& name, const std::string& details) {
  Json json = event("X", row.first, row.second, from, name);
  json["dur"] = static_cast<double>((to - from).count()) / 1e3;
  json["args"] = {{"details", details}};
  events_.push_back(text_of(json));
}

void ChromeTrace::point(const Row& row, SimTime at, const std::string& name, const std::string& details) {
  const Row free = with_room(row, at);
  Json json = event("i", free.first, free.second, at, name);
  json["s"] = "t";
  json["args"] = {{"details", details}};
  events_.push_back(text_of(json));
}

// A message that is sent or received is a bar without length: such bars never lie across each other, however many there
// are at one instant. The number binds all receptions to the bar of the sender, each by an arrow.
void ChromeTrace::message(const TraceRecord& record) {
  const TracedMessage& message = context_.message_of(record);
  const std::string details = trace_details(record, {}, context_);
  const bool is_sent = record.kind == TraceKind::Sent;
  if (!is_sent && record.kind != TraceKind::Received)
    return point({record.entity, kRadio}, record.at, name_of(record.kind), details);
  const Row row = with_room({record.entity, kRadio}, record.at);
  Json json = event("X", row.first, row.second, record.at, message.kind);
  json["dur"] = 0;
  json["cat"] = "message";
  json["bind_id"] = message.number;
  json[is_sent ? "flow_out" : "flow_in"] = true;
  json["args"] = {{"details", details}};
  events_.push_back(text_of(json));
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
    case TraceKind::DeliveryDecided:
    case TraceKind::CallAccepted:
    case TraceKind::Belief:
    case TraceKind::TimerWentOff:
      return;
    default:
      return point({record.entity, kHappens}, record.at, name_of(record.kind), trace_details(record, text, context_));
  }
}

void ChromeTrace::name_rows(const std::map<EntityId, std::vector<SimTime>>& distance_rows) {
  const auto name = [&](const char* what, EntityId body, int row, const char* key, const Json& value) {
    Json json = event("M", body, row, kStart, what);
    json["args"] = {{key, value}};
    events_.push_back(text_of(json));
  };
  for (std::size_t i = 0; i < context_.scenario().entity_count(); ++i) {
    const EntityId body{i};
    name("process_name", body, kDoes, "name", body_name(context_.scenario(), body));
    name("process_sort_index", body, kDoes, "sort_index", i);
    const auto found = distance_rows.find(body);
    const int more = found == distance_rows.end() ? 0 : static_cast<int>(found->second.size()) - 1;
    for (int row = kDoes; row <= kDistanceRow + more; ++row) {
      name("thread_name", body, row, "name", kRowNames[std::min<int>(row, kDistanceRow)]);
      name("thread_sort_index", body, row, "sort_index", row);
    }
  }
  for (const auto& [body, row] : more_rows_) {
    name("thread_name", body, row, "name", std::string(kRowNames[row % kGoesOn]) + ", more at one instant");
    name("thread_sort_index", body, row, "sort_index", row);
  }
}

std::string ChromeTrace::text(const std::vector<Violation>& violations, SimTime end_of_run) {
  while (!open_.empty()) end(open_.begin()->first, end_of_run);
  std::map<EntityId, std::vector<SimTime>> rows;  // of a body: until when each is taken
  for (const Violation& v : in_order_of_begin(violations)) {
    auto& taken = rows[v.a];
    const auto row = std::ranges::find_if(taken, [&](SimTime until) { return until <= v.first; }) - taken.begin();
    if (row == std::ssize(taken)) taken.emplace_back();
    taken[static_cast<std::size_t>(row)] = v.last;
    bar({v.a, kDistanceRow + static_cast<int>(row)}, v.first, v.last, "to " + body_name(context_.scenario(), v.b),
        fmt::format("closest at {} s: {} um", nanosecond_text(v.closest_at), v.min_clearance_um));
  }
  name_rows(rows);
  std::string text = "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n";
  for (const std::string& event : events_) text += event + (&event == &events_.back() ? "\n" : ",\n");
  return text + "]}\n";
}

}  // namespace fleetproof
