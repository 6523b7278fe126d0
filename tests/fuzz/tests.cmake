find_package(JPEG REQUIRED)
find_package(OpenEXR 3.1 REQUIRED)
find_package(ZLIB REQUIRED)
# What is fuzzed, and what replays the corpus in every test run.
add_library(whit_readers STATIC fuzz/readers.cpp)
target_link_libraries(whit_readers PUBLIC whit_io)
target_include_directories(whit_readers PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(whit_readers PRIVATE
                           WHIT_FUZZ_CORPUS="${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus")
if(WHIT_WEBP)
  target_compile_definitions(whit_readers PRIVATE WHIT_WEBP)
endif()
whit_tests(fuzz whit_readers)
whit_runs_programs(fuzz whit)
# `cmake --build BUILD --target make_corpus`, then BUILD/tests/make_corpus tests/fuzz/corpus
add_executable(make_corpus EXCLUDE_FROM_ALL fuzz/make_corpus.cpp)
target_link_libraries(make_corpus PRIVATE whit_io OpenEXR::OpenEXR JPEG::JPEG ZLIB::ZLIB
                                          GTest::gtest)
target_include_directories(make_corpus PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}
                                               ${CMAKE_CURRENT_SOURCE_DIR}/io)
set_target_properties(make_corpus PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)

# With WHIT_FUZZ: a libFuzzer program for each reader, all built by the target `fuzzers`. What they run
# is instrumented; other programs of the build, which link the same objects, do without libFuzzer.
if(WHIT_FUZZ)
  foreach(folder core scene bake make io readers)
    target_compile_options(whit_${folder} PRIVATE -fsanitize=fuzzer-no-link)
  endforeach()
  add_custom_target(fuzzers)
  set(readers scene obj mtl gltf ply png jpeg tga bmp hdr exr)
  if(WHIT_WEBP)
    list(APPEND readers webp)
  endif()
  foreach(reader ${readers})
    add_executable(fuzz_${reader} EXCLUDE_FROM_ALL fuzz/fuzz_target.cpp)
    target_link_libraries(fuzz_${reader} PRIVATE whit_readers)
    target_link_options(fuzz_${reader} PRIVATE -fsanitize=fuzzer)
    target_compile_definitions(fuzz_${reader} PRIVATE WHIT_FUZZ_READER="${reader}")
    set_target_properties(fuzz_${reader} PROPERTIES
                          RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
    add_dependencies(fuzzers fuzz_${reader})
  endforeach()
endif()
