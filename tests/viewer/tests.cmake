# Some on a virtual display.
if(TARGET whit-view)
  whit_tests(viewer whit_view)
  whit_runs_programs(viewer whit whit-view)
  if(NOT WHIT_SANITIZE)
    whit_program_test(viewer viewer.takes_real_input
                      ${CMAKE_CURRENT_SOURCE_DIR}/viewer/real_input_test.sh $<TARGET_FILE:whit-view>)
    set_tests_properties(viewer.takes_real_input PROPERTIES TIMEOUT 300)
  endif()
endif()
