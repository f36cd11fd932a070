// The work of the agent `null` in SimGrid, as blocking actors: each sleeps 300 ms, sends to all others, and so on.
//
//   simgrid_actors ACTORS HORIZON_S
//
// A second actor of each host waits for its messages, one after the other. Each is 2 s late; SimGrid loses none. Not
// part of the build: `peers` compiles it where SimGrid is installed.
#include <simgrid/s4u.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

namespace sg4 = simgrid::s4u;

constexpr double kPeriod_s = 0.3, kDelay_s = 2.0;
constexpr std::uint64_t kBytes = 64;

std::uint64_t sent = 0, received = 0;
int message = 0;

void send(std::size_t self, const std::vector<sg4::Mailbox*>& boxes) {
  sg4::this_actor::sleep_for(kPeriod_s * static_cast<double>(self) / static_cast<double>(boxes.size()));
  for (;;) {
    for (std::size_t other = 0; other < boxes.size(); ++other) {
      if (other != self) boxes[other]->put_init(&message, kBytes)->detach();
    }
    ++sent;
    sg4::this_actor::sleep_for(kPeriod_s);
  }
}

void receive(sg4::Mailbox* box) {
  for (;;) {
    box->get<int>();
    ++received;
  }
}

}  // namespace

int main(int argc, char** argv) {
  sg4::Engine engine(&argc, argv);
  sg4::Engine::set_config("network/model:CM02");  // latencies as given
  if (argc < 3) return std::printf("simgrid_actors ACTORS HORIZON_S\n"), 2;
  const auto actors = static_cast<std::size_t>(std::atoi(argv[1]));
  auto* const zone = sg4::create_full_zone("floor");
  std::vector<sg4::Host*> hosts;
  std::vector<sg4::Mailbox*> boxes;
  auto* const link =
      zone->create_link("radio", 1e9)->set_latency(kDelay_s)->set_sharing_policy(sg4::Link::SharingPolicy::FATPIPE);
  for (std::size_t i = 0; i < actors; ++i) {
    hosts.push_back(zone->create_host("agv" + std::to_string(i), 1e9));
    boxes.push_back(sg4::Mailbox::by_name("agv" + std::to_string(i)));
  }
  for (std::size_t i = 0; i < actors; ++i) {
    for (std::size_t j = i + 1; j < actors; ++j)
      zone->add_route(hosts[i]->get_netpoint(), hosts[j]->get_netpoint(), nullptr, nullptr, {sg4::LinkInRoute(link)});
  }
  zone->seal();
  for (std::size_t i = 0; i < actors; ++i) {
    const auto receiver = sg4::Actor::create("receive", hosts[i], receive, boxes[i]);
    receiver->daemonize();
    boxes[i]->set_receiver(receiver);  // so that a message is under way before the actor waits for it
    sg4::Actor::create("send", hosts[i], send, i, boxes)->daemonize();
  }
  const double horizon_s = std::atof(argv[2]);
  sg4::Actor::create("end", hosts[0], [horizon_s] { sg4::this_actor::sleep_for(horizon_s); });
  engine.run();
  std::printf("sent %llu receptions %llu\n", static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(received));
}
