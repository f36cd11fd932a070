#include "core/bridges/lockstep/program_calls.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/bridges/lockstep/enumeration_words.hpp"
#include "core/bridges/lockstep/line_writer.hpp"
#include "core/bridges/lockstep/process.hpp"

namespace fleetproof::lockstep {
namespace {

// ---- arguments

// A call of a program, whose arguments are read by their places.
class Arguments {
 public:
  explicit Arguments(const Json& call) : call_(call) {}

  std::uint32_t number(std::size_t place) const {
    const Json& value = at(place);
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > FP_NONE) refuse(place, "is no number from 0 on");
    return value.get<std::uint32_t>();
  }
  // null is FP_NONE.
  std::uint32_t number_or_none(std::size_t place) const { return at(place).is_null() ? FP_NONE : number(place); }
  std::int64_t time_ns(std::size_t place) const {
    const Json& value = at(place);
    if (!value.is_number_integer()) refuse(place, "is no whole number");
    return value.get<std::int64_t>();
  }
  double real(std::size_t place) const {
    if (!at(place).is_number()) refuse(place, "is no number");
    return at(place).get<double>();
  }
  std::uint32_t flag(std::size_t place) const {
    if (!at(place).is_boolean()) refuse(place, "is neither true nor false");
    return at(place).get<bool>() ? 1 : 0;
  }
  const std::string& text(std::size_t place) const {
    if (!at(place).is_string()) refuse(place, "is no text");
    return at(place).get_ref<const std::string&>();
  }
  bool is_object(std::size_t place) const { return at(place).is_object(); }
  // Of an object; empty: it has no such field.
  std::string field(std::size_t place, std::string_view name) const {
    const auto found = at(place).find(name);
    if (found == at(place).end() || found->is_null()) return {};
    if (!found->is_string()) refuse(place, "has a field that is no text");
    return found->get<std::string>();
  }
  // Of an object: the first has to be there, and no others may be.
  void require_fields(std::size_t place, std::string_view needed, std::initializer_list<std::string_view> known) const {
    if (field(place, needed).empty()) refuse(place, "has no \"" + std::string(needed) + '"');
    for (const auto& [name, value] : at(place).items()) {
      if (std::ranges::count(known, name) == 0) refuse(place, "has an unknown field, " + cited(name));
    }
  }
  std::uint64_t bits(std::size_t place) const {
    if (at(place).is_number_unsigned()) return at(place).get<std::uint64_t>();
    const std::string& digits = text(place);
    std::uint64_t word = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), word, 16);
    if (error != std::errc{} || end != digits.data() + digits.size()) refuse(place, "are no hexadecimal digits");
    return word;
  }
  // One character for each byte; the text is UTF-8.
  std::string bytes(std::size_t place) const {
    std::string found;
    const std::string& from = text(place);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const auto byte = static_cast<unsigned char>(from[i]);
      if (byte < 0x80) {
        found.push_back(from[i]);
      } else if ((byte == 0xc2 || byte == 0xc3) && i + 1 < from.size()) {
        found.push_back(static_cast<char>((byte & 0x3U) << 6U | (static_cast<unsigned char>(from[++i]) & 0x3fU)));
      } else {
        refuse(place, "has a character above U+00FF, which is no byte");
      }
    }
    return found;
  }
  fp_pose pose(std::size_t place) const {
    const Json& value = at(place);
    const bool is_pose = value.is_array() && value.size() == 4 &&
                         std::ranges::all_of(value, [](const Json& n) { return n.is_number(); });
    if (!is_pose) refuse(place, "is no [x_m, y_m, heading_x, heading_y]");
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>(), value[3].get<double>()};
  }
  fp_occupancy occupancy(std::size_t place) const {
    const Json& value = at(place);
    if (!value.is_object()) refuse(place, "is no occupancy");
    fp_occupancy found{sizeof(fp_occupancy),
                       member(value, "vehicle_type", place),
                       FP_ANY_LOAD,
                       member(value, "lane", place),
                       member(value, "station", place),
                       0.0,
                       0.0};
    if (const auto load = value.find("load"); load != value.end()) {
      const auto word = std::ranges::find_if(kLoadWords, [&](const char* known) { return *load == known; });
      if (word == kLoadWords.end()) refuse(place, "has an unknown load");
      found.load = static_cast<std::uint32_t>(word - kLoadWords.begin());
    }
    if (const auto heading = value.find("heading"); heading != value.end()) {
      if (!heading->is_array() || heading->size() != 2 || !(*heading)[0].is_number() || !(*heading)[1].is_number())
        refuse(place, "has no heading [x, y]");
      found.heading_x = (*heading)[0].get<double>();
      found.heading_y = (*heading)[1].get<double>();
    }
    return found;
  }

 private:
  const Json& at(std::size_t place) const {
    if (place >= call_.size()) refuse(place, "is missing");
    return call_[place];
  }
  std::uint32_t member(const Json& value, const char* name, std::size_t place) const {
    const auto found = value.find(name);
    if (found == value.end() || found->is_null()) return FP_NONE;
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > FP_NONE) refuse(place, "has a wrong number");
    return found->get<std::uint32_t>();
  }
  [[noreturn]] void refuse(std::size_t place, const std::string& why) const {
    throw Broken("made a call whose argument " + std::to_string(place) + " " + why + ": " + cited(call_.dump()));
  }

  const Json& call_;
};

