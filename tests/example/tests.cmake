add_test(NAME install.can_be_embedded
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/example/embed_test.sh ${CMAKE_BINARY_DIR}
                 ${CMAKE_COMMAND} ${CMAKE_CXX_COMPILER})
whit_tests(example whit_library whit_render whit_io)
