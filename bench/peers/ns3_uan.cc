// SPDX-License-Identifier: BSD-3-Clause
// How many outcomes a second of CPU ns-3's underwater acoustic network (UAN) decides: NODES nodes within 2
// km, 32 bytes of Aloha from each once a minute for SECONDS, Thorp's absorption, ambient noise. What is
// decided: a packet at each other node.
//
//   ns3_uan NODES SECONDS: prints outcomes, of them received, and seconds of CPU.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <ns3/core-module.h>
#include <ns3/mobility-module.h>
#include <ns3/network-module.h>
#include <ns3/uan-module.h>

namespace {

constexpr double kPeriodS = 60, kSideM = 2000;
std::uint64_t received = 0;

void send(const ns3::Ptr<ns3::NetDevice>& device) {
  device->Send(ns3::Create<ns3::Packet>(32), device->GetBroadcast(), 0);
  ns3::Simulator::Schedule(ns3::Seconds(kPeriodS), &send, device);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: ns3_uan NODES SECONDS\n");
    return 2;
  }
  const int count = std::atoi(argv[1]);
  const double seconds = std::atof(argv[2]);
  ns3::NodeContainer nodes;
  nodes.Create(static_cast<std::uint32_t>(count));
  ns3::MobilityHelper mobility;
  auto places = ns3::CreateObject<ns3::ListPositionAllocator>();
  for (int i = 1; i <= count; ++i)  // as in studies/fleet/scenario.py
    places->Add(ns3::Vector(kSideM * ((i * 733) % 1000) / 1000, kSideM * ((i * 389) % 1000) / 1000,
                            30 + (i * 17) % 80));
  mobility.SetPositionAllocator(places);
  mobility.SetMobilityModel("ns3::ConstantPositionMobilityModel");
  mobility.Install(nodes);

  auto channel = ns3::CreateObject<ns3::UanChannel>();
  channel->SetPropagationModel(ns3::CreateObject<ns3::UanPropModelThorp>());
  channel->SetNoiseModel(ns3::CreateObject<ns3::UanNoiseModelDefault>());
  ns3::UanHelper uan;
  uan.SetMac("ns3::UanMacAloha");
  const ns3::NetDeviceContainer devices = uan.Install(nodes, channel);
  for (std::uint32_t i = 0; i < devices.GetN(); ++i) {
    devices.Get(i)->SetReceiveCallback([](ns3::Ptr<ns3::NetDevice>, ns3::Ptr<const ns3::Packet>,
                                          std::uint16_t, const ns3::Address&) { return ++received > 0; });
    ns3::Simulator::Schedule(ns3::Seconds(kPeriodS * i / count), &send, devices.Get(i));
  }
  ns3::Simulator::Stop(ns3::Seconds(seconds));
  const std::clock_t begin = std::clock();
  ns3::Simulator::Run();
  const double cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::printf("%.0f %llu %.3f\n", count * seconds / kPeriodS * (count - 1),
              static_cast<unsigned long long>(received), cpu_s);
  ns3::Simulator::Destroy();
}
