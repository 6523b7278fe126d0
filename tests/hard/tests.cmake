whit_tests(hard whit_verify)
# Mistakes that are planted in sources are planted by their text, which changes.
whit_program_test(hard mutations.have_their_places ${CMAKE_CURRENT_SOURCE_DIR}/mutate.sh --check)
