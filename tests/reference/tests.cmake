whit_tests(reference whit_make whit_io test_brute_force)
