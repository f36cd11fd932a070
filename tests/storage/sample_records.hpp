#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof::samples {

inline CampaignRecord campaign() {
  CampaignRecord record;
  record.name = "nightly";
  record.kind = "claim";
  record.seed = 0xfedcba9876543210ULL;  // its top bit is set: it must survive a signed column
  record.replicates = 40;
  record.plan_json = R"({"layouts":{"ring":{}}})";
  record.plan_hash = 0x8000000000000001ULL;
  record.engine = {"0.1.0", "ab12", "g++ 12.2.0", "-O2", "SQLite 3.40.1", "92814cf7"};
  record.required_probes = {"encounter", "negotiation?"};
  record.held_streams = {"layout", "radio"};
  record.held_replicate = 3;
  record.exempt_purposes = "charging parking";
  record.exempt_radius_m = 1.25;
  record.exempt_pairs = {"tugger and cart", "cart and obstacle"};
  record.plugin_agents = {"sound"};
  return record;
}

inline std::vector<CellRecord> cells() {
  std::vector<CellRecord> list;
  for (const double loss : {0.0, 0.4}) {
    for (const double delay_s : {0.0, 2.0, 5.0}) {
      list.push_back({static_cast<std::uint32_t>(list.size()), "sound", "ring", 5, {loss, delay_s}});
    }
  }
  return list;
}

inline std::vector<GateRecord> gates() {
  GateRecord none;
  none.name = "safe";
  none.agent = "sound";
  none.kind = GateKind::None;
  none.method = GateMethod::Fixed;
  GateRecord rate;
  rate.index = 1;
  rate.name = "rare contact";
  rate.agent = "sound";
  rate.requirement = "SR-12";
  rate.end_point = EndPoint::Contact;
  rate.region = Region::WorstCase;
  rate.where.layout = "ring";
  rate.where.fleet_size = 5;
  rate.where.factors[Factor::Delay] = 2.0;
  rate.where.factors[Factor::CallCost] = 0.0;
  rate.unit = GateUnit::AgvHour;
  rate.limit = 1e-2;
  rate.confidence = 0.99;
  rate.min_transports_per_agv_hour = 0.5;
  rate.decides = false;
  rate.table = {{38, 73, 103}, {0, 1}};
  return {none, rate};
}

inline StoredPlan plan() { return {campaign(), cells(), gates()}; }

// Every field filled at random, with whole words of 64 bits.
inline Outcome random_outcome(std::mt19937_64& random) {
  Outcome o;
  for (const auto flag : {&Outcome::violation, &Outcome::contact, &Outcome::stuck, &Outcome::crash, &Outcome::hang,
                          &Outcome::indeterminate, &Outcome::engine_error}) {
    o.*flag = random() % 2 == 0;
  }
  if (random() % 3 != 0) o.min_clearance_um = static_cast<std::int64_t>(random());
  std::array<std::uint64_t, sizeof(Counters) / sizeof(std::uint64_t)> words{};
  std::ranges::generate(words, std::ref(random));
  o.counters = std::bit_cast<Counters>(words);
  o.simulated_ns = random();
  o.agv_count = static_cast<std::uint32_t>(random());
  o.digest = random();
  for (auto i = random() % 5; i > 0; --i) o.running_digests.push_back(random());
  for (auto i = random() % 20; i > 0; --i)
    o.message.push_back(static_cast<char>(random()));  // zero bytes and broken UTF-8 included
  for (auto i = random() % 4; i > 0; --i) {
    Violation v;
    v.a = EntityId{static_cast<std::uint32_t>(random())};
    v.b = EntityId{static_cast<std::uint32_t>(random())};
    v.first = at_ns(static_cast<std::int64_t>(random()));
    v.last = at_ns(static_cast<std::int64_t>(random()));
    v.closest_at = at_ns(static_cast<std::int64_t>(random()));
    v.min_clearance_um = static_cast<std::int64_t>(random());
    v.relative_speed_um_s = static_cast<std::int64_t>(random());
    v.normal_speed_um_s = static_cast<std::int64_t>(random());
    v.x_um = static_cast<std::int64_t>(random());
    v.y_um = static_cast<std::int64_t>(random());
    v.contact = random() % 2 == 0;
    o.violations.push_back(v);
  }
  for (auto i = random() % 4; i > 0; --i) {
    Incident incident;
    incident.kind = static_cast<IncidentKind>(1 + random() % incident_kinds().size());
    if (random() % 2 == 0) incident.a = EntityId{static_cast<std::uint32_t>(random() % 1000)};
    if (random() % 2 == 0) incident.b = EntityId{static_cast<std::uint32_t>(random() % 1000)};
    incident.first = at_ns(static_cast<std::int64_t>(random()));
    incident.last = at_ns(static_cast<std::int64_t>(random()));
    incident.value = static_cast<std::int64_t>(random());
    o.incidents.push_back(incident);
  }
  for (auto i = random() % 4; i > 0; --i) {
    ProbeCount probe{random() % 2 == 0 ? ProbeSource::World : ProbeSource::Agent, {}, random()};
    for (auto length = random() % 20; length > 0; --length) probe.name.push_back(static_cast<char>(random()));
    o.probes.push_back(probe);
  }
  return o;
}

// Runs 0 .. count-1 of the sample campaign.
inline std::vector<RunRecord> runs(std::uint64_t count, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::vector<RunRecord> list;
  for (std::uint64_t i = 0; i < count; ++i) {
    RunRecord run;
    run.run_index = i;
    run.cell = static_cast<std::uint32_t>(i % cells().size());
    run.replicate = i / cells().size();
    run.scenario_digest = random();
    run.factors = cells()[run.cell].lowest;
    run.outcome = random_outcome(random);
    list.push_back(run);
  }
  return list;
}

// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fleetproof-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace fleetproof::samples
