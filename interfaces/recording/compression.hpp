#pragma once
#include <string>

#include "interfaces/recording/bytes.hpp"

namespace recording {

/// Largest accepted size of a decompressed chunk: a wrong length must not exhaust the memory.
/// Chosen.
inline constexpr std::uint64_t max_chunk_bytes = std::uint64_t{256} << 20;

/// Compresses with zstd; the default level is fast enough for a robot's bus. Throws RecordingError
/// when zstd fails.
Bytes compress_zstd(ByteView bytes, int level = 1);

/// Decompresses the records of a chunk to `size` bytes. `compression`: "" or "zstd". Throws
/// RecordingError with the position of `place` when the bytes are damaged, the compression is
/// unknown, or the size differs.
Bytes decompress(ByteView bytes, const std::string& compression, std::uint64_t size,
                 const ByteReader& place);

/// Decompresses the start of a truncated chunk, as far as its bytes allow.
Bytes decompress_start(ByteView bytes, const std::string& compression, std::uint64_t size);

}  // namespace recording
