#include "server/view/assets.hpp"

#include <algorithm>
#include <array>

// The assembler takes the files in; CMake compresses them to LILOC_PAGE_FOLDER.
#define LILOC_ASSET(symbol, file)                                                                              \
  __asm__(".section .rodata\n.balign 16\n.hidden liloc_" #symbol "\n.global liloc_" #symbol "\nliloc_" #symbol \
          ":\n.incbin \"" LILOC_PAGE_FOLDER "/" file ".gz\"\n.hidden liloc_" #symbol                           \
          "_end\n.global liloc_" #symbol "_end\nliloc_" #symbol "_end:\n.byte 0\n.text\n");                    \
  extern "C" const char liloc_##symbol[], liloc_##symbol##_end[];

LILOC_ASSET(index_html, "index.html")
LILOC_ASSET(page_js, "page.js")
LILOC_ASSET(page_css, "page.css")

namespace liloc::view {

const Asset* asset_of(std::string_view path) {
  static const std::array<Asset, 3> assets{
      {{"/", "text/html; charset=utf-8", {liloc_index_html, liloc_index_html_end}},
       {"/page.js", "text/javascript; charset=utf-8", {liloc_page_js, liloc_page_js_end}},
       {"/page.css", "text/css; charset=utf-8", {liloc_page_css, liloc_page_css_end}}}};
  const auto* const found = std::ranges::find(assets, path, &Asset::path);
  return found == assets.end() ? nullptr : found;
}

}  // namespace liloc::view
