whit_tests(render whit_render whit_io whit_metrics)
