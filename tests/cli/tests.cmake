find_package(nlohmann_json 3.11 REQUIRED)
find_package(ZLIB REQUIRED)
whit_tests(cli whit_cli nlohmann_json::nlohmann_json ZLIB::ZLIB)
whit_runs_programs(cli whit whit-verify)
set(programs $<TARGET_FILE:whit>)
if(TARGET whit-view)
  list(APPEND programs $<TARGET_FILE:whit-view>)
endif()
set(folder ${CMAKE_CURRENT_SOURCE_DIR}/cli)
whit_program_test(cli completion.knows_what_help_knows ${folder}/completion_test.sh ${programs})
whit_program_test(cli manual.says_what_help_says ${folder}/manual_test.sh ${programs})
set(readers $<TARGET_FILE:whit>)
if(TARGET whit-view)
  list(APPEND readers $<TARGET_FILE:whit-view-script>)  # which ends by itself
endif()
# What the pages say does not depend on sanitizers, under which it would take minutes.
if(NOT WHIT_SANITIZE)
  whit_program_test(cli readme.commands_work
                    ${folder}/readme_test.sh
                    ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/tests/README.md
                    ${CMAKE_SOURCE_DIR}/viewer/README.md
                    ${CMAKE_SOURCE_DIR}/scenes/README.md ${CMAKE_SOURCE_DIR}/tests/bench/README.md
                    ${CMAKE_SOURCE_DIR}/src/accuracy/README.md ${readers})
  # Takes longest: begins first.
  set_tests_properties(readme.commands_work PROPERTIES TIMEOUT 600 COST 1000)
endif()
whit_program_test(cli install.works_where_it_is_put ${folder}/install_test.sh ${CMAKE_BINARY_DIR})
whit_program_test(cli lesson.adds_up_in_a_browser ${folder}/lesson_in_browser_test.sh
                  $<TARGET_FILE:whit>)
whit_program_test(cli channels.read_by_others ${folder}/openexr_test.sh $<TARGET_FILE:whit>)
whit_program_test(cli farm.goes_on_after_a_kill ${folder}/farm_test.sh $<TARGET_FILE:whit>)
set_tests_properties(farm.goes_on_after_a_kill PROPERTIES TIMEOUT 300)
