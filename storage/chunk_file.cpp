#include "storage/chunk_file.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "core/base/byte_text.hpp"
#include "core/base/error.hpp"
#include "core/base/regular_file.hpp"
#include "storage/run_bytes.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kMagic = "FPCHUNK2";  // the last character is the version
constexpr std::uint64_t kFixedHead = kMagic.size() + 8 + 4, kDigest = 8;
constexpr std::uint64_t kLongestLabel = 1U << 20, kAuditBytes = 8 * (4 + kAuditNumbers.size());

std::string encode(const ChunkLabel& label) {
  ByteSink sink;
  sink.u64(label.plan);
  sink.text(label.campaign);
  sink.text(label.program);
  sink.u64(label.chunk);
  sink.u64(label.first_run);
  sink.u64(label.run_count);
  return sink.take();
}

ChunkLabel decode_label(std::string_view bytes) {
  ByteSource source(bytes, "the label of a chunk");
  ChunkLabel label;
  label.plan = source.u64();
  label.campaign = source.text();
  label.program = source.text();
  label.chunk = source.u64();
  label.first_run = source.u64();
  label.run_count = source.u64();
  source.end();
  return label;
}

std::string encode(const AuditRecord& audit) {
  ensure(audit.outcome.has_value(), "an audit of this program says what the run came to");
  ByteSink sink;
  for (const std::uint64_t value : {audit.run_index, audit.checksum, std::uint64_t{audit.outcome->judged.failed},
                                    std::uint64_t{audit.outcome->judged.unknown}})
    sink.u64(value);
  for (const auto member : kAuditNumbers) sink.u64(*audit.outcome.*member);
  return sink.take();
}

AuditRecord decode_audit(std::string_view bytes) {
  ByteSource source(bytes, "an audit of a chunk");
  AuditRecord audit;
  audit.run_index = source.u64();
  audit.checksum = source.u64();
  AuditedOutcome& outcome = audit.outcome.emplace();
  outcome.judged.failed = static_cast<std::uint32_t>(source.u64());
  outcome.judged.unknown = static_cast<std::uint32_t>(source.u64());
  for (const auto member : kAuditNumbers) outcome.*member = source.u64();
  return audit;
}

std::string number(std::uint64_t value) {
  ByteSink sink;
  sink.u64(value);
  return sink.take();
}

std::uint64_t digest_of(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

class RunningDigest {
 public:
  RunningDigest() : state_(XXH3_createState()) {
    ensure(state_ != nullptr, "there is memory for a digest");
    XXH3_64bits_reset(state_);
  }
  ~RunningDigest() { XXH3_freeState(state_); }
  RunningDigest(const RunningDigest&) = delete;
  RunningDigest& operator=(const RunningDigest&) = delete;
  void add(std::string_view bytes) { XXH3_64bits_update(state_, bytes.data(), bytes.size()); }
  std::uint64_t value() const { return XXH3_64bits_digest(state_); }

 private:
  XXH3_state_t* state_;
};

std::string head_of(const ChunkLabel& label, std::uint64_t body_bytes) {
  const std::string text = encode(label);
  const std::uint64_t size = kFixedHead + text.size() + kDigest + body_bytes + kDigest;
  ByteSink length;
  length.text(text);
  std::string head = std::string(kMagic) + number(size) + length.take();
  return head + number(digest_of(head));
}

[[noreturn]] void not_written(const std::string& path) {
  throw MachineError(fmt::format("{}: cannot be written ({}); free some space, then the same command goes on", path,
                                 std::strerror(errno)));
}

constexpr const char* kRemedy = "remove it; `fleetproof missing` then says what to run again";

}  // namespace

void write_chunk_file(const std::string& path, const ChunkLabel& label, const ChunkContent& content) {
  auto audits = content.audits;
  std::ranges::sort(audits, {}, &AuditRecord::run_index);
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << head_of(label, 4 * label.run_count + content.run_bytes + 8 + kAuditBytes * audits.size());
  RunningDigest digest;
  const auto put = [&](const std::string& bytes) {
    digest.add(bytes);
    if (!file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) not_written(path);
  };
  for (std::uint64_t place = 0; place < label.run_count; ++place) {
    ByteSink sink;
    sink.text(content.encoded(place));
    put(sink.take());
  }
  put(number(audits.size()));
  for (const AuditRecord& audit : audits) put(encode(audit));
  file << number(digest.value());
  file.close();
  if (!file) not_written(path);
}

