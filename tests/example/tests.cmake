whit_program_test(example install.can_be_embedded
                  ${CMAKE_CURRENT_SOURCE_DIR}/example/embed_test.sh ${CMAKE_BINARY_DIR} ${CMAKE_COMMAND}
                  ${CMAKE_CXX_COMPILER} ${CMAKE_GENERATOR} ${CMAKE_MAKE_PROGRAM})
find_package(nlohmann_json 3.11 REQUIRED)
whit_tests(example whit_library whit_inspect whit_io test_brute_force nlohmann_json::nlohmann_json)
