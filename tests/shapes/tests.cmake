whit_test(shapes_closed whit_scene) whit_test(shapes_measure whit_scene)
    whit_test(shapes_ground whit_scene) whit_test(patterns whit_scene)
