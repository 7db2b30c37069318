#include "harness/recording/mcap_writer.h"

#include <algorithm>

#include "harness/recording/bytes.h"
#include "harness/recording/export_recording.h"

namespace parallax::harness {
namespace {

// Records of the format, by their first byte.
constexpr char kHeader = 0x01, kFooter = 0x02, kSchema = 0x03, kChannel = 0x04, kMessage = 0x05,
               kChunk = 0x06, kMessageIndex = 0x07, kChunkIndex = 0x08, kStatistics = 0x0b,
               kSummaryOffset = 0x0e, kDataEnd = 0x0f;
constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

void put_text(std::string& out, std::string_view text) {
  put_u32(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

void put_record(std::string& out, char opcode, std::string_view content) {
  out.push_back(opcode);
  put_u64(out, content.size());
  out += content;
}

std::string record(char opcode, std::string_view content) {
  std::string out;
  put_record(out, opcode, content);
  return out;
}

/// A map of numbers, behind its size in bytes.
void put_map(std::string& out, const std::map<std::uint16_t, std::uint64_t>& map) {
  put_u32(out, static_cast<std::uint32_t>(10 * map.size()));
  for (const auto& [key, value] : map) {
    put_u16(out, key);
    put_u64(out, value);
  }
}

}  // namespace

bool is_motion_mcap(std::string_view head) {
  // Behind the magic, the size of the header and that of the profile: what wrote it.
  return head.starts_with(kMcapMagic) && head.substr(0, 64).find("parallax") != head.npos;
}

std::uint16_t McapWriter::add_topic(const std::string& topic, const std::string& schema_name,
                                    const std::string& schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  std::string content;
  put_u16(content, id);
  put_text(content, schema_name);
  put_text(content, "jsonschema");
  put_text(content, schema);
  schemas_.push_back(record(kSchema, content));
  content.clear();
  put_u16(content, id);
  put_u16(content, id);
  put_text(content, topic);
  put_text(content, "json");
  put_u32(content, 0);  // no metadata
  channels_.push_back(record(kChannel, content));
  return id;
}

void McapWriter::begin() {
  out_ += kMcapMagic;
  std::string content;
  put_text(content, "");
  put_text(content, "parallax");
  put_record(out_, kHeader, content);
}

void McapWriter::add(std::uint16_t topic, std::uint64_t time_ns, std::string_view message) {
  if (out_.empty()) begin();
  if (records_.empty()) {
    chunk_ = {};
    chunk_.begin_ns = time_ns;
    // Every chunk can be read alone.
    for (const auto& schema : schemas_) records_ += schema;
    for (const auto& channel : channels_) records_ += channel;
  }
  index_[topic].emplace_back(time_ns, records_.size());
  std::string content;
  put_u16(content, topic);
  put_u32(content, static_cast<std::uint32_t>(counts_[topic]++));
  put_u64(content, time_ns);
  put_u64(content, time_ns);
  content += message;
  put_record(records_, kMessage, content);
  chunk_.end_ns = time_ns;
  if (messages_++ == 0) first_ns_ = time_ns;
  last_ns_ = std::max(last_ns_, time_ns);
  if (records_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (records_.empty()) return;
  chunk_.offset = out_.size();
  chunk_.size = records_.size();
  std::string content;
  put_u64(content, chunk_.begin_ns);
  put_u64(content, chunk_.end_ns);
  put_u64(content, records_.size());
  put_u32(content, crc32(records_));
  put_text(content, "");  // no compression
  put_u64(content, records_.size());
  content += records_;
  put_record(out_, kChunk, content);
  chunk_.length = out_.size() - chunk_.offset;
  const auto index_begin = out_.size();
  for (const auto& [topic, entries] : index_) {
    chunk_.index_offsets[topic] = out_.size();
    content.clear();
    put_u16(content, topic);
    put_u32(content, static_cast<std::uint32_t>(16 * entries.size()));
    for (const auto& [time_ns, offset] : entries) {
      put_u64(content, time_ns);
      put_u64(content, offset);
    }
    put_record(out_, kMessageIndex, content);
  }
  chunk_.index_length = out_.size() - index_begin;
  chunks_.push_back(std::move(chunk_));
  chunk_ = {};
  records_.clear();
  index_.clear();
}

std::string McapWriter::statistics() const {
  std::string content;
  put_u64(content, messages_);
  put_u16(content, static_cast<std::uint16_t>(schemas_.size()));
  put_u32(content, static_cast<std::uint32_t>(channels_.size()));
  put_u32(content, 0);  // attachments
  put_u32(content, 0);  // metadata
  put_u32(content, static_cast<std::uint32_t>(chunks_.size()));
  put_u64(content, first_ns_);
  put_u64(content, last_ns_);
  put_map(content, counts_);
  return record(kStatistics, content);
}

std::string McapWriter::chunk_index(const Chunk& chunk) {
  std::string content;
  put_u64(content, chunk.begin_ns);
  put_u64(content, chunk.end_ns);
  put_u64(content, chunk.offset);
  put_u64(content, chunk.length);
  put_map(content, chunk.index_offsets);
  put_u64(content, chunk.index_length);
  put_text(content, "");
  put_u64(content, chunk.size);
  put_u64(content, chunk.size);
  return record(kChunkIndex, content);
}

std::string McapWriter::finish() {
  if (out_.empty()) begin();
  end_chunk();
  std::string content;
  put_u32(content, crc32(out_));
  put_record(out_, kDataEnd, content);

  const auto summary_begin = out_.size();
  std::string offsets;
  const auto group = [&](char opcode, const std::vector<std::string>& records) {
    if (records.empty()) return;
    const auto begin_at = out_.size();
    for (const auto& one : records) out_ += one;
    std::string entry(1, opcode);
    put_u64(entry, begin_at);
    put_u64(entry, out_.size() - begin_at);
    put_record(offsets, kSummaryOffset, entry);
  };
  std::vector<std::string> indexes;
  for (const auto& chunk : chunks_) indexes.push_back(chunk_index(chunk));
  group(kSchema, schemas_);
  group(kChannel, channels_);
  group(kStatistics, {statistics()});
  group(kChunkIndex, indexes);
  const auto offsets_begin = out_.size();
  out_ += offsets;

  // The checksum covers the footer up to itself.
  out_.push_back(kFooter);
  put_u64(out_, 20);
  put_u64(out_, summary_begin);
  put_u64(out_, offsets_begin);
  put_u32(out_, crc32(std::string_view(out_).substr(summary_begin)));
  out_ += kMcapMagic;
  return std::move(out_);
}

}  // namespace parallax::harness
