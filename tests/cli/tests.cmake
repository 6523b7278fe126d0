whit_test(cli_options whit_cli)
whit_test(cli_reports whit_cli)
# These run the program itself.
find_package(nlohmann_json 3.11 REQUIRED)
foreach(name cli_program cli_images cli_json)
  whit_test(${name} whit_io nlohmann_json::nlohmann_json)
  target_compile_definitions(${name}_test PRIVATE WHIT_PROGRAM="$<TARGET_FILE:whit>")
  add_dependencies(${name}_test whit)
endforeach()
