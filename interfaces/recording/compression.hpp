#pragma once
#include <string>

#include "interfaces/recording/bytes.hpp"

namespace recording {

/// Largest accepted size, so that a wrong length cannot exhaust the memory. Chosen.
inline constexpr std::uint64_t max_chunk_bytes = std::uint64_t{256} << 20;

/// Compresses with zstd; the default level is fast enough for a robot's bus. Throws RecordingError
/// when zstd fails.
Bytes compress_zstd(ByteView bytes, int level = 1);

/// The records of a chunk: `compression` is "" or "zstd". Throws RecordingError at `place` when
/// the bytes are damaged, of another compression, or not `size` long.
Bytes decompress(ByteView bytes, const std::string& compression, std::uint64_t size,
                 const ByteReader& place);

/// Decompresses as much of a chunk as possible; for a chunk that is truncated in the file.
Bytes decompress_start(ByteView bytes, const std::string& compression, std::uint64_t size);

}  // namespace recording
