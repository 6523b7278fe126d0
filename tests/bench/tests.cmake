find_package(benchmark REQUIRED) add_executable(kernels_bench bench / kernels_bench.cpp)
    target_link_libraries(kernels_bench PRIVATE whit_render whit_io benchmark::benchmark)
        target_include_directories(kernels_bench PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
            set_target_properties(
                kernels_bench PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR} / tests)
#What is timed is also verified : here without a look at the times.
                add_test(
                    NAME kernels_bench.verifies COMMAND kernels_bench-- benchmark_min_time = 0.001)
                    set_tests_properties(kernels_bench.verifies PROPERTIES ENVIRONMENT
                                         "WHIT_SOURCE_DIR=${CMAKE_SOURCE_DIR}")
