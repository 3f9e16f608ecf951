// SPDX-License-Identifier: BSD-3-Clause
// UASP2, the acoustic streaming protocol of UnetStack: an ADC and a DAC of one channel each over the network.
//
// Format: "UnetStack acoustic streaming protocol v2" (org-arl/VirtualAcousticOcean.jl, 2025). Commands are
// lines of JSON over TCP. Samples for the DAC come in them, in base 64; samples of the ADC go by UDP to the
// port that a host names. A unit of data, big-endian:
//
//    uint64 time of the first sample, us; uint32 number; uint16 samples; uint16 channels; float32 samples
//
// Full scale is 1. At the DAC a sine of amplitude 1 has the source level of the vehicle's modem; at the ADC a
// pressure of 1 uPa gives 10^(sensitivity_db / 20). Time is simulation time since the last `ireset`.
//
// Options: `rate` and `output_rate`, samples per second of ADC and DAC until a host sets others;
// `sensitivity_db`, dB re 1/uPa. The ADC runs while a host streams it. A unit is sent a few tenths of a
// second after its time (sound_field.h); the time in it is exact. The DAC plays one buffer after another. The
// published protocol defines no errors: {"error": text} is an addition of Halocline. `quit` is ignored.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "bus/messages/message_codec.h"
#include "bus/version.h"
#include "clients/modem_gateway/protocols/interface_options.h"
#include "clients/modem_gateway/protocols/line_reader.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "clients/modem_gateway/protocols/protocols.h"
#include "clients/modem_gateway/protocols/sound_field.h"
#include "clients/modem_gateway/protocols/unet/unet_json.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/sim_time.h"
#include "core/text/base64.h"

namespace halocline::modem_gateway {
namespace {

using nlohmann::json;

constexpr std::size_t kHeaderBytes = 16, kSampleBytes = 4;
constexpr std::size_t kMaxBuffer = 2'880'000;  // samples
constexpr std::int64_t kBlock = 256;           // samples of a unit, 1040 bytes
constexpr double kBatch_s = 0.1;               // duration that is computed at a time, s
constexpr std::array<int, 4> kRates{24'000, 48'000, 96'000, 192'000};
constexpr std::int64_t kMaxTimeUs = 1'000'000'000'000'000;
constexpr double kMaxGainDb = 200;

double amplitude_of(double level_db) { return elementary::exp10(level_db / 20); }

bus::Bytes unit_of(std::int64_t time_us, std::uint32_t number, const double* samples, double gain) {
  bus::Bytes bytes;
  bus::append_uint32(static_cast<std::uint32_t>(time_us >> 32), bytes);
  bus::append_uint32(static_cast<std::uint32_t>(time_us), bytes);
  bus::append_uint32(number, bytes);
  bus::append_uint32(static_cast<std::uint32_t>(kBlock) << 16 | 1U, bytes);
  for (std::int64_t i = 0; i < kBlock; ++i)
    bus::append_uint32(std::bit_cast<std::uint32_t>(static_cast<float>(gain * samples[i])), bytes);
  return bytes;
}

// Decodes a unit; nothing unless it is a unit of one channel with finite samples.
std::optional<std::vector<float>> samples_of(const bus::Bytes& unit) {
  if (unit.size() < kHeaderBytes) return std::nullopt;
  const std::uint32_t sizes = bus::uint32_at(unit, 12), count = sizes >> 16, channels = sizes & 0xffff;
  if (channels != 1 || unit.size() != kHeaderBytes + kSampleBytes * count) return std::nullopt;
  std::vector<float> samples;
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(std::bit_cast<float>(bus::uint32_at(unit, kHeaderBytes + kSampleBytes * i)));
    if (!std::isfinite(samples.back())) return std::nullopt;
  }
  return samples;
}

class Uasp2 : public Protocol {
 public:
  explicit Uasp2(ProtocolContext context)
      : port_(context.port), sound_(context.sound), vehicle_id_(context.vehicle_id) {
    in_.rate = rate_option(context.options, "rate");
    out_.rate = rate_option(context.options, "output_rate");
    sensitivity_db_ = context.options.take_number("sensitivity_db", -190, -300, 0);
    context.options.require_all_taken();
  }

  void on_bytes(ClientId client, std::string_view bytes) override {
    readers_.try_emplace(client, LineReader::kMaxJson)
        .first->second.take(
            bytes, [&](std::string_view line) { take_line(client, line); },
            [&] { port_.note("line-too-long", "client=" + std::to_string(client)); },
            [&](std::string_view beginning, std::string_view end) {
              refuse_long_line(client, beginning, end);
            });
  }
  void on_closed(ClientId client) override {
    readers_.erase(client);
    streams_.erase(client);
    std::erase_if(notices_, [&](const auto& notice) { return notice.second.client == client; });
  }