// Before it is opened: a pipe would be waited for.
bool is_chunk_there(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return false;
  if (!std::filesystem::is_regular_file(status))
    throw InputError(path, "this is no regular file and stands where a chunk belongs; move it away");
  return true;
}

ChunkFile::ChunkFile(const std::string& path) : path_(path) {
  if (!is_chunk_there(path)) RegularFile says_why(path);
  file_.open(path, std::ios::binary);
  std::error_code error;
  if (!file_) throw InputError(path, fmt::format("cannot be read ({}); change its permissions", std::strerror(errno)));
  const std::uint64_t here = std::filesystem::file_size(path, error);
  const auto require_bytes = [&](std::uint64_t wanted) {
    if (here < wanted)
      throw EngineError(
          fmt::format("{}: this chunk is incomplete: it has {} of {} bytes at least; {}", path, here, wanted, kRemedy));
  };
  require_bytes(kFixedHead);
  const std::string fixed = take(kFixedHead);
  if (!fixed.starts_with(kMagic))
    throw InputError(path, "this is no chunk of a campaign that this version knows; move it away");
  ByteSource source(std::string_view(fixed).substr(kMagic.size()), "the head of a chunk");
  size_ = source.u64();
  const std::uint64_t label_bytes = source.u32();
  if (label_bytes > kLongestLabel) damaged("its head was changed");
  body_at_ = kFixedHead + label_bytes + kDigest;
  require_bytes(body_at_);
  const std::string label = take(label_bytes);
  if (take(kDigest) != number(digest_of(fixed + label))) damaged("its head was changed");
  require_bytes(size_);
  if (here > size_) damaged(fmt::format("{} bytes follow its end", here - size_));
  label_ = decode_label(label);
}

std::string ChunkFile::take(std::uint64_t count) {
  if (body_at_ > 0 && count > size_) damaged("a run is longer than the file");
  std::string bytes(count, '\0');
  if (!file_.read(bytes.data(), static_cast<std::streamsize>(count)))
    throw MachineError(fmt::format("{}: cannot be read to its end; look at the disk", path_));
  return bytes;
}

void ChunkFile::damaged(const std::string& what) const {
  throw EngineError(fmt::format("{}: this chunk is damaged: {}; {}", path_, what, kRemedy));
}

void ChunkFile::require_intact() {
  constexpr std::uint64_t kBlock = 1U << 16;
  file_.seekg(static_cast<std::streamoff>(body_at_));
  RunningDigest digest;
  for (std::uint64_t left = size_ - kDigest - body_at_; left > 0;) {
    const std::string block = take(std::min(left, kBlock));
    digest.add(block);
    left -= block.size();
  }
  if (take(kDigest) != number(digest.value())) damaged("its bytes are not those that were written");
}

void ChunkFile::for_each_run(const std::function<void(const RunRecord&)>& visit) {
  file_.seekg(static_cast<std::streamoff>(body_at_));
  for (std::uint64_t place = 0; place < label_.run_count; ++place) {
    const std::string length = take(4);
    const RunRecord run = decode_run(take(ByteSource(length, "a chunk").u32()));
    if (run.run_index != label_.first_run + place) damaged(fmt::format("run {} is not at its place", run.run_index));
    visit(run);
  }
}

std::vector<AuditRecord> ChunkFile::audits() {
  const std::string count = take(8);
  const std::uint64_t length = ByteSource(count, "a chunk").u64();
  if (length > size_ / kAuditBytes) damaged("it has room for fewer audits than it says");
  std::vector<AuditRecord> audits(length);
  for (AuditRecord& audit : audits) audit = decode_audit(take(kAuditBytes));
  return audits;
}

}  // namespace fleetproof
