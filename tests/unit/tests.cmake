whit_tests(unit whit_scene)
