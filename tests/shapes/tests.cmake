whit_tests(shapes whit_io whit_scene)
