# Some on a virtual display.
if(TARGET whit-view)
  whit_tests(viewer whit_view)
  whit_runs_programs(viewer whit whit-view)
endif()
