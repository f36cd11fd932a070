// What an MQTT broker owes to whom, written from the standard alone: no bytes, no connections, nothing of core/bridges.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fleetproof::mqtt_model {

struct Message {
  std::string topic, text;
  int qos = 0;
  bool is_retained = false;
};

// "a/b" as its levels.
inline std::vector<std::string> levels_of(const std::string& text) {
  std::vector<std::string> levels(1);
  for (const char c : text) {
    if (c == '/') {
      levels.emplace_back();
    } else {
      levels.back() += c;
    }
  }
  return levels;
}

inline bool is_wanted(const std::vector<std::string>& filter, const std::vector<std::string>& topic,
                      std::size_t from = 0) {
  if (from == filter.size()) return from == topic.size();
  if (filter[from] == "#") return true;  // of the level above it, too
  if (from == topic.size()) return false;
  return (filter[from] == "+" || filter[from] == topic[from]) && is_wanted(filter, topic, from + 1);
}

class Model {
 public:
  explicit Model(std::size_t most_waiting) : most_waiting_(most_waiting) {}

  // A client that is there already is thrown out first.
  void connects(const std::string& name, bool is_kept, std::optional<Message> will) {
    if (clients_[name].is_there) goes(name, true);
    Client& client = clients_[name];
    if (!is_kept || !client.is_kept) client = {};
    client.is_kept = is_kept;
    client.is_there = true;
    client.will = std::move(will);
    for (Waiting& one : client.waiting) {
      say(name, one.message, one.was_said);
      one.was_said = true;
    }
  }
  void goes(const std::string& name, bool without_a_word) {
    Client& client = clients_[name];
    client.is_there = false;
    const auto will = std::exchange(client.will, std::nullopt);
    if (!client.is_kept) client = {};
    if (will && without_a_word) publishes(*will);
  }
  void subscribes(const std::string& name, const std::string& filter, int qos) {
    clients_[name].filters[filter] = qos;
    for (const auto& [topic, kept] : retained_) {
      if (is_wanted(levels_of(filter), levels_of(topic))) gives(name, kept, qos, true);
    }
  }
  void unsubscribes(const std::string& name, const std::string& filter) { clients_[name].filters.erase(filter); }
  void publishes(const Message& message) {
    if (message.is_retained) retained_.erase(message.topic);
    if (message.is_retained && !message.text.empty()) retained_[message.topic] = message;
    for (const auto& [name, client] : clients_) {
      int qos = -1;
      for (const auto& [filter, granted] : client.filters) {
        if (is_wanted(levels_of(filter), levels_of(message.topic))) qos = std::max(qos, granted);
      }
      if (qos >= 0) gives(name, message, qos, false);
    }
  }
  // Of the messages at QoS 1 that it was told and has not acknowledged, this one, in the order in which they were told.
  void acknowledges(const std::string& name, std::size_t which) {
    auto& waiting = clients_[name].waiting;
    waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(which));
  }
  // The power is gone for a moment: no wills.
  void restarts(bool has_disk) {
    if (!has_disk) retained_.clear();
    for (auto& [name, client] : clients_) {
      client.is_there = false;
      client.will.reset();
      if (!has_disk || !client.is_kept) client = {};
    }
  }
  bool is_there(const std::string& name) { return clients_[name].is_there; }
  std::vector<std::string> take_told(const std::string& name) { return std::exchange(told_[name], {}); }

  static std::string written(const Message& message, bool is_again) {
    return message.topic + "=" + message.text + " qos " + std::to_string(message.qos) +
           (message.is_retained ? " retained" : "") + (is_again ? " again" : "");
  }

 private:
  struct Waiting {  // for an acknowledgement
    Message message;
    bool was_said = false;
  };
  struct Client {
    bool is_kept = false, is_there = false;
    std::map<std::string, int> filters{};
    std::vector<Waiting> waiting{};
    std::optional<Message> will{};
  };

  void say(const std::string& name, const Message& message, bool is_again) {
    told_[name].push_back(written(message, is_again));
  }
  void gives(const std::string& name, Message message, int granted, bool is_retained) {
    Client& client = clients_[name];
    message.qos = std::min(message.qos, granted);
    message.is_retained = is_retained;
    if (message.qos == 1) {
      if (client.waiting.size() >= most_waiting_) return;
      client.waiting.push_back({message, client.is_there});
    }
    if (client.is_there) say(name, message, false);
  }

  std::size_t most_waiting_;
  std::map<std::string, Client> clients_;
  std::map<std::string, std::vector<std::string>> told_;
  std::map<std::string, Message> retained_;
};

}  // namespace fleetproof::mqtt_model
