whit_tests(accuracy whit_accuracy whit_cli)
whit_runs_programs(accuracy whit)
