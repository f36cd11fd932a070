// Damaged messages of VDA 5050, the same each time: a vehicle neither crashes nor grows, and tells states that can be
// read. FLEETPROOF_FUZZED: so many, for releases.
#include <gmock/gmock.h>

#include <cstdlib>
#include <random>
#include <string>

#include "core/bridges/vda5050/vehicle_protocol.hpp"

namespace fleetproof::vda5050_fuzz_test {
namespace {

std::uint64_t wanted() {
  const char* text = std::getenv("FLEETPROOF_FUZZED");
  return text == nullptr ? 50'000 : std::strtoull(text, nullptr, 10);
}

// Bits flipped, bytes changed, added, taken out, and the ends of others put behind.
class Damage {
 public:
  explicit Damage(std::vector<std::string> samples) : samples_(std::move(samples)) {}
  std::string next() {
    std::string bytes = any();
    for (std::uint64_t times = draw(4); times > 0 && !bytes.empty(); --times) {
      const std::size_t at = draw(bytes.size());
      switch (draw(5)) {
        case 0:
          bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1U << draw(8)));
          break;
        case 1:
          bytes[at] = static_cast<char>(draw(256));
          break;
        case 2:
          bytes.insert(at, 1, static_cast<char>(draw(256)));
          break;
        case 3:
          bytes.erase(at, 1 + draw(4));
          break;
        default:
          bytes.resize(at);
          bytes += any();
      }
    }
    return bytes;
  }

 private:
  std::uint64_t draw(std::uint64_t below) { return draws_() % below; }
  const std::string& any() { return samples_[draw(samples_.size())]; }

  std::vector<std::string> samples_;
  std::mt19937_64 draws_{5050};
};

TEST(Vda5050Fuzz, AVehicleLivesAndTellsAStateThatCanBeRead) {
  using namespace bridges::vda5050;
  Order order{{1, "2026-01-01T00:00:00.00Z", "2.1.0", "fp", "agv1"}, "o1", 0, {}, {}, {}};
  order.nodes = {{"n1", 0, {}, true, {}, {}}, {"n2", 2, {}, true, {}, {{"beep", "a1", {}, BlockingType::Hard, {}}}}};
  Edge edge;
  edge.edge_id = "e1";
  edge.sequence_id = 1;
  edge.released = true;
  edge.start_node_id = "n1";
  edge.end_node_id = "n2";
  order.edges = {edge};
  const InstantActions cancel{order.header, {{"cancelOrder", "i1", {}, BlockingType::Hard, {}}}};
  const Version& version = versions().back();
  Damage damage({write_document(order, version), write_document(cancel, version)});
  VehicleSettings settings;
  settings.identity = {&version, "fp", "agv1", 0};
  settings.abilities.actions = {{"beep"}};
  VehicleProtocol vehicle(settings, {});
  vehicle.hear(ConnectionOpened{});
  vehicle.hear(StandsAt{"n1"});
  std::size_t longest = 0, drives = 0;
  for (std::uint64_t i = 0; i < wanted(); ++i) {
    const std::string bytes = damage.next();
    vehicle.order_received(bytes);
    vehicle.instant_actions_received(bytes);
    drives += vehicle.driving_wish().edges.size();
    if (i % 50 == 0) vehicle.hear(StandsAt{"n1"});
    for (const Publication& one : vehicle.publish(static_cast<std::int64_t>(i))) {
      State state;
      std::string why;
      if (one.topic == Topic::State && i % 10 == 0) {
        EXPECT_TRUE(read_document(one.payload, version, state, why)) << why;
      }
      longest = std::max(longest, one.payload.size());
    }
  }
  EXPECT_GT(drives, 0U);
  EXPECT_LT(longest, 500'000U) << "what it remembers of refusals has an end";
}

}  // namespace
}  // namespace fleetproof::vda5050_fuzz_test
