whit_test(hard whit_stress)
whit_test(accounted whit_stress)
