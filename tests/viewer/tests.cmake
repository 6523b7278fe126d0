if(TARGET whit-view)
  foreach(name view_camera view_resolution view_script view_render_thread view_knobs)
    whit_test(${name} whit_view)
  endforeach()
  # This runs the program itself, on a virtual display.
  whit_test(view_window whit_view)
  target_compile_definitions(view_window_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>"
                                                      WHIT_VIEW_PROGRAM="$<TARGET_FILE:whit-view>")
  add_dependencies(view_window_test whit whit-view)
  target_compile_definitions(view_render_thread_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>")
endif()
