#include "storage/sealed_content.hpp"

#include <SQLiteCpp/Database.h>
#include <fmt/format.h>

#include <bit>

#include "core/base/error.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

constexpr int kAuditsAlways = 2;  // the columns that an audit of every schema has

}  // namespace

SealedContent::SealedContent(std::uint64_t chunk_runs) : chunk_runs_(chunk_runs) {
  ensure(chunk_runs >= 1, "a chunk has at least one run");
}

void SealedContent::add_run(std::uint64_t run_index, std::uint64_t checksum) {
  if (in_chunk_ > 0 && run_index % chunk_runs_ == 0) end_chunk();
  chunk_.add(checksum);
  ++in_chunk_;
}

void SealedContent::end_chunk() {
  add_chunk({chunks_.size(), in_chunk_, chunk_.value()});
  chunk_.reset();
  in_chunk_ = 0;
}

void SealedContent::add_chunk(const ChunkRecord& chunk) {
  chunks_.push_back(chunk);
  all_.add(chunk.run_count);
  all_.add(chunk.digest);
}

void SealedContent::add_rest(SQLite::Database& db, std::int32_t schema) {
  if (in_chunk_ > 0) end_chunk();
  all_.add(chunks_.size());  // the lists have no marks between them, but counts
  std::uint64_t count = 0;
  const auto add = [&](const Query& row, int column) { all_.add(std::bit_cast<std::uint64_t>(row.number(column))); };
  Query audits(db, fmt::format("SELECT {} FROM main.audits ORDER BY run_index",
                               schema < kFirstJudged ? "run_index, checksum" : kAuditColumns));
  for (; audits.step(); ++count) {
    for (int column = 0; column < audits.column_count(); ++column) {
      if (column >= kAuditsAlways) all_.add(audits.is_null(column) ? 0 : 1);
      add(audits, column);
    }
  }
  all_.add(count);
  Query recordings(db, "SELECT run_index, checksum, calls FROM main.recordings ORDER BY run_index");
  while (recordings.step()) {
    add(recordings, 0);
    add(recordings, 1);
    const auto checksum = std::bit_cast<std::uint64_t>(recordings.number(1));
    if (recording_checksum(std::string(recordings.bytes(2))) != checksum)
      throw EngineError(fmt::format("the recording of run {} does not match its checksum", recordings.number(0)));
  }
}

}  // namespace fleetproof
