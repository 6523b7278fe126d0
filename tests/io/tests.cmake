whit_tests(io whit_io whit_inspect)
