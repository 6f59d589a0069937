# Compile options of our own targets, never of their users.
function(semloop_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
  if(SEMLOOP_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(SEMLOOP_SANITIZE)
    # The suppressions of ubsan-suppressions.txt work on checks that can go on only.
    target_compile_options(${target} PRIVATE -fsanitize=${SEMLOOP_SANITIZE} -fno-omit-frame-pointer
      -fno-sanitize-recover=all -fsanitize-recover=alignment)
    # Eigen aligns by hand under AddressSanitizer, but what it frees may come from Debian's libraries,
    # which do not.
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
    target_link_options(${target} PRIVATE -fsanitize=${SEMLOOP_SANITIZE})
  endif()
endfunction()

# semloop_add_library(NAME [PUBLIC targets...] [PRIVATE targets...] [PRIVATE_INCLUDES dirs...])
# makes libsemloop-NAME.so and the target semloop::NAME of libs/NAME/{src,include}.
function(semloop_add_library name)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE;PRIVATE_INCLUDES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  set(target lib-${name})
  add_library(${target} SHARED ${sources})
  add_library(semloop::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME semloop-${name} EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} SYSTEM PRIVATE ${arg_PRIVATE_INCLUDES})
  # A module registers itself when its library is loaded: the linker must not drop it.
  target_link_options(${target} INTERFACE LINKER:--no-as-needed)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  semloop_compile_options(${target})
  install(TARGETS ${target} EXPORT semloop-targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# semloop_add_program(NAME targets...) makes bin/NAME of every .cpp in the current folder.
function(semloop_add_program name)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE semloop-app-common ${ARGN})
  target_compile_definitions(${name} PRIVATE SEMLOOP_VERSION="${PROJECT_VERSION}")
  semloop_compile_options(${name})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  set_property(GLOBAL APPEND PROPERTY SEMLOOP_PROGRAMS ${name})
endfunction()

# semloop_add_tests(FOLDER targets... [FIXTURE name] [ENVIRONMENT NAME=value...]) makes bin/test-FOLDER
# of the *_unittest.cpp in tests/FOLDER; with a fixture they wait for the test that sets it up.
function(semloop_add_tests name)
  cmake_parse_arguments(arg "" "FIXTURE" "ENVIRONMENT" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(test-${name} ${sources})
  target_link_libraries(test-${name} PRIVATE GTest::gtest GTest::gmock GTest::gtest_main
    ${arg_UNPARSED_ARGUMENTS})
  target_include_directories(test-${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/common)
  target_compile_definitions(test-${name} PRIVATE
    SEMLOOP_SOURCE_DIR="${PROJECT_SOURCE_DIR}" SEMLOOP_BINARY_DIR="${PROJECT_BINARY_DIR}")
  semloop_compile_options(test-${name})
  set(properties TIMEOUT 600)
  if(arg_FIXTURE)
    set(properties TIMEOUT 1800 FIXTURES_REQUIRED ${arg_FIXTURE})
  endif()
  if(arg_ENVIRONMENT)
    list(APPEND properties ENVIRONMENT "${arg_ENVIRONMENT}")
  endif()
  gtest_discover_tests(test-${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 300
    PROPERTIES ${properties})
endfunction()
