#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace parallax::harness {

/// A file of the MCAP format, version 0 (mcap.dev/spec): messages in chunks that are not
/// compressed, with an index of each chunk, a summary and all checksums. Messages are added in
/// order of time.
class McapWriter {
 public:
  /// Number of a topic for JSON messages; `schema` is a JSON schema.
  std::uint16_t add_topic(const std::string& topic, const std::string& schema_name,
                          const std::string& schema);
  void add(std::uint16_t topic, std::uint64_t time_ns, std::string_view message);
  /// The whole file. Nothing may be added afterwards.
  std::string finish();

 private:
  using Index = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // time, offset in the chunk
  struct Chunk {
    std::uint64_t begin_ns = 0, end_ns = 0, offset = 0, length = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length = 0, size = 0;
  };

  void begin();
  void end_chunk();
  std::string statistics() const;
  static std::string chunk_index(const Chunk& chunk);

  std::string out_;
  std::vector<std::string> schemas_, channels_;  // their records
  std::string records_;                          // of the chunk that is written
  Chunk chunk_;
  std::map<std::uint16_t, Index> index_;
  std::vector<Chunk> chunks_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages by topic
  std::uint64_t first_ns_ = 0, last_ns_ = 0, messages_ = 0;
};

}  // namespace parallax::harness
