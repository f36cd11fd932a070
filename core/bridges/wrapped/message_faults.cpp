// Messages that are not heard, or heard twice.
#include <string>
#include <vector>

#include "core/bridges/wrapped/fault_agents.hpp"

namespace fleetproof::wrapped {
namespace {

const fp_message& message_at(const fp_perceived& seen, std::uint32_t place) {
  const auto* first = reinterpret_cast<const char*>(seen.messages);
  return *reinterpret_cast<const fp_message*>(first + std::size_t{place} * seen.message_stride);
}

void show(fp_perceived& out, const std::vector<fp_message>& messages) {
  out.messages = messages.data();
  out.message_count = static_cast<std::uint32_t>(messages.size());
  out.message_stride = sizeof(fp_message);
}

class Dropping : public WrappedAgent {
 public:
  Dropping(const Fault& fault, const Surroundings& around) : WrappedAgent(around), every_(fault.every) {}

  std::int32_t get_message(fp_message* out) override {
    for (;;) {
      const std::int32_t result = host().get_message(handle(), out);
      if (result != FP_OK) return result;
      if (++heard_ % every_ != 0) return FP_OK;
    }
  }
  std::int32_t perceive(fp_perceived* out) override {
    const std::int32_t result = host().perceive(handle(), out);
    if (result != FP_OK) return result;
    left_.clear();
    for (std::uint32_t i = 0; i < out->message_count; ++i) {
      if ((heard_ + i + 1) % every_ != 0) left_.push_back(message_at(*out, i));
    }
    show(*out, left_);
    return result;
  }

 private:
  // An agent that is told of messages finds one.
  void hear(const fp_event& event) override {
    if (event.kind != FP_EVENT_MESSAGE) return pass_on(event);
    const std::uint32_t unread = perceived_by(*this).message_count;
    const std::uint64_t dropped = (heard_ + unread) / every_ - heard_ / every_;
    if (unread == 0 || dropped < unread) return pass_on(event);
    fp_message none{};
    none.struct_size = sizeof none;
    while (host().get_message(handle(), &none) == FP_OK) ++heard_;
  }

  std::uint64_t every_, heard_ = 0;
  std::vector<fp_message> left_;
};

class Repeating : public WrappedAgent {
 public:
  Repeating(const Fault& fault, const Surroundings& around) : WrappedAgent(around), every_(fault.every) {}

  std::int32_t get_message(fp_message* out) override {
    if (is_repeated_ && out != nullptr && out->struct_size >= sizeof(fp_message)) {
      is_repeated_ = false;
      out->sender = sender_;
      out->size = static_cast<std::uint32_t>(bytes_.size());
      out->bytes = bytes_.data();
      return FP_OK;
    }
    const std::int32_t result = host().get_message(handle(), out);
    if (result != FP_OK || ++heard_ % every_ != 0) return result;
    is_repeated_ = true;
    sender_ = out->sender;
    bytes_.assign(static_cast<const char*>(out->bytes), out->size);
    return result;
  }
  std::int32_t perceive(fp_perceived* out) override {
    const std::int32_t result = host().perceive(handle(), out);
    if (result != FP_OK) return result;
    shown_.clear();
    if (is_repeated_)
      shown_.push_back({sizeof(fp_message), sender_, static_cast<std::uint32_t>(bytes_.size()), bytes_.data()});
    for (std::uint32_t i = 0; i < out->message_count; ++i) {
      shown_.push_back(message_at(*out, i));
      if ((heard_ + i + 1) % every_ == 0) shown_.push_back(message_at(*out, i));
    }
    show(*out, shown_);
    return result;
  }

 private:
  std::uint64_t every_, heard_ = 0;
  bool is_repeated_ = false;  // the last message is to be heard once more
  std::uint32_t sender_ = FP_NONE;
  std::string bytes_;
  std::vector<fp_message> shown_;
};

}  // namespace

std::unique_ptr<WrappedAgent> make_dropping(const Fault& fault, const Surroundings& around) {
  return std::make_unique<Dropping>(fault, around);
}

std::unique_ptr<WrappedAgent> make_repeating(const Fault& fault, const Surroundings& around) {
  return std::make_unique<Repeating>(fault, around);
}

}  // namespace fleetproof::wrapped
