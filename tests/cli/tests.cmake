find_package(nlohmann_json 3.11 REQUIRED)
find_package(ZLIB REQUIRED)
whit_tests(cli whit_cli nlohmann_json::nlohmann_json ZLIB::ZLIB)
whit_runs_programs(cli whit)
set(programs $<TARGET_FILE:whit>)
if(TARGET whit-view)
  list(APPEND programs $<TARGET_FILE:whit-view>)
endif()
add_test(NAME manual.says_what_help_says
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/manual_test.sh ${programs})
# What the pages say does not depend on sanitizers, under which it would take minutes.
if(NOT WHIT_SANITIZE)
  add_test(NAME readme.commands_work
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/readme_test.sh
                   ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/viewer/README.md
                   ${CMAKE_SOURCE_DIR}/scenes/README.md ${CMAKE_SOURCE_DIR}/tests/bench/README.md
                   ${CMAKE_SOURCE_DIR}/src/accuracy/README.md ${programs})
  # Takes longest: begins first.
  set_tests_properties(readme.commands_work PROPERTIES TIMEOUT 600 COST 1000)
endif()
add_test(NAME install.works_where_it_is_put
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/install_test.sh ${CMAKE_BINARY_DIR})
add_test(NAME farm.goes_on_after_a_kill
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/farm_test.sh $<TARGET_FILE:whit>)
set_tests_properties(farm.goes_on_after_a_kill PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
if(WHIT_MPI)
  add_test(NAME farm.ranks_make_the_same_image
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/mpi_test.sh $<TARGET_FILE:whit>)
  set_tests_properties(farm.ranks_make_the_same_image PROPERTIES TIMEOUT 300)
endif()
