// The broker against a model that knows nothing of it, in drawn sequences; FLEETPROOF_SEEDS says how many.
#include "tests/bridges/mqtt_model.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <memory>
#include <random>

#include "tests/bridges/mqtt_bench.hpp"

namespace fleetproof::mqtt_model_test {
namespace {

using namespace mqtt;
using mqtt_model::Message;

constexpr std::size_t kMostWaiting = 12;              // more than there are filters
constexpr std::int64_t kSilence_ns = 15'000'000'000;  // of a client with a keep-alive time of 10 s

// A broker and its model, and clients that do the same to both.
class Drill {
 public:
  explicit Drill(std::uint64_t seed) : draws_(seed) {}

  void step() {
    const std::string name = one_of({"a", "b", "c", "d"});
    const std::size_t what = below(100);
    if (what >= 96) return restarts(below(2) == 0);
    if (what >= 90) return time_passes();
    if (!model_.is_there(name)) return connects(name);
    if (what < 6) return connects(name);
    if (what < 12) return goes(name);
    if (what < 30) return subscribes(name);
    if (what < 36) return unsubscribes(name);
    if (what < 55) return acknowledges(name);
    publishes(name);
  }
  // What each client was told, and what it ought to have been told.
  void compare() {
    for (const auto& [name, client] : clients_) {
      std::vector<std::string> told;
      while (const auto packet = bench_->out[client.connection].next()) {
        const auto* publish = std::get_if<Publish>(&*packet);
        if (publish == nullptr) continue;
        told.push_back(mqtt_model::Model::written({publish->topic, publish->payload, publish->qos, publish->retain},
                                                  publish->is_again));
        if (publish->qos == 1) clients_[name].unacknowledged.push_back(publish->id);
      }
      EXPECT_EQ(told, model_.take_told(name)) << name;
      messages += told.size();
      for (const std::string& one : told) {
        again += one.ends_with("again") ? 1 : 0;
        retained += one.find(" retained") != one.npos ? 1 : 0;
      }
      EXPECT_EQ(bench_->closed.contains(client.connection), !model_.is_there(name) && !client.is_lost) << name;
    }
  }

  std::size_t messages = 0, again = 0, retained = 0, silent = 0;

 private:
  struct Known {
    std::uint32_t connection = 0;
    bool is_lost = false;
    std::int64_t heard_ns = 0;
    std::vector<std::uint16_t> unacknowledged{};  // in the order in which they came
  };

  std::size_t below(std::size_t end) { return static_cast<std::size_t>(draws_() % end); }
  std::string one_of(std::initializer_list<const char*> texts) { return texts.begin()[below(texts.size())]; }
  std::string topic() { return one_of({"t", "t/1", "t/2", "t/1/x", "u", "/"}); }
  std::string filter() { return one_of({"t", "t/1", "t/+", "t/#", "#", "+", "+/1", "+/+", "/", "u", "t/+/x"}); }
  Message message() {
    return {topic(), below(8) == 0 ? "" : std::to_string(++last_text_), static_cast<int>(below(2)), below(4) == 0};
  }
  void say(const std::string& name, const Packet& packet) {
    clients_[name].heard_ns = bench_->now_ns;
    bench_->say(clients_[name].connection, packet);
  }

