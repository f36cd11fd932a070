#include "campaign/watch/trace_printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "campaign/watch/run_text.hpp"
#include "campaign/watch/trace_details.hpp"
#include "core/base/json_text.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/words.hpp"
#include "reports/page/wording.hpp"

namespace fleetproof {
namespace {

// Notes that stand in the lines of others, or that only pages have.
bool is_line(TraceKind kind) {
  return kind != TraceKind::Described && kind != TraceKind::DeliveryDecided && kind != TraceKind::CallAccepted;
}

double whole_millimetres_m(std::int64_t value_um) { return static_cast<double>(value_um - value_um % 1000) / 1e6; }

std::string text_of(const TracedMotion& motion) {
  return fmt::format("({:.3f}, {:.3f}) {:.1f} deg, {:.3f} m/s {}", motion.position_m.x(), motion.position_m.y(),
                     motion.heading_deg, motion.speed_mps, motion.where);
}

Json json_of(const TracedMotion& motion) {
  return {{"x_m", motion.position_m.x()},
          {"y_m", motion.position_m.y()},
          {"heading_deg", motion.heading_deg},
          {"speed_mps", motion.speed_mps},
          {"where", motion.where}};
}

Json json_of(const TracedMessage& message, const Scenario& scenario, SimTime now) {
  return {{"number", message.number},
          {"kind", message.kind},
          {"content", message.content.empty() ? Json(nullptr) : Json(message.content)},
          {"described", message.is_described()},
          {"bytes", message.bytes},
          {"sender", body_name(scenario, message.sender)},
          {"receiver", message.receiver.valid() ? Json(body_name(scenario, message.receiver)) : Json(nullptr)},
          {"sent_ns", to_ns(message.sent)},
          {"age_ns", to_ns(now) - to_ns(message.sent)}};
}

}  // namespace

TracePrinter::TracePrinter(const Scenario& scenario, TraceFormat format, TraceFilter filter,
                           std::vector<Violation> violations, Print print)
    : context_(scenario), format_(format), filter_(std::move(filter)), print_(std::move(print)) {
  for (const Violation& v : violations) {
    const std::string other = body_name(scenario, v.b);
    distances_.push_back({v.first,
                          v.a,
                          kDistance,
                          fmt::format("to {} falls below {}", other, distance_text(scenario.law.safety_distance_m)),
                          {}});
    distances_.push_back(
        {v.closest_at,
         v.a,
         kDistance,
         v.contact ? fmt::format("to {} is 0: contact", other)
                   : fmt::format("to {} is smallest: {:.3f} m", other, whole_millimetres_m(v.min_clearance_um)),
         {}});
  }
  std::ranges::stable_sort(distances_, std::ranges::greater(), &Line::at);
}

void TracePrinter::record(const TraceRecord& record, std::string_view text) {
  context_.note(record, text);
  if (!is_line(record.kind)) return;
  print_distances(record.at);
  Line line{record.at, record.entity, name_of(record.kind), trace_details(record, text, context_), {}};
  const bool of_message = record.kind == TraceKind::Sent || record.kind == TraceKind::Received || is_loss(record.kind);
  if (of_message) line.message = context_.message_of(record);
  print(line);
}

void TracePrinter::finish() {
  print_distances(kForever);
  if (has_undescribed_ && format_ == TraceFormat::Text)
    print_(
        "Messages named by their size are not described. To give one a kind, call describe before it is sent: "
        "host->describe(controller, \"GRANT: lane 3\"), in lockstep [\"describe\", \"GRANT: lane 3\"].\n");
}

// A line that falls on the instant of a record comes after it.
void TracePrinter::print_distances(SimTime until) {
  while (!distances_.empty() && distances_.back().at < until) {
    print(distances_.back());
    distances_.pop_back();
  }
}

bool TracePrinter::passes(const Line& line) const {
  return line.at >= filter_.from && line.at <= filter_.to &&
         (filter_.bodies.empty() || filter_.bodies.contains(line.body)) &&
         (filter_.kinds.empty() || filter_.kinds.contains(line.event));
}

void TracePrinter::print(const Line& line) {
  if (!passes(line)) return;
  has_undescribed_ = has_undescribed_ || (line.message && !line.message->is_described());
  const Scenario& scenario = context_.scenario();
  const auto motion = context_.motion_of(line.body, line.at);
  if (format_ == TraceFormat::Text) {
    return print_(fmt::format("{:>16}  {:<6} {:<14} {}{}\n", nanosecond_text(line.at),
                              printable(body_name(scenario, line.body)), line.event, printable(line.details),
                              motion ? "  | " + printable(text_of(*motion)) : ""));
  }
  Json json = {{"t_ns", to_ns(line.at)},
               {"body", body_name(scenario, line.body)},
               {"event", line.event},
               {"details", line.details},
               {"motion", motion ? json_of(*motion) : Json(nullptr)}};
  if (line.message) json["message"] = json_of(*line.message, scenario, line.at);
  print_(printable_json(json_text(json)) + "\n");
}

std::vector<std::string> trace_kind_words() {
  std::vector<std::string> words{kDistance};
  for (std::uint32_t number = 1; number < 64; ++number) {
    const std::string word = name_of(static_cast<TraceKind>(number));
    if (word != kNoWord && is_line(static_cast<TraceKind>(number))) words.push_back(word);
  }
  return words;
}

}  // namespace fleetproof
