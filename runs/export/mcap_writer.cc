// SPDX-License-Identifier: BSD-3-Clause
#include "runs/export/mcap_writer.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "bus/version.h"

namespace halocline::clients {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 1024 * 1024;

enum Opcode : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

// Encoded fields of a record, little endian.
class Fields {
 public:
  template <class Number>
  Fields& number(Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
    return *this;
  }
  // Appends a text after its length.
  Fields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    return raw(value);
  }
  Fields& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  std::string record(Opcode opcode) const {
    return Fields()
        .number(static_cast<std::uint8_t>(opcode))
        .number(std::uint64_t{bytes_.size()})
        .raw(bytes_)
        .bytes();
  }

 private:
  std::string bytes_;
};

std::uint64_t nanoseconds(SimTime at) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(at.nanoseconds(), 0));
}

std::string joined(const std::vector<std::string>& records) {
  std::string all;
  for (const std::string& record : records) all += record;
  return all;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t crc) {
  static const auto kTable = [] {
    constexpr std::uint32_t kPolynomial = 0xEDB88320;
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? kPolynomial ^ (value >> 1) : value >> 1;
      table[i] = value;
    }
    return table;
  }();
  crc = ~crc;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<std::uint8_t>(c)) & 0xFF] ^ (crc >> 8);
  return ~crc;
}

McapWriter::McapWriter(std::string path)
    : path_(std::move(path)), replacement_(path_), file_(replacement_.temporary_path(), std::ios::binary) {
  if (!file_) throw std::runtime_error("cannot write " + path_);
  put(kMagic);
  put(Fields().text("").text("halocline " + std::string(bus::kVersion)).record(kHeader));
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  written_ += bytes.size();
  crc_ = crc32(bytes, crc_);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      std::string_view json_schema) {
  const auto [schema, is_new] =
      schema_ids_.emplace(schema_name, static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new)
    schemas_.push_back(Fields()
                           .number(schema->second)
                           .text(schema_name)
                           .text("jsonschema")
                           .text(json_schema)
                           .record(kSchema));
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_.push_back(Fields()
                          .number(id)
                          .number(schema->second)
                          .text(topic)
                          .text("json")
                          .number(std::uint32_t{0})
                          .record(kChannel));
  return id;
}

void McapWriter::write(std::uint16_t channel, SimTime at, std::string_view payload) {
  if (chunk_.size() > kChunkBytes) end_chunk();
  // Schemas and channels are written before their first message.
  for (; schemas_in_chunks_ < schemas_.size(); ++schemas_in_chunks_) chunk_ += schemas_[schemas_in_chunks_];
  for (; channels_in_chunks_ < channels_.size(); ++channels_in_chunks_)
    chunk_ += channels_[channels_in_chunks_];
  const std::uint64_t time_ns = nanoseconds(at);
  chunk_begin_ns_ = chunk_index_.empty() ? time_ns : std::min(chunk_begin_ns_, time_ns);
  chunk_end_ns_ = chunk_index_.empty() ? time_ns : std::max(chunk_end_ns_, time_ns);
  chunk_index_[channel].emplace_back(time_ns, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_ +=
      Fields().number(channel).number(sequence).number(time_ns).number(time_ns).raw(payload).record(kMessage);
}

void McapWriter::end_chunk() {
  if (chunk_index_.empty()) return;
  Chunk chunk{.offset = written_,
              .size = chunk_.size(),
              .begin_ns = chunk_begin_ns_,
              .end_ns = chunk_end_ns_,
              .index_offsets = {}};
  put(Fields()
          .number(chunk.begin_ns)
          .number(chunk.end_ns)
          .number(chunk.size)
          .number(crc32(chunk_))
          .text("")
          .number(chunk.size)
          .raw(chunk_)
          .record(kChunk));
  chunk.length = written_ - chunk.offset;
  const std::uint64_t index_begin = written_;
  for (const auto& [channel, entries] : chunk_index_) {
    chunk.index_offsets[channel] = written_;
    Fields index;
    for (const auto& [time_ns, offset] : entries) index.number(time_ns).number(offset);
    put(Fields().number(channel).text(index.bytes()).record(kMessageIndex));
  }
  chunk.index_length = written_ - index_begin;
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
  chunk_index_.clear();
}

std::string McapWriter::record_of(const Chunk& chunk) {
  Fields offsets;
  for (const auto& [channel, offset] : chunk.index_offsets) offsets.number(channel).number(offset);
  return Fields()
      .number(chunk.begin_ns)
      .number(chunk.end_ns)
      .number(chunk.offset)
      .number(chunk.length)
      .text(offsets.bytes())
      .number(chunk.index_length)
      .text("")
      .number(chunk.size)
      .number(chunk.size)
      .record(kChunkIndex);
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, begin_ns = chunks_.empty() ? 0 : chunks_.front().begin_ns, end_ns = 0;
  for (const Chunk& chunk : chunks_) {
    begin_ns = std::min(begin_ns, chunk.begin_ns);
    end_ns = std::max(end_ns, chunk.end_ns);
  }
  Fields counts;
  for (const auto& [channel, count] : counts_) {
    messages += count;
    counts.number(channel).number(count);
  }
  return Fields()
      .number(messages)
      .number(static_cast<std::uint16_t>(schemas_.size()))
      .number(static_cast<std::uint32_t>(channels_.size()))
      .number(std::uint32_t{0})
      .number(std::uint32_t{0})
      .number(static_cast<std::uint32_t>(chunks_.size()))
      .number(begin_ns)
      .number(end_ns)
      .text(counts.bytes())
      .record(kStatistics);
}

void McapWriter::close() {
  end_chunk();
  put(Fields().number(crc_).record(kDataEnd));
  const std::uint64_t summary_begin = written_;
  std::vector<std::string> indexes;
  for (const Chunk& chunk : chunks_) indexes.push_back(record_of(chunk));
  const std::vector<std::pair<Opcode, std::string>> groups{{kSchema, joined(schemas_)},
                                                           {kChannel, joined(channels_)},
                                                           {kStatistics, statistics()},
                                                           {kChunkIndex, joined(indexes)}};
  std::string summary, offsets;
  for (const auto& [opcode, records] : groups) {
    if (records.empty()) continue;
    offsets += Fields()
                   .number(static_cast<std::uint8_t>(opcode))
                   .number(summary_begin + summary.size())
                   .number(std::uint64_t{records.size()})
                   .record(kSummaryOffset);
    summary += records;
  }
  const std::uint64_t offsets_begin = summary_begin + summary.size();
  // Footer without its checksum, which covers all preceding bytes of the summary section.
  const std::string footer = Fields()
                                 .number(static_cast<std::uint8_t>(kFooter))
                                 .number(std::uint64_t{20})
                                 .number(summary_begin)
                                 .number(offsets_begin)
                                 .bytes();
  const std::string section = summary + offsets + footer;
  put(section);
  put(Fields().number(crc32(section)).bytes());
  put(kMagic);
  file_.close();
  if (!file_) throw std::runtime_error("cannot write " + path_);
  replacement_.commit();
}

}  // namespace halocline::clients
