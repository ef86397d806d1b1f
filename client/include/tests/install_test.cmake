# Installs the client into STAGE, then moves it to PREFIX: the tests that follow use a package that was moved.
# cmake -DBUILD=... -DSTAGE=... -DPREFIX=... -DLIBDIR=... -DSONAME=... -P install_test.cmake
file(REMOVE_RECURSE ${STAGE} ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component client --prefix ${STAGE}
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${STAGE} ${PREFIX})

foreach(file bin/liloc-client include/liloc/client.h include/liloc/client.hpp ${LIBDIR}/libliloc-client.so
        ${LIBDIR}/${SONAME} ${LIBDIR}/cmake/liloc/liloc-config.cmake ${LIBDIR}/pkgconfig/liloc-client.pc)
  if(NOT EXISTS ${PREFIX}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()

file(GLOB_RECURSE all LIST_DIRECTORIES false ${PREFIX}/*)
foreach(file IN LISTS all)
  if(file MATCHES "\\.a$")
    message(FATAL_ERROR "${file}: an inner library was installed")
  endif()
  if(file MATCHES "\\.(cmake|pc|h|hpp|py|pyi)$")
    file(STRINGS ${file} told REGEX "${BUILD}|${STAGE}")
    if(told)
      message(FATAL_ERROR "${file} names a folder of this machine: ${told}")
    endif()
  endif()
endforeach()
