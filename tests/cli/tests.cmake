whit_test(cli_options whit_cli)
whit_test(cli_reports whit_cli)
whit_test(effects_report whit_cli)
whit_test(cli_interrupt whit_cli)
# These run the program itself.
find_package(nlohmann_json 3.11 REQUIRED)
foreach(name cli_program cli_images cli_json cli_effects cli_limits cli_memory cli_stress cli_set)
  whit_test(${name} whit_io nlohmann_json::nlohmann_json)
  target_compile_definitions(${name}_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>")
  add_dependencies(${name}_test whit)
endforeach()
target_link_libraries(cli_memory_test PRIVATE ZLIB::ZLIB)
set(programs $<TARGET_FILE:whit>)
if(TARGET whit-view)
  list(APPEND programs $<TARGET_FILE:whit-view>)
endif()
add_test(NAME manual.says_what_help_says
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/manual_test.sh ${programs})
# What README.md says does not depend on sanitizers, under which it would take minutes.
if(NOT WHIT_SANITIZE)
  add_test(NAME readme.commands_work
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/cli/readme_test.sh ${CMAKE_SOURCE_DIR}/README.md
                   ${programs})
  set_tests_properties(readme.commands_work PROPERTIES TIMEOUT 600)
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
