find_package(benchmark REQUIRED)
find_package(embree ${WHIT_EMBREE_MAJOR} CONFIG REQUIRED)
add_executable(kernels_bench bench/kernels_bench.cpp)
target_link_libraries(kernels_bench PRIVATE whit_inspect whit_io benchmark::benchmark)
target_include_directories(kernels_bench PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
# The library, and inside it Embree's own calls.
add_executable(rays_bench EXCLUDE_FROM_ALL bench/rays_bench.cpp)
target_link_libraries(rays_bench PRIVATE whit_io whit_library whit_accel embree)
target_compile_definitions(rays_bench PRIVATE WHIT_EMBREE_MAJOR=${WHIT_EMBREE_MAJOR})
set_target_properties(kernels_bench rays_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
# What is timed is also verified: here without a look at the times. Sanitizers see the same kernels in the
# tests of render/, and take minutes for it.
if(NOT WHIT_SANITIZE)
  whit_program_test(bench kernels_bench.verifies kernels_bench --benchmark_min_time=0.001)
endif()
