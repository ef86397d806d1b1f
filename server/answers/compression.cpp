#include "server/answers/compression.hpp"

#include <zstd.h>

#include <memory>
#include <new>

namespace liloc::answers {

std::string compressed(std::string_view bytes) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress2(context.get(), frame.data(), frame.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) throw std::bad_alloc();  // nothing else can fail here
  frame.resize(size);
  return frame;
}

Result<std::string> decompressed(std::string_view frame, std::size_t limit_bytes) {
  const auto size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    return fail("no zstd frame that tells its size");
  if (size > limit_bytes) return fail("a frame of {} bytes, at most {} are expected", size, limit_bytes);
  std::string bytes(size, '\0');
  const std::size_t got = ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size());
  if (ZSTD_isError(got) != 0) return fail("a damaged frame ({})", ZSTD_getErrorName(got));
  if (got != size) return fail("a frame of {} bytes that holds {}", size, got);
  return bytes;
}

}  // namespace liloc::answers
