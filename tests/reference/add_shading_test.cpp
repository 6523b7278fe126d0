// The sum over the lights.
#include "reference/add_shading.h"

#include <gtest/gtest.h>

#include "pi.h"
#include "reference/small_scenes.h"
#include "rounding.h"

namespace whit::reference {
namespace {

using namespace test;

TEST(Lights, AddUpAndKeepTheirColors) {
  Material m;
  m.diffuse = {1, 0.5f, 0.25f};
  Light blue = lightAt({0, 3, 0}, 9);
  blue.intensity = {0, 9, 18};
  expectNear(radianceBelow(litFloor(m, {lightAt({0, 2, 0}, 4), blue})) * kPi,
             {1, 0.5 * 2, 0.25 * 3});
}

}  // namespace
}  // namespace whit::reference
