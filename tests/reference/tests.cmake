whit_tests(reference whit_reference)
