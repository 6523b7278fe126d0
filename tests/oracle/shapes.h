// Meshes of the oracle's scenes, about the origin, within 1 of it.
#pragma once

#include "oracle/scene.h"

namespace oracle {

Mesh box();
Mesh tetrahedron();
// In the plane y = 0, seen from above; texture coordinates from 0 to 1.
Mesh pane();
// The same with texture coordinates that are repeated, turned and from below 0.
Mesh turnedPane(double repeats);
// A sphere of segments * rings faces with its own normals.
Mesh ball(int segments, int rings);

}  // namespace oracle
