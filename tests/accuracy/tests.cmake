find_package(nlohmann_json 3.11 REQUIRED)
whit_tests(accuracy whit_accuracy whit_cli nlohmann_json::nlohmann_json)
whit_runs_programs(accuracy whit whit-verify)
# Where there is a Chromium.
if(NOT WHIT_SANITIZE)
  whit_program_test(accuracy accuracy.reports_fit_a_browser
                    ${CMAKE_CURRENT_SOURCE_DIR}/accuracy/report_in_browser_test.sh
                    $<TARGET_FILE:whit> $<TARGET_FILE:whit-verify>)
  set_tests_properties(accuracy.reports_fit_a_browser PROPERTIES TIMEOUT 300)
endif()
