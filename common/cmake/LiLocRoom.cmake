# A room is one CMake target: its sources, headers and tests lie in one folder.
#
#   liloc_room(NAME geometry SOURCES a.cpp NEEDS liloc::base Eigen3::Eigen [PRIVATE_NEEDS ...])
#   liloc_test(NAME geometry SOURCES tests/a_test.cpp NEEDS liloc::testing [TIMEOUT s] [LABELS ...])

add_library(liloc_warnings INTERFACE)
target_compile_options(liloc_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # gcc 12 warns of its own string concatenation (PR 105651)
  $<$<BOOL:${LILOC_WERROR}>:-Werror>
  # gcc 12 also finds moved-from optionals and Eigen's packets uninitialized: worth a look, not a stop.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-error=uninitialized>)

if(LILOC_SANITIZE)
  add_compile_options(-fsanitize=${LILOC_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${LILOC_SANITIZE})
  # Eigen aligns by hand under ASan and Debian's PCL does not: memory of the one freed by the other would look broken.
  add_compile_definitions(LILOC_SANITIZED EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

function(liloc_rooms)
  foreach(room IN LISTS ARGN)
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${room}/CMakeLists.txt)
      add_subdirectory(${room})
    endif()
  endforeach()
endfunction()

function(liloc_room)
  cmake_parse_arguments(ROOM "" "NAME" "SOURCES;NEEDS;PRIVATE_NEEDS" ${ARGN})
  if(ROOM_SOURCES)
    add_library(liloc_${ROOM_NAME} STATIC ${ROOM_SOURCES})
    target_include_directories(liloc_${ROOM_NAME} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(liloc_${ROOM_NAME} PUBLIC ${ROOM_NEEDS} PRIVATE liloc_warnings ${ROOM_PRIVATE_NEEDS})
  else()
    add_library(liloc_${ROOM_NAME} INTERFACE)
    target_include_directories(liloc_${ROOM_NAME} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(liloc_${ROOM_NAME} INTERFACE ${ROOM_NEEDS})
  endif()
  add_library(liloc::${ROOM_NAME} ALIAS liloc_${ROOM_NAME})
endfunction()

function(liloc_program)
  cmake_parse_arguments(PROGRAM "" "NAME" "SOURCES;NEEDS" ${ARGN})
  add_executable(${PROGRAM_NAME} ${PROGRAM_SOURCES})
  target_link_libraries(${PROGRAM_NAME} PRIVATE liloc_warnings ${PROGRAM_NEEDS})
  set_target_properties(${PROGRAM_NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()

function(liloc_test)
  cmake_parse_arguments(TEST "" "NAME;TIMEOUT" "SOURCES;NEEDS;LABELS" ${ARGN})
  if(NOT BUILD_TESTING)
    return()
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 300)
  endif()
  add_executable(${TEST_NAME}_test ${TEST_SOURCES})
  target_link_libraries(${TEST_NAME}_test PRIVATE liloc_warnings ${TEST_NEEDS} GTest::gmock GTest::gtest_main)
  add_test(NAME ${TEST_NAME} COMMAND ${TEST_NAME}_test WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(${TEST_NAME} PROPERTIES TIMEOUT ${TEST_TIMEOUT} LABELS "${TEST_LABELS}")
endfunction()
