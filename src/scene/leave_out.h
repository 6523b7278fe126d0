// The same scene without some of its effects: what remains calls for all the others and for none of
// those. Measures and tests compare a scene with itself in this way.
#pragma once

#include "scene/scene.h"

namespace whit {

// Takes out what turns each effect on (see effects_of_scene.cpp): textures and normal maps, whose
// texels go too when no material is left that uses them; alpha masks, so that masked surfaces
// become solid; vertex normals; lobes, emission, lights; the sky, or of a sky image only the image,
// in whose place comes a gradient; mirrors, transmission (glass becomes opaque) and absorption; all
// uses of an object but the first. Without shadows nothing casts any. Without mirror dielectrics
// get the refractive index of the vacuum, because others reflect.
void leaveOut(SceneDescription& description, EffectSet effects);

}  // namespace whit
