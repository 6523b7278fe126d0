# The server of `whit serve`, and its page in a browser.
if(TARGET whit_serve)
  whit_tests(serve whit_serve)
  target_link_libraries(serve_test PRIVATE whit_httplib)
  whit_runs_programs(serve whit)
  if(NOT WHIT_SANITIZE)
    find_program(WHIT_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
    whit_program_test(serve serve.page_in_browser ${WHIT_SYSTEM_PYTHON}
                      ${CMAKE_CURRENT_SOURCE_DIR}/serve/browser_test.py $<TARGET_FILE:whit>)
    set_tests_properties(serve.page_in_browser PROPERTIES TIMEOUT 600)
  endif()
endif()
