# Measures the viewer in motion, without a window.
if(TARGET whit_session)
  add_executable(whit-walk viewer/walk.cpp)
  target_link_libraries(whit-walk PRIVATE whit_session)
endif()

# Some on a virtual display, by whit-view-script, which is whit-view with a scripted user.
if(TARGET whit-view)
  add_executable(whit-view-script viewer/whit_view_script.cpp viewer/script.cpp)
  target_link_libraries(whit-view-script PRIVATE whit_view)
  if(WHIT_SANITIZE MATCHES address)
    target_sources(whit-view-script PRIVATE ${CMAKE_SOURCE_DIR}/viewer/keep_drivers.cpp)
  endif()
  whit_tests(viewer whit_view)
  target_sources(viewer_test PRIVATE viewer/script.cpp)
  # It is no test, and does not see what tests have.
  set_source_files_properties(viewer/script.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_include_directories(viewer_test SYSTEM PRIVATE ${WHIT_IMGUI_INCLUDE_DIR})
  whit_runs_programs(viewer whit whit-view whit-view-script)
  if(NOT WHIT_SANITIZE)
    whit_program_test(viewer viewer.takes_real_input
                      ${CMAKE_CURRENT_SOURCE_DIR}/viewer/real_input_test.sh $<TARGET_FILE:whit-view>)
    set_tests_properties(viewer.takes_real_input PROPERTIES TIMEOUT 300)
  endif()
endif()
