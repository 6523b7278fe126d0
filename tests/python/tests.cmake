# The Python module, where it is built: a test program a file.
if(WHIT_HAS_PYTHON)
  file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/python/*_test.py)
  foreach(test ${tests})
    get_filename_component(name ${test} NAME_WE)
    whit_program_test(python python.${name} ${CMAKE_COMMAND} -E env PYTHONPATH=${CMAKE_BINARY_DIR}/python
                      WHIT_PROGRAM=$<TARGET_FILE:whit> PYTHONDONTWRITEBYTECODE=1
                      ${Python_EXECUTABLE} ${test})
  endforeach()
  whit_program_test(python python.pip_installs ${CMAKE_CURRENT_SOURCE_DIR}/python/pip_test.sh
                    ${Python_EXECUTABLE} ${CMAKE_BINARY_DIR})
endif()
