# Some on a virtual display.
if(TARGET whit-view)
  whit_tests(viewer whit_view)
  whit_runs_programs(viewer whit whit-view)
  if(NOT WHIT_SANITIZE)
    add_test(NAME viewer.takes_real_input COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/viewer/real_input_test.sh
                                                  $<TARGET_FILE:whit-view>)
    set_tests_properties(viewer.takes_real_input PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300)
  endif()
endif()