  void connects(const std::string& name) {
    const bool is_kept = below(3) > 0;
    std::optional<Message> will;
    Connect connect{.client = name, .is_clean = !is_kept, .keep_alive_s = 10};
    if (below(2) == 0) {
      will = message();
      connect.will = Will{will->topic, will->text, static_cast<std::uint8_t>(will->qos), will->is_retained};
    }
    model_.connects(name, is_kept, will);
    Known& client = clients_[name];
    const std::uint32_t former = std::exchange(client.connection, ++last_connection_);
    bench_->broker.opened(client.connection, bench_->now_ns);
    client.is_lost = false;
    say(name, connect);
    while (bench_->out[former].next()) continue;  // the other one has read what was said to it
    client.unacknowledged.clear();
  }
  void goes(const std::string& name) {
    const bool without_a_word = below(2) == 0;
    model_.goes(name, without_a_word);
    if (without_a_word) {
      clients_[name].is_lost = true;
      bench_->broker.lost(clients_[name].connection);
    } else {
      say(name, Disconnect{});
    }
  }
  void subscribes(const std::string& name) {
    const std::string text = filter();
    const auto qos = static_cast<std::uint8_t>(below(3));
    model_.subscribes(name, text, std::min<int>(qos, 1));
    say(name, Subscribe{7, {{text, qos}}});
  }
  void unsubscribes(const std::string& name) {
    const std::string text = filter();
    model_.unsubscribes(name, text);
    say(name, Unsubscribe{8, {text}});
  }
  void publishes(const std::string& name) {
    const Message one = message();
    model_.publishes(one);
    say(name, Publish{.topic = one.topic,
                      .payload = one.text,
                      .qos = static_cast<std::uint8_t>(one.qos),
                      .retain = one.is_retained,
                      .id = static_cast<std::uint16_t>(one.qos)});
  }
  // Any message, not only the oldest one.
  void acknowledges(const std::string& name) {
    auto& unacknowledged = clients_[name].unacknowledged;
    if (unacknowledged.empty()) return;
    const std::size_t which = below(unacknowledged.size());
    model_.acknowledges(name, which);
    say(name, Puback{unacknowledged[which]});
    unacknowledged.erase(unacknowledged.begin() + static_cast<std::ptrdiff_t>(which));
  }
  void time_passes() {
    bench_->now_ns += static_cast<std::int64_t>(1 + below(9)) * 1'000'000'000;
    std::map<std::uint32_t, std::string> in_order;
    for (const auto& [name, client] : clients_) {
      if (model_.is_there(name) && bench_->now_ns - client.heard_ns >= kSilence_ns) in_order[client.connection] = name;
    }
    for (const auto& [connection, name] : in_order) model_.goes(name, true);
    silent += in_order.size();
    bench_->broker.tick(bench_->now_ns);
  }
  void restarts(bool has_disk) {
    model_.restarts(has_disk);
    const std::string disk = bench_->broker.saved();
    for (auto& [name, client] : clients_) client.is_lost = true;
    const std::int64_t now_ns = bench_->now_ns;
    bench_ = std::make_unique<BrokerBench>(settings());
    bench_->now_ns = now_ns;
    if (has_disk) {
      EXPECT_TRUE(bench_->broker.restore(disk));
    }
  }
  static BrokerSettings settings() { return {.most_of_session = kMostWaiting}; }

  std::mt19937_64 draws_;
  std::unique_ptr<BrokerBench> bench_ = std::make_unique<BrokerBench>(settings());
  mqtt_model::Model model_{kMostWaiting};
  std::map<std::string, Known> clients_;
  std::uint32_t last_connection_ = 0;
  int last_text_ = 0;
};

TEST(MqttModel, TheBrokerGivesToEachWhatTheModelOwesIt) {
  const char* wanted = std::getenv("FLEETPROOF_SEEDS");
  const std::uint64_t seeds = wanted == nullptr ? 2'000 : std::strtoull(wanted, nullptr, 10);
  std::size_t messages = 0, again = 0, retained = 0, silent = 0;
  for (std::uint64_t seed = 1; seed <= seeds && !testing::Test::HasFailure(); ++seed) {
    Drill drill(seed);
    for (int step = 0; step < 150 && !testing::Test::HasFailure(); ++step) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
      drill.step();
      drill.compare();
    }
    messages += drill.messages;
    again += drill.again;
    retained += drill.retained;
    silent += drill.silent;
  }
  EXPECT_GT(messages, 50 * seeds);
  EXPECT_GT(again, seeds);
  EXPECT_GT(retained, seeds);
  EXPECT_GT(silent, seeds / 10);
}

// The model itself, on the examples of section 4.7.
TEST(MqttModel, ItsFiltersAreThoseOfTheStandard) {
  const auto wanted = [](const char* filter, const char* topic) {
    return mqtt_model::is_wanted(mqtt_model::levels_of(filter), mqtt_model::levels_of(topic));
  };
  EXPECT_TRUE(wanted("sport/tennis/player1/#", "sport/tennis/player1"));
  EXPECT_TRUE(wanted("sport/#", "sport"));
  EXPECT_FALSE(wanted("sport/tennis/+", "sport/tennis/player1/ranking"));
  EXPECT_FALSE(wanted("sport/+", "sport"));
  EXPECT_TRUE(wanted("sport/+", "sport/"));
  EXPECT_TRUE(wanted("+/+", "/finance"));
  EXPECT_FALSE(wanted("+", "/finance"));
}

}  // namespace
}  // namespace fleetproof::mqtt_model_test
