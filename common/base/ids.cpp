#include "common/base/ids.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr std::size_t kLongestId = 63;  // as idl/liloc.idl has it

bool allowed(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

}  // namespace

Result<std::string> valid_id(std::string_view id, std::string_view what) {
  if (id.empty()) return fail("{} is empty; give it 1 to 63 of A-Z a-z 0-9 _ -", what);
  if (id.size() > kLongestId)
    return fail("{} has {} characters; at most {} are allowed", what, id.size(), kLongestId);
  if (!std::all_of(id.begin(), id.end(), allowed)) {
    std::string shown(id);  // a hostile id must not reach a terminal or a log unmasked
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return fail("{} '{}' has a character outside A-Z a-z 0-9 _ -", what, shown);
  }
  return std::string(id);
}

}  // namespace liloc
