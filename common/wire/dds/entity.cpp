#include "common/wire/dds/entity.hpp"

#include <dds/dds.h>

namespace liloc::wire {
namespace {

std::string_view remedy(dds_return_t code) {
  switch (code) {
    case DDS_RETCODE_PRECONDITION_NOT_MET:
      return "; is the domain configured twice, or the port taken by another server?";
    case DDS_RETCODE_OUT_OF_RESOURCES:
      return "; raise the process's memory and file limits";
    case DDS_RETCODE_TIMEOUT:
      return "; the other side does not keep up";
    case DDS_RETCODE_BAD_PARAMETER:
      return "; a value is out of the bounds of idl/";
    case DDS_RETCODE_NOT_ALLOWED_BY_SECURITY:
      return "; the credentials do not allow it: are they this id's, and the topic its own or one of --reads "
             "and --writes?";
    case DDS_RETCODE_ERROR:
      return "; check that the interface exists (ip addr) and no other server runs in the domain";
    default:
      return "";
  }
}

}  // namespace

Entity::~Entity() {
  if (handle_ > 0) dds_delete(handle_);  // of an entity whose parent went first: an error code, no harm
}

Result<Entity> checked(std::int32_t handle, std::string_view what) {
  if (handle < 0) return fail("DDS {}: {}{}", what, dds_strretcode(-handle), remedy(handle));
  return Entity(handle);
}

Status check(std::int32_t return_code, std::string_view what) {
  if (return_code < 0) return fail("DDS {}: {}{}", what, dds_strretcode(-return_code), remedy(return_code));
  return {};
}

}  // namespace liloc::wire