  SimTime next() const override {
    const SimTime notice = notices_.empty() ? SimTime::never() : notices_.begin()->first;
    return std::min(notice, next_batch());
  }
  void step() override {
    while (!notices_.empty() && notices_.begin()->first <= port_.now()) {
      const Notice notice = notices_.extract(notices_.begin()).mapped();
      say(notice.client, notice.text);
    }
    while (next_batch() <= port_.now()) record();
  }

 private:
  struct Converter {
    int rate = 0;
    double gain_db = 0;
  };
  struct Stream {
    std::uint16_t port = 0;
    std::optional<std::int64_t> blocks_left;
  };
  struct Notice {
    ClientId client = 0;
    json text;
  };

  static int rate_option(InterfaceOptions& options, const std::string& name) {
    const double rate = options.take_number(name, 96'000, kRates.front(), kRates.back());
    const auto found = std::find(kRates.begin(), kRates.end(), rate);
    require(found != kRates.end(), "option " + name + " is no rate; allowed are 24000, 48000, 96000, 192000");
    return *found;
  }

  std::int64_t microseconds(SimTime time) const { return (time - origin_).nanoseconds() / 1000; }
  void say(ClientId client, const json& text) { port_.write(client, text.dump() + "\n"); }

  void refuse_long_line(ClientId client, std::string_view beginning, std::string_view end) {
    json answer{{"error", "line too long"}};
    json id = value_in_piece(beginning, "id");
    if (id.is_null()) id = value_in_piece(end, "id");
    if (!id.is_null()) answer["id"] = id;
    say(client, answer);
  }

  void take_line(ClientId client, std::string_view line) {
    const json request = json_of(line);
    json answer = request.is_object() ? obey(client, request) : json{{"error", "no JSON object"}};
    if (answer.is_null()) return;
    if (request.is_object() && request.contains("id")) answer["id"] = request["id"];
    say(client, answer);
  }

  // Returns the answer; null when none is due.
  json obey(ClientId client, const json& request) {
    const std::string action = text_of(request, "action");
    if (action == "version")
      return {{"name", "halocline"}, {"version", bus::kVersion}, {"protocol", "0.2.0"}};
    if (action == "get") return value_of(text_of(request, "param"));
    if (action == "set") return set(text_of(request, "param"), request.value("value", json()));
    if (action == "istart") return start_stream(client, request);
    if (action == "odata") return take_data(text_of(request, "data"));
    if (action == "ostart") return play(client, request);
    if (action == "ostop") return stop();
    if (action == "oclear") {
      buffer_.clear();
    } else if (action == "istop") {
      streams_.erase(client);
    } else if (action == "ireset") {
      number_ = 0;
      origin_ = port_.now();
    } else if (action != "quit") {
      return {{"error", "unknown action"}};
    }
    return json();
  }

  json value_of(const std::string& name) const {
    const std::map<std::string, json> values{{"time", microseconds(port_.now())},
                                             {"iseqno", number_},
                                             {"iblksize", kBlock},
                                             {"irate", in_.rate},
                                             {"irates", kRates},
                                             {"ichannels", 1},
                                             {"igain", in_.gain_db},
                                             {"obufsize", kMaxBuffer},
                                             {"orate", out_.rate},
                                             {"orates", kRates},
                                             {"ochannels", 1},
                                             {"ogain", out_.gain_db},
                                             {"omute", is_mute_}};
    const auto found = values.find(name);
    if (found == values.end()) return {{"error", "unknown param"}};
    return {{"param", name}, {"value", found->second}};
  }

  json set(const std::string& name, const json& value) {
    const bool is_in = name.starts_with('i');
    Converter& converter = is_in ? in_ : out_;
    const double number = value.is_number() ? value.get<double>() : NAN;
    if ((name == "irate" || name == "orate") &&
        std::find(kRates.begin(), kRates.end(), number) != kRates.end()) {
      converter.rate = static_cast<int>(number);
      if (is_in) next_block_ = first_block();
    } else if ((name == "igain" || name == "ogain") && std::abs(number) <= kMaxGainDb) {
      converter.gain_db = number;
    } else if (name == "omute" && value.is_boolean()) {
      is_mute_ = value.get<bool>();
    } else {
      return {{"error", "no such param or value"}};
    }
    return json();
  }

  // Returns the number of the first block of the ADC that begins now or later.
  std::int64_t first_block() const {
    return static_cast<std::int64_t>(
        std::ceil(port_.now().seconds() * in_.rate / static_cast<double>(kBlock)));
  }

  json start_stream(ClientId client, const json& request) {
    const std::int64_t port = integer_of(request, "port"), blocks = integer_of(request, "blocks");
    if (port < 1 || port > 65'535 || blocks < 0) return {{"error", "no such port or blocks"}};
    if (streams_.empty()) next_block_ = first_block();
    streams_[client] = {static_cast<std::uint16_t>(port), blocks > 0 ? std::optional(blocks) : std::nullopt};
    return json();
  }

  std::int64_t batch() const {
    const auto usual = static_cast<std::int64_t>(kBatch_s * in_.rate) / kBlock;
    std::int64_t wanted = 0;
    for (const auto& [client, stream] : streams_)
      wanted = std::max(wanted, std::min(stream.blocks_left.value_or(usual), usual));
    return wanted;
  }
  SimTime next_batch() const {
    if (streams_.empty()) return SimTime::never();
    const std::int64_t samples = (next_block_ + batch()) * kBlock;
    return SimTime::from_seconds(static_cast<double>(samples) / in_.rate) + sound_->lag();
  }

  void record() {
    const std::int64_t blocks = batch();
    const auto pressure = sound_->record(vehicle_id_, in_.rate, next_block_ * kBlock,
                                         static_cast<std::size_t>(blocks * kBlock));
    const double gain = amplitude_of(sensitivity_db_ + in_.gain_db);
    for (std::int64_t i = 0; i < blocks; ++i, ++next_block_, ++number_) {
      const SimTime begin = SimTime::from_seconds(static_cast<double>(next_block_ * kBlock) / in_.rate);
      const bus::Bytes unit = unit_of(microseconds(begin), number_, pressure.data() + i * kBlock, gain);
      for (auto& [client, stream] : streams_) {
        if (stream.blocks_left == 0) continue;
        port_.send_datagram(client, stream.port, {reinterpret_cast<const char*>(unit.data()), unit.size()});
        if (stream.blocks_left) --*stream.blocks_left;
      }
    }
    std::erase_if(streams_, [](const auto& entry) { return entry.second.blocks_left == 0; });
  }

  json take_data(const std::string& base64) {
    const auto unit = bytes_of_base64(base64);
    const auto samples = unit ? samples_of(*unit) : std::nullopt;
    if (!samples) return {{"error", "no unit of one channel"}};
    if (buffer_.size() + samples->size() > kMaxBuffer) return {{"error", "buffer full"}};
    buffer_.insert(buffer_.end(), samples->begin(), samples->end());
    return json();
  }

  json play(ClientId client, const json& request) {
    const std::int64_t time_us = integer_of(request, "time");
    if (time_us < 0 || time_us > kMaxTimeUs) return {{"error", "no such time"}};
    const SimTime asked = origin_ + SimDuration::from_microseconds(time_us);
    const SimTime begin = std::max({port_.now(), asked, free_at_});
    std::vector<float> samples = std::exchange(buffer_, {});
    const double gain = is_mute_ ? 0 : amplitude_of(out_.gain_db);
    for (float& sample : samples) sample = static_cast<float>(gain * double{sample});
    free_at_ = begin + SimDuration::from_seconds(static_cast<double>(samples.size()) / out_.rate);
    sound_->emit(vehicle_id_, begin, out_.rate, samples);
    for (const auto& [event, at] : {std::pair("ostart", begin), std::pair("ostop", free_at_)}) {
      json notice{{"event", event}, {"time", microseconds(at)}};
      if (request.contains("id")) notice["id"] = request["id"];
      notices_.emplace(at, Notice{client, std::move(notice)});
    }
    return json();
  }

  json stop() {
    if (free_at_ <= port_.now()) return json();
    free_at_ = port_.now();
    sound_->silence(vehicle_id_, free_at_);
    notices_.clear();
    say(kAllClients, {{"event", "ostop"}, {"time", microseconds(free_at_)}});
    return json();
  }

  ProtocolPort& port_;
  SoundField* sound_;  // null while options alone are checked, which uses no sound
  std::int32_t vehicle_id_;
  double sensitivity_db_ = 0;
  Converter in_, out_;
  bool is_mute_ = false;
  std::map<ClientId, LineReader> readers_;
  std::map<ClientId, Stream> streams_;
  SimTime origin_;               // start of the time that hosts see
  std::uint32_t number_ = 0;     // number of the next unit
  std::int64_t next_block_ = 0;  // number of the next block, counted from simulation time 0
  std::vector<float> buffer_;
  SimTime free_at_;  // time from which the DAC is free
  std::multimap<SimTime, Notice> notices_;
};

}  // namespace

std::unique_ptr<Protocol> make_uasp2(ProtocolContext context) {
  return std::make_unique<Uasp2>(std::move(context));
}

}  // namespace halocline::modem_gateway
