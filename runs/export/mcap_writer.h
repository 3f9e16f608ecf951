// SPDX-License-Identifier: BSD-3-Clause
// Writer of MCAP files (mcap.dev/spec, version 0): uncompressed chunks with an index, a summary and
// checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "core/sim_time.h"

namespace halocline::clients {

// Returns the CRC-32 of ISO 3309, as in zlib; `crc` is the checksum of the bytes before.
std::uint32_t crc32(std::string_view bytes, std::uint32_t crc = 0);

class McapWriter {
 public:
  // Starts a file, which close() moves into place. Throws std::runtime_error when it cannot be written.
  explicit McapWriter(std::string path);

  // Adds a channel of JSON messages with this JSON schema. Channels with the same name of a schema share the
  // schema.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            std::string_view json_schema);
  void write(std::uint16_t channel, SimTime at, std::string_view payload);
  // Completes the file; to be called once. Throws as the constructor.
  void close();

 private:
  struct Chunk {
    std::uint64_t offset = 0, length = 0, size = 0, begin_ns = 0, end_ns = 0, index_length = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };
  void put(std::string_view bytes);
  void end_chunk();
  std::string statistics() const;
  static std::string record_of(const Chunk& chunk);

  std::string path_;
  AtomicFile replacement_;
  std::ofstream file_;
  std::uint64_t written_ = 0;
  std::uint32_t crc_ = 0;  // checksum of the data section so far
  std::map<std::string, std::uint16_t> schema_ids_;
  std::vector<std::string> schemas_, channels_;  // encoded records
  std::size_t channels_in_chunks_ = 0, schemas_in_chunks_ = 0;
  std::string chunk_;  // records of the current chunk
  std::uint64_t chunk_begin_ns_ = 0, chunk_end_ns_ = 0;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_index_;
  std::vector<Chunk> chunks_;
  std::map<std::uint16_t, std::uint64_t> counts_;
};

}  // namespace halocline::clients
