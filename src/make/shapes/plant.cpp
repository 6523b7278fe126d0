#include "make/patterns/noise.h"
#include "make/shapes/generators.h"
#include "make/shapes/mesh_builder.h"

namespace whit::procedural {
namespace {

struct Frond {
  double angle, lift, size, width, droop, start;
};

// A long leaf that rises from the foot and bends over; u across, v from foot to tip, for a mask.
void addFrond(MeshBuilder& builder, const Frond& f) {
  constexpr int kAcross = 4, kAlong = 14;
  const Vec3d out{std::cos(f.angle), 0, -std::sin(f.angle)};
  const Vec3d side{-std::sin(f.angle), 0, -std::cos(f.angle)};
  std::vector<Vec3d> spine{Vec3d{0, f.start, 0}};
  for (int k = 0; k < kAlong; ++k) {
    const double a = f.lift - f.droop * k / (kAlong - 1.0);
    spine.push_back(spine.back() +
                    (out * std::cos(a) + Vec3d{0, std::sin(a), 0}) * (f.size / kAlong));
  }
  builder.smoothSheet(
      kAcross, kAlong, false,
      [&](int i, int j) {
        const double s = 2.0 * i / kAcross - 1;
        const double keel = 0.35 * f.width * std::fabs(s);
        return spine[static_cast<std::size_t>(j)] + side * (s * f.width) + Vec3d{0, keel, 0};
      },
      [&](int i, int j) {
        return Uv{static_cast<double>(i) / kAcross, static_cast<double>(j) / kAlong};
      });
}

}  // namespace

// A tuft of bending leaves standing on y = 0, for a pot: slots stem, leaves. Leaves are cards for
// an alpha mask of one leaf with its foot at v = 0.
Shape makePlant(ShapeParameters& parameters) {
  const int leaves = parameters.integer("leaves", 28, 1, 10000);
  const double height = parameters.number("height", 1, 1e-3, 1e6);
  const double width = parameters.number("leafWidth", 0.16 * height, 1e-6, 1e6) / 2;
  const double trunk = parameters.number("trunk", 0.1 * height, 0, 1e6);
  const auto seed = static_cast<std::uint32_t>(parameters.integer("seed", 1, 0, 1 << 30));
  RandomStream random(seed * 31u + 5u);
  MeshBuilder stem, cards;
  const double r = 0.05 * height, top = std::max(trunk, 1e-3 * height);
  stem.revolve(creasedProfile({{0, -0.1 * height},
                               {1.2 * r, -0.1 * height},
                               {0.8 * r, top},
                               {0.5 * r, top + 0.04 * height},
                               {0, top + 0.05 * height}},
                              60),
               12);
  for (int k = 0; k < leaves; ++k) {
    const double t = (k + 0.5) / leaves;  // outer leaves first, they lie lower
    Frond f{};
    f.angle = 2.39996 * k + random.between(-0.2, 0.2);
    f.lift = lerp(0.55, 1.5, t) + random.between(-0.1, 0.1);
    f.size = height * lerp(0.85, 1.1, random.next());
    f.width = width * random.between(0.8, 1.15);
    f.droop = lerp(1.7, 0.7, t) * random.between(0.8, 1.2);
    f.start = trunk * lerp(0.6, 1, t);
    addFrond(cards, f);
  }
  Shape shape;
  shape.parts.push_back({"stem", stem.take("stem")});
  shape.parts.push_back({"leaves", cards.take("leaves")});
  return shape;
}

}  // namespace whit::procedural
