whit_test(invariance whit_render whit_io)
whit_test(effects_law whit_render whit_io)
whit_test(scaling whit_render whit_io)
whit_test(twins whit_render whit_io whit_metrics)
