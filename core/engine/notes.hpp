#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/outcome/note_records.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// What is kept of the notes that an agent gives. Nothing: there is no note.
std::optional<std::string_view> noted(const char* text);
std::optional<NotedPose> noted(const fp_pose* where);
// As message_words reads it. If there is not enough room, the content goes first, then what the message is about.
std::optional<std::string> noted(const fp_message_fields* fields);
// A pose for which `noted` returns `pose` again.
fp_pose as_given(const NotedPose& pose);

}  // namespace fleetproof
