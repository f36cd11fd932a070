// The work of the agent `null` in ns-3, over its cheapest channel: nodes send 64 bytes to all others every 300 ms.
//
//   ns3_messages NODES HORIZON_S
//
// Each reception is lost with 40 % and 2 s late otherwise. There is no place, no range and no medium. Not part of the
// build: `peers` compiles it where ns-3 is installed.
#include <ns3/core-module.h>
#include <ns3/network-module.h>

#include <cstdio>
#include <cstdlib>

namespace {

constexpr double kPeriod_s = 0.3, kDelay_s = 2.0, kLoss = 0.4;

std::uint64_t sent = 0, received = 0;

void send(const ns3::Ptr<ns3::SimpleNetDevice>& device) {
  device->Send(ns3::Create<ns3::Packet>(64), device->GetBroadcast(), 0x0800);
  ++sent;
  ns3::Simulator::Schedule(ns3::Seconds(kPeriod_s), &send, device);
}

bool receive(ns3::Ptr<ns3::NetDevice>, ns3::Ptr<const ns3::Packet>, std::uint16_t, const ns3::Address&) {
  ++received;
  return true;
}

ns3::Ptr<ns3::SimpleNetDevice> device_on(const ns3::Ptr<ns3::SimpleChannel>& channel) {
  const auto node = ns3::CreateObject<ns3::Node>();
  const auto device = ns3::CreateObject<ns3::SimpleNetDevice>();
  const auto loss = ns3::CreateObject<ns3::RateErrorModel>();
  loss->SetUnit(ns3::RateErrorModel::ERROR_UNIT_PACKET);
  loss->SetRate(kLoss);
  device->SetReceiveErrorModel(loss);
  device->SetAddress(ns3::Mac48Address::Allocate());
  device->SetChannel(channel);
  node->AddDevice(device);
  device->SetReceiveCallback(ns3::MakeCallback(&receive));
  return device;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::printf("ns3_messages NODES HORIZON_S\n"), 2;
  const int nodes = std::atoi(argv[1]);
  const auto channel = ns3::CreateObject<ns3::SimpleChannel>();
  channel->SetAttribute("Delay", ns3::TimeValue(ns3::Seconds(kDelay_s)));
  for (int i = 0; i < nodes; ++i)
    ns3::Simulator::Schedule(ns3::Seconds(kPeriod_s * i / nodes), &send, device_on(channel));
  ns3::Simulator::Stop(ns3::Seconds(std::atof(argv[2])));
  ns3::Simulator::Run();
  ns3::Simulator::Destroy();
  std::printf("sent %llu receptions %llu\n", static_cast<unsigned long long>(sent),
              static_cast<unsigned long long>(received));
}
