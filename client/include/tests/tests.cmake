# Tests of the C API, and of the package as a robot's project meets it: installed, moved, built against, run.
# Each program that joins a DDS domain has its own, 171..181.
add_executable(client_answering_server ${PROJECT_SOURCE_DIR}/client/api/tests/answering_server.cpp)
target_link_libraries(client_answering_server PRIVATE liloc_warnings liloc::wire)
liloc_test(NAME client_c_api SOURCES tests/c_api_test.cpp tests/c_api_running_test.cpp
  NEEDS liloc::client TIMEOUT 60)
target_compile_definitions(client_c_api_test PRIVATE ANSWERING_SERVER="$<TARGET_FILE:client_answering_server>")
add_dependencies(client_c_api_test client_answering_server)

set(installed ${CMAKE_CURRENT_BINARY_DIR}/installed)
set(consumer ${CMAKE_CURRENT_SOURCE_DIR}/tests/consumer)
set(soname libliloc-client.so.${soversion})
set(sanitize "")
if(LILOC_SANITIZE)
  set(sanitize -fsanitize=${LILOC_SANITIZE})
endif()

add_test(NAME client_install COMMAND ${CMAKE_COMMAND}
  -DBUILD=${PROJECT_BINARY_DIR} -DSTAGE=${CMAKE_CURRENT_BINARY_DIR}/stage -DPREFIX=${installed}
  -DLIBDIR=${CMAKE_INSTALL_LIBDIR} -DSONAME=${soname}
  -P ${CMAKE_CURRENT_SOURCE_DIR}/tests/install_test.cmake)
add_test(NAME client_install_symbols COMMAND python3 ${CMAKE_CURRENT_SOURCE_DIR}/tests/check_library.py
  ${installed}/${CMAKE_INSTALL_LIBDIR}/${soname} ${installed}/include/liloc/client.h ${soname})
add_test(NAME client_install_cmake COMMAND ${CMAKE_CTEST_COMMAND}
  --build-and-test ${consumer} ${CMAKE_CURRENT_BINARY_DIR}/consumer_cmake --build-generator ${CMAKE_GENERATOR}
  --build-options -DCMAKE_PREFIX_PATH=${installed} -DC_DOMAIN=171 -DCPP_DOMAIN=172
    -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
    -DCMAKE_C_FLAGS=${sanitize} -DCMAKE_CXX_FLAGS=${sanitize}
    -DCMAKE_DISABLE_FIND_PACKAGE_PCL=ON -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_CycloneDDS=ON
  --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure --no-tests=error)
add_test(NAME client_install_pkg_config COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/pkg_config_test.sh
  ${installed}/${CMAKE_INSTALL_LIBDIR} ${CMAKE_CURRENT_BINARY_DIR}/consumer_pkg_config 173 174 ${sanitize})
set_tests_properties(client_install_pkg_config PROPERTIES
  ENVIRONMENT "CC=${CMAKE_C_COMPILER};CXX=${CMAKE_CXX_COMPILER}")

# What a robot's developer copies: built against the package, run against a server that answers.
set(examples ${PROJECT_SOURCE_DIR}/client/examples)
set(examples_built ${CMAKE_CURRENT_BINARY_DIR}/examples)
add_test(NAME client_examples_build COMMAND ${CMAKE_CTEST_COMMAND}
  --build-and-test ${examples} ${examples_built} --build-generator ${CMAKE_GENERATOR}
  --build-options -DCMAKE_PREFIX_PATH=${installed}
    -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
    -DCMAKE_C_FLAGS=${sanitize} -DCMAKE_CXX_FLAGS=${sanitize})
find_program(LILOC_NUMPY_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED) # Debian's, which has NumPy
add_test(NAME client_example_cpp COMMAND ${LILOC_NUMPY_PYTHON} ${examples}/tests/locate_test.py 179 ${examples_built}/locate_cpp)
add_test(NAME client_example_c COMMAND ${LILOC_NUMPY_PYTHON} ${examples}/tests/locate_test.py 180 ${examples_built}/locate_c)
set_tests_properties(client_examples_build PROPERTIES FIXTURES_SETUP client_examples)
set_tests_properties(client_example_cpp client_example_c PROPERTIES FIXTURES_REQUIRED client_examples TIMEOUT 60
  ENVIRONMENT "ANSWERING_SERVER=$<TARGET_FILE:client_answering_server>")
set_tests_properties(client_examples_build PROPERTIES FIXTURES_REQUIRED client_installed TIMEOUT 60)

set_tests_properties(client_install PROPERTIES FIXTURES_SETUP client_installed)
set_tests_properties(client_install_symbols client_install_cmake client_install_pkg_config PROPERTIES
  FIXTURES_REQUIRED client_installed)
set_tests_properties(client_install client_install_symbols client_install_cmake client_install_pkg_config PROPERTIES
  TIMEOUT 60)
