#include "common/recording/bags/chunk.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <memory>

namespace liloc::bags {
namespace {

Status unpack_zstd(std::string_view packed, std::string& records) {
  const std::size_t got = ZSTD_decompress(records.data(), records.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0) return fail("has a damaged zstd chunk ({})", ZSTD_getErrorName(got));
  if (got != records.size()) return fail("has a zstd chunk of another size than it says");
  return {};
}

Status unpack_lz4(std::string_view packed, std::string& records) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return fail("ran out of memory");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t read = 0, written = 0, hint = 1;
  while (hint != 0) {
    std::size_t in = packed.size() - read, out = records.size() - written;
    hint = LZ4F_decompress(context.get(), records.data() + written, &out, packed.data() + read, &in, nullptr);
    if (LZ4F_isError(hint) != 0) return fail("has a damaged lz4 chunk ({})", LZ4F_getErrorName(hint));
    read += in;
    written += out;
    if (in == 0 && out == 0) break;  // it wants more than there is
  }
  if (hint != 0 || written != records.size()) return fail("has an lz4 chunk of another size than it says");
  return {};
}

}  // namespace

Result<std::string> unpacked(std::string_view compression, std::string_view packed, std::uint64_t size) {
  if (size > kLargestChunk) return fail("has a chunk of {} bytes; at most {} are read", size, kLargestChunk);
  if (compression.empty()) {
    if (packed.size() != size) return fail("has a chunk of another size than it says");
    return std::string(packed);
  }
  if (compression != "zstd" && compression != "lz4")
    return fail("has chunks compressed as '{}'; zstd and lz4 are read", compression.substr(0, 40));
  std::string records(size, '\0');
  const Status done = compression == "zstd" ? unpack_zstd(packed, records) : unpack_lz4(packed, records);
  if (!done) return tl::unexpected(done.error());
  return records;
}

}  // namespace liloc::bags
