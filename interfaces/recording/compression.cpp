#include "interfaces/recording/compression.hpp"

#include <zstd.h>

#include <algorithm>
#include <memory>

namespace recording {

Bytes compress_zstd(ByteView bytes, int level) {
  Bytes out(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size))
    throw RecordingError(std::string("zstd: ") + ZSTD_getErrorName(size) +
                         "; record with compression none");
  out.resize(size);
  return out;
}

Bytes decompress(ByteView bytes, const std::string& compression, std::uint64_t size,
                 const ByteReader& place) {
  if (compression.empty()) {
    if (bytes.size() != size)
      place.fail("an uncompressed chunk declares " + std::to_string(size) + " bytes and has " +
                 std::to_string(bytes.size()));
    return {bytes.begin(), bytes.end()};
  }
  if (compression != "zstd")
    place.fail("a chunk is compressed with \"" + compression.substr(0, 16) +
               "\", supported are none and zstd");
  const auto declared = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size > max_chunk_bytes)
    place.fail("a chunk declares " + std::to_string(size) + " bytes, at most " +
               std::to_string(max_chunk_bytes) + " are accepted");
  if (declared != size && declared != ZSTD_CONTENTSIZE_UNKNOWN)
    place.fail("a chunk's size and that of its zstd frame differ");
  Bytes out(static_cast<std::size_t>(size));
  const std::size_t decompressed_bytes =
      ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(decompressed_bytes))
    place.fail(std::string("zstd: ") + ZSTD_getErrorName(decompressed_bytes));
  if (decompressed_bytes != size) place.fail("a chunk contains fewer bytes than it declares");
  return out;
}

Bytes decompress_start(ByteView bytes, const std::string& compression, std::uint64_t size) {
  if (compression.empty()) return {bytes.begin(), bytes.end()};
  if (compression != "zstd") return {};
  Bytes out(static_cast<std::size_t>(std::min(size, max_chunk_bytes)));
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          ZSTD_freeDStream);
  ZSTD_inBuffer input{bytes.data(), bytes.size(), 0};
  ZSTD_outBuffer output{out.data(), out.size(), 0};
  while (input.pos < input.size && output.pos < output.size) {
    const std::size_t progress = input.pos + output.pos;
    if (ZSTD_isError(ZSTD_decompressStream(stream.get(), &output, &input)) ||
        input.pos + output.pos == progress)
      break;
  }
  out.resize(output.pos);
  return out;
}

}  // namespace recording
