whit_tests(shapes whit_io)
