whit_tests(unit whit_scene whit_sampling)
