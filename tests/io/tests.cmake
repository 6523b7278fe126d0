whit_tests(io whit_io whit_inspect)
foreach(part DRACO MESHOPT WEBP)  # whether the build found the library, whatever the reader says
  if(WHIT_HAS_${part})
    target_compile_definitions(io_test PRIVATE WHIT_${part})
  endif()
endforeach()
