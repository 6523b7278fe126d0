whit_tests(unit whit_make whit_sampling)