// ---- calls

void answer_result(LineWriter& out, std::int32_t result) { out.member("answer", result_word(result)); }

template <auto kMember>
CallResult on_segment(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = (c.host->*kMember)(c.handle, given.number_or_none(1));
  answer_result(out, result);
  return {result};
}

template <auto kMember>
CallResult without_arguments(const Controller& c, const Arguments&, LineWriter& out) {
  const std::int32_t result = (c.host->*kMember)(c.handle);
  answer_result(out, result);
  return {result};
}

template <auto kMember>
CallResult of_agv(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = (c.host->*kMember)(c.handle, given.number(1), given.number_or_none(2));
  answer_result(out, result);
  return {result};
}

template <auto kMember>
CallResult with_text(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = (c.host->*kMember)(c.handle, given.text(1).c_str());
  answer_result(out, result);
  return {result};
}

template <auto kMember>
CallResult note(const Controller& c, const Arguments& given, LineWriter& out) {
  (c.host->*kMember)(c.handle, given.text(1).c_str());
  answer_result(out, FP_OK);
  return {FP_OK, true};
}

// "GRANT: answers 7", or {"kind": "GRANT", "answers": "7"}.
CallResult describe(const Controller& c, const Arguments& given, LineWriter& out) {
  if (!given.is_object(1)) return note<&fp_host::describe>(c, given, out);
  given.require_fields(1, "kind", {"kind", "content", "asks", "answers", "about"});
  const std::string kind = given.field(1, "kind"), content = given.field(1, "content"), asks = given.field(1, "asks"),
                    answers = given.field(1, "answers"), about = given.field(1, "about");
  const auto or_null = [](const std::string& text) { return text.empty() ? nullptr : text.c_str(); };
  const fp_message_fields fields{sizeof(fp_message_fields), kind.c_str(),  or_null(content), or_null(asks),
                                 or_null(answers),          or_null(about)};
  c.host->describe_message(c.handle, &fields);
  answer_result(out, FP_OK);
  return {FP_OK, true};
}

CallResult pick_load(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = c.host->pick_load(c.handle, given.number_or_none(1), given.number(2));
  answer_result(out, result);
  return {result};
}

