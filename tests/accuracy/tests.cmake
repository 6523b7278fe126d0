whit_tests(accuracy whit_accuracy whit_cli)
whit_runs_programs(accuracy whit)
# Where there is a Chromium.
if(NOT WHIT_SANITIZE)
  whit_program_test(accuracy accuracy.report_fits_a_browser
                    ${CMAKE_CURRENT_SOURCE_DIR}/accuracy/report_in_browser_test.sh
                    $<TARGET_FILE:whit>)
  set_tests_properties(accuracy.report_fits_a_browser PROPERTIES TIMEOUT 300)
endif()
