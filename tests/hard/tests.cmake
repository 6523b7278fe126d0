whit_tests(hard whit_stress)