CallResult send_broadcast(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::string bytes = given.bytes(1);
  const std::int32_t result = c.host->send_broadcast(c.handle, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  answer_result(out, result);
  return {result};
}

CallResult send_unicast(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::string bytes = given.bytes(1);
  const std::int32_t result =
      c.host->send_unicast(c.handle, bytes.data(), static_cast<std::uint32_t>(bytes.size()), given.number(2));
  answer_result(out, result);
  return {result};
}

CallResult set_timer(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = c.host->set_timer(c.handle, given.number(1), given.time_ns(2));
  answer_result(out, result);
  return {result};
}

CallResult declare_cost_ns(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = c.host->declare_cost_ns(c.handle, given.time_ns(1));
  answer_result(out, result);
  return {result};
}

CallResult safe_mode(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = c.host->safe_mode(c.handle, given.flag(1));
  answer_result(out, result);
  return {result};
}

CallResult keep(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::string bytes = given.bytes(2);
  const std::int32_t result =
      c.host->keep(c.handle, given.number(1), bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  answer_result(out, result);
  return {result};
}

CallResult fail(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::int32_t result = c.host->fail(c.handle, given.flag(1), given.text(2).c_str());
  answer_result(out, result);
  return {result, true};
}

CallResult believe(const Controller& c, const Arguments& given, LineWriter& out) {
  const fp_pose where = given.pose(2);
  c.host->believe(c.handle, given.number(1), &where, given.time_ns(3));
  answer_result(out, FP_OK);
  return {FP_OK, true};
}

// ---- looks

CallResult get_position(const Controller& c, const Arguments&, LineWriter& out) {
  fp_pose pose{};
  const std::int32_t result = c.host->get_position(c.handle, &pose);
  answer_result(out, result);
  if (result == FP_OK) out.member("pose", pose);
  return {result, true};
}

CallResult get_battery_level(const Controller& c, const Arguments&, LineWriter& out) {
  double level = 0.0;
  const std::int32_t result = c.host->get_battery_level(c.handle, &level);
  answer_result(out, result);
  if (result == FP_OK) out.member("battery_level", level);
  return {result, true};
}

CallResult get_action(const Controller& c, const Arguments&, LineWriter& out) {
  std::uint32_t action = 0;
  const std::int32_t result = c.host->get_action(c.handle, &action);
  answer_result(out, result);
  if (result == FP_OK) out.member("action", word_in(kActionWords, action));
  return {result, true};
}

CallResult is_loaded(const Controller& c, const Arguments&, LineWriter& out) {
  std::uint32_t loaded = 0;
  const std::int32_t result = c.host->is_loaded(c.handle, &loaded);
  answer_result(out, result);
  if (result == FP_OK) out.member("loaded", loaded != 0);
  return {result, true};
}

CallResult get_load(const Controller& c, const Arguments&, LineWriter& out) {
  std::uint32_t order = FP_NONE;
  const std::int32_t result = c.host->get_load(c.handle, &order);
  answer_result(out, result);
  if (result == FP_OK) out.id("load", order);
  return {result, true};
}

CallResult get_message(const Controller& c, const Arguments&, LineWriter& out) {
  fp_message message{};
  message.struct_size = sizeof message;
  const std::int32_t result = c.host->get_message(c.handle, &message);
  answer_result(out, result);
  if (result == FP_OK) {
    out.member("sender", message.sender);
    out.bytes("bytes", message.bytes, message.size);
  }
  return {result, true};
}

CallResult get_messages(const Controller& c, const Arguments&, LineWriter& out) {
  fp_message message{};
  message.struct_size = sizeof message;
  std::int32_t result = FP_OK;
  while (result == FP_OK) result = c.host->get_message(c.handle, &message);
  answer_result(out, result == FP_EMPTY ? std::int32_t{FP_OK} : result);
  return {result, true};
}

CallResult now_ns(const Controller& c, const Arguments&, LineWriter& out) {
  const std::int64_t now = c.host->now_ns(c.handle);
  answer_result(out, FP_OK);
  out.member("now_ns", now);
  return {FP_OK, true};
}

CallResult random(const Controller& c, const Arguments& given, LineWriter& out) {
  const std::uint64_t value = c.host->random(c.handle, given.number(1), given.bits(2));
  answer_result(out, FP_OK);
  out.bits("value", value);
  return {FP_OK, true};
}

CallResult recall(const Controller& c, const Arguments& given, LineWriter& out) {
  fp_record record{};
  record.struct_size = sizeof record;
  const std::int32_t result = c.host->recall(c.handle, given.number(1), &record);
  answer_result(out, result);
  if (result == FP_OK) out.bytes("bytes", record.bytes, record.size);
  return {result, true};
}

CallResult conflict(const Controller& c, const Arguments& given, LineWriter& out) {
  const fp_occupancy a = given.occupancy(1), b = given.occupancy(2);
  std::uint32_t may = 0;
  const std::int32_t result = c.host->conflict(c.handle, &a, &b, given.real(3), &may);
  answer_result(out, result);
  if (result == FP_OK) out.member("conflict", may != 0);
  return {result, true};
}

struct Call {
  std::string_view name;
  CallResult (*make)(const Controller&, const Arguments&, LineWriter&);
};

constexpr std::array kCalls{Call{"move", on_segment<&fp_host::move>},
                            Call{"pick", on_segment<&fp_host::pick>},
                            Call{"drop", on_segment<&fp_host::drop>},
                            Call{"park", on_segment<&fp_host::park>},
                            Call{"charge", on_segment<&fp_host::charge>},
                            Call{"pick_load", pick_load},
                            Call{"stop", without_arguments<&fp_host::stop>},
                            Call{"go_on", without_arguments<&fp_host::go_on>},
                            Call{"send_broadcast", send_broadcast},
                            Call{"send_unicast", send_unicast},
                            Call{"set_timer", set_timer},
                            Call{"declare_cost_ns", declare_cost_ns},
                            Call{"safe_mode", safe_mode},
                            Call{"waiting_for", on_segment<&fp_host::waiting_for>},
                            Call{"works_on", of_agv<&fp_host::works_on>},
                            Call{"declare_waiting", of_agv<&fp_host::declare_waiting>},
                            Call{"sometimes", with_text<&fp_host::sometimes>},
                            Call{"log", with_text<&fp_host::log>},
                            Call{"keep", keep},
                            Call{"fail", fail},
                            Call{"describe", describe},
                            Call{"declare_state", note<&fp_host::declare_state>},
                            Call{"believe", believe},
                            Call{"get_position", get_position},
                            Call{"get_battery_level", get_battery_level},
                            Call{"get_action", get_action},
                            Call{"is_loaded", is_loaded},
                            Call{"get_load", get_load},
                            Call{"get_message", get_message},
                            Call{"get_messages", get_messages},
                            Call{"now_ns", now_ns},
                            Call{"random", random},
                            Call{"recall", recall},
                            Call{"conflict", conflict}};

}  // namespace

CallResult make_call(const Controller& controller, const Json& call, std::string& answer) {
  if (!call.is_array() || call.empty() || !call.front().is_string())
    throw Broken("made a call that is no list with a name: " + cited(call.dump()));
  const auto found =
      std::ranges::find(kCalls, std::string_view(call.front().get_ref<const std::string&>()), &Call::name);
  if (found == kCalls.end()) throw Broken("made an unknown call: " + cited(call.dump()));
  LineWriter out(answer);
  out.open('{');
  const CallResult result = found->make(controller, Arguments(call), out);
  out.close('}');
  return result;
}

std::string name_of_call(const Json& call) { return call.front().get<std::string>(); }

}  // namespace fleetproof::lockstep
