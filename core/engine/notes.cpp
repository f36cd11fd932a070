#include "core/engine/notes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/engine/call_limits.hpp"

namespace fleetproof {
namespace {

constexpr double kFarthest_m = 2e6;

bool is_within(double value, double limit) { return std::abs(value) <= limit; }  // false also for NaN

std::int16_t heading_units(double part) {
  return static_cast<std::int16_t>(std::lround(std::clamp(part, -1.0, 1.0) * NotedPose::kHeadingUnits));
}

}  // namespace

std::optional<std::string_view> noted(const char* text) {
  if (text == nullptr) return std::nullopt;
  const std::string_view note(text, ::strnlen(text, kNoteBytesMax));
  return note.substr(0, note.find(kFieldEnd));
}

std::optional<NotedPose> noted(const fp_pose* where) {
  if (where == nullptr || !is_within(where->x_m, kFarthest_m) || !is_within(where->y_m, kFarthest_m) ||
      !is_within(where->heading_x, 2.0) || !is_within(where->heading_y, 2.0))
    return std::nullopt;
  return NotedPose{static_cast<std::int32_t>(std::lround(where->x_m * 1e3)),
                   static_cast<std::int32_t>(std::lround(where->y_m * 1e3)), heading_units(where->heading_x),
                   heading_units(where->heading_y)};
}

namespace {

// A field without what parts fields.
std::string field_of(const char* text, std::size_t most) {
  if (text == nullptr) return {};
  std::string field(text, ::strnlen(text, most));
  std::ranges::replace(field, kFieldEnd, ' ');
  return field;
}

}  // namespace

std::optional<std::string> noted(const fp_message_fields* fields) {
  if (fields == nullptr || fields->struct_size < sizeof(fp_message_fields) || fields->kind == nullptr)
    return std::nullopt;
  std::size_t room = kDescriptionBytesMax;
  const auto take = [&](const char* text) {
    std::string field = field_of(text, std::min<std::size_t>(room, kNoteBytesMax));
    room -= field.size();
    return field;
  };
  const std::string given_kind = take(fields->kind);
  const std::string kind(message_words(given_kind).kind);
  const std::string asks = take(fields->asks), answers = take(fields->answers), about = take(fields->about);
  std::string content = take(fields->content);
  if (fields->content == nullptr) {
    for (const auto& [word, field] : {std::pair("answers ", answers), std::pair("asks ", asks), std::pair("", about)}) {
      if (!field.empty()) content += (content.empty() ? "" : ", ") + (word + field);
    }
    content = content.substr(0, room);
  }
  std::string text = kind;
  if (!content.empty()) text += ": " + content;
  if (!(asks + answers + about).empty())
    for (const std::string& field : {asks, answers, about}) text += kFieldEnd + field;
  return text;
}

fp_pose as_given(const NotedPose& pose) {
  return {pose.x_mm / 1e3, pose.y_mm / 1e3, pose.heading_x / NotedPose::kHeadingUnits,
          pose.heading_y / NotedPose::kHeadingUnits};
}

}  // namespace fleetproof
