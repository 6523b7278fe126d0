whit_tests(render whit_inspect whit_io test_brute_force)
