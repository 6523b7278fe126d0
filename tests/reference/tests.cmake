whit_tests(reference whit_make whit_reference)
