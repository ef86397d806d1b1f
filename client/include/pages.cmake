# Pages of the public headers: `cmake --build build/release --target pages` leaves build/release/pages/html/index.html.
# Without Doxygen (deploy/install --lint) there is no such target.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(DOXYGEN_PROJECT_NAME "LiLoc client")
  set(DOXYGEN_PROJECT_BRIEF "Where a device is, for robots, phones and headsets")
  set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/pages)
  set(DOXYGEN_STRIP_FROM_INC_PATH ${CMAKE_CURRENT_SOURCE_DIR})
  set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
  set(DOXYGEN_EXTRACT_ALL YES) # a field whose name says all has no comment
  set(DOXYGEN_EXAMPLE_PATH ${PROJECT_SOURCE_DIR}/client/examples)
  set(DOXYGEN_TYPEDEF_HIDES_STRUCT YES)
  set(DOXYGEN_HAVE_DOT NO)
  set(DOXYGEN_GENERATE_LATEX NO)
  set(DOXYGEN_QUIET YES)
  set(DOXYGEN_WARN_AS_ERROR YES)
  doxygen_add_docs(pages liloc ${PROJECT_SOURCE_DIR}/client/examples COMMENT "Pages of the public headers")
endif()
