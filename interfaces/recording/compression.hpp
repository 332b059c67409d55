#pragma once
#include <string>

#include "interfaces/recording/bytes.hpp"

namespace recording {

/// Refused above this size: a lying length must not take the machine's memory. chosen
inline constexpr std::uint64_t largest_chunk_bytes = std::uint64_t{256} << 20;

/// zstd at a level that keeps up with any robot's bus. Throws RecordingError when zstd refuses.
Bytes compress_zstd(ByteView bytes, int level = 1);

/// The records of a chunk: `compression` is "" or "zstd". Throws RecordingError at `place` when
/// the bytes are damaged, of another compression, or not `size` long.
Bytes decompress(ByteView bytes, const std::string& compression, std::uint64_t size,
                 const ByteReader& place);

/// As much of a chunk as its first bytes give; for a chunk whose end never reached the disk.
Bytes decompress_start(ByteView bytes, const std::string& compression, std::uint64_t size);

}  // namespace recording
