if(TARGET whit-view)
  foreach(name view_camera view_resolution view_script view_exchange view_edit_settings
               view_render_thread view_knobs view_comparison)
    whit_test(${name} whit_view)
  endforeach()
  # These run the program itself, on a virtual display.
  foreach(name view_window view_events)
    whit_test(${name} whit_view)
    target_compile_definitions(${name}_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>"
                                                    WHIT_VIEW_PROGRAM="$<TARGET_FILE:whit-view>")
    add_dependencies(${name}_test whit whit-view)
  endforeach()
  # Only so that they can use the tiny scene.
  foreach(name view_render_thread view_comparison view_edit_settings)
    target_compile_definitions(${name}_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>")
  endforeach()
endif()
