whit_tests(render whit_inspect whit_io)
