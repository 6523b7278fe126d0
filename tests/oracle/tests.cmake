# The oracle sees none of whit: it is given the flags of its sources and not their folders.
add_library(whit_oracle STATIC oracle/faces.cpp oracle/integral.cpp oracle/mip_chain.cpp
                               oracle/optics.cpp oracle/placement.cpp oracle/shapes.cpp
                               oracle/tracer.cpp oracle/write_scene.cpp)
target_compile_options(whit_oracle PRIVATE $<TARGET_PROPERTY:whit_flags,INTERFACE_COMPILE_OPTIONS>)
# Sanitizers watch whit. The oracle, which is slow, would take most of their time.
if(WHIT_SANITIZE)
  target_compile_options(whit_oracle PRIVATE -fno-sanitize=all)
endif()
find_package(nlohmann_json 3.11 REQUIRED)
target_link_libraries(whit_oracle PRIVATE nlohmann_json::nlohmann_json)
target_include_directories(whit_oracle PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
whit_tests(oracle whit_oracle whit_library whit_flags)
