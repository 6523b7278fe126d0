// Scenes that move: pictures against closed forms. That pictures depend on the time alone is tested
// by Library.ScenesMoveAndComeBack, and that they are the same for any division of the work by the
// image hashes of orrery.
#include "bake/edit_scene.h"

#include <gtest/gtest.h>

#include "inspect/reference_frame.h"
#include "pi.h"
#include "reference/small_scenes.h"
#include "render/frame.h"
#include "render/pipeline_laws.h"

namespace whit::test {
namespace {

// A scene that moves, and its pictures.
struct MovingPicture {
  explicit MovingPicture(Scene moving, const RenderOptions& options = smallOptions())
      : scene(std::move(moving)), renderer(scene, options) {}

  void moveTo(double seconds) {
    moveScene(scene, seconds);
    renderer.sceneMoved();
  }
  Image at(double seconds, bool packets = true) {
    moveTo(seconds);
    return render(renderer, packets).image;
  }

  Scene scene;
  Renderer renderer;
};

// Returns a builder whose only camera sees eight by eight units about the origin in parallel rays,
// and whose instances may follow a motion.
SceneBuilder movedBy(Motion motion) {
  SceneBuilder builder;
  builder.lookFrom({0, 0, 9}).orthographicHeight = 8;
  builder.description.motion.rig = {
      {kNoNode, Affine(), std::make_shared<const Motion>(std::move(motion))}};
  return builder;
}

constexpr double kPixelsOfAUnit = 8;  // to a unit

RenderOptions squarePicture() {
  RenderOptions o;
  o.size = ImageSize{64, 64};
  return o;
}

// A ball of radius 1 moves by (0.5, -0.25) a second and grows by a quarter of its size at 0 s.
TEST(MovingScene, MotionOfABallIsThatOfItsPoints) {
  SceneBuilder builder = movedBy([](double seconds) {
    return Affine::translation({0.5 * seconds, -0.25 * seconds, 0}) *
           Affine::scaling(Vec3d(1 + 0.25 * seconds));
  });
  builder.place({"ball", {exactSphere(builder.add(emittingMaterial(1)))}}, {Affine()});
  builder.description.instances[0].mover = 0;

  RenderOptions options = squarePicture();
  options.channels = parseChannels("motion,position,object");
  MovingPicture moving(builder.build(), options);
  moving.moveTo(1);
  moving.renderer.setEarlier(rememberView(moving.scene, moving.scene.cameras[0]));
  moving.moveTo(2);
  Film film = render(moving.renderer);

  const auto positions = film.channels.floats(Channel::position);
  const auto motions = film.channels.floats(Channel::motion);
  int seen = 0;
  for (const auto i : indices(film.image.pixels)) {
    const bool isHit = film.channels.numbers(Channel::object)[i] != kNoNumber;
    seen += isHit;

    // A point of the ball of radius 1.5 about (1, -0.5) was on one of radius 1.25 about half of it.
    const double x = positions[3 * i], y = positions[3 * i + 1];
    const double right = x - 0.5 - (x - 1) * 1.25 / 1.5;
    const double up = y + 0.25 - (y + 0.5) * 1.25 / 1.5;
    constexpr double kRounding = 1e-5;  // of positions in float, in pixels
    ASSERT_NEAR(motions[2 * i], isHit ? kPixelsOfAUnit * right : 0, kRounding) << i;
    ASSERT_NEAR(motions[2 * i + 1], isHit ? -kPixelsOfAUnit * up : 0, kRounding) << i;
  }
  EXPECT_GT(seen, 300);
}

// Places a square of 6 by 6 units and a brighter one of 2 by 2, each with its mover.
void placeSquares(SceneBuilder& builder, std::uint32_t moverOfLarge, std::uint32_t moverOfSmall) {
  const Affine upright = Affine::rotation({1, 0, 0}, 90);
  for (const bool isLarge : {true, false}) {
    const Mesh square =
        floorAt(0, isLarge ? 3 : 1, builder.add(emittingMaterial(isLarge ? 0.25f : 1)));
    builder.place({"square", {square}},
                  {Affine::translation(isLarge ? Vec3d() : Vec3d{0.3, -0.2, 0}) * upright});
    builder.description.instances.back().mover = isLarge ? moverOfLarge : moverOfSmall;
  }
}

// Of two squares in one plane the later one is seen wherever both move, each by its own motion.
TEST(MovingScene, CoplanarSquaresMoveTogether) {
  SceneBuilder builder = movedBy([](double seconds) {
    return Affine::translation({0.5 * seconds, 0, 0});
  });
  Rig& rig = builder.description.motion.rig;
  rig.push_back(rig[0]);
  placeSquares(builder, 0, 1);

  MovingPicture moving(builder.build(), squarePicture());
  EXPECT_FALSE(moving.scene.coplanar.empty());
  for (const double seconds : {0.0, 0.37, 1.0, 0.0}) {
    const Image image = moving.at(seconds);
    EXPECT_FALSE(moving.scene.coplanar.empty());
    // The smaller square measures two by two units.
    EXPECT_EQ(std::ranges::count(image.pixels, Rgb(1.0f)), 16 * 16) << seconds;
  }
}

// A square comes to lie on a larger one, which is seen nowhere below it.
TEST(MovingScene, SquaresMeetAfterTheStart) {
  SceneBuilder builder = movedBy([](double seconds) {
    return Affine::translation({0, 0, 1 - seconds});
  });
  placeSquares(builder, kNoNode, 0);

  MovingPicture moving(builder.build(), squarePicture());
  EXPECT_TRUE(moving.scene.coplanar.empty());
  for (const bool packets : {false, true}) {
    EXPECT_EQ(std::ranges::count(moving.at(1, packets).pixels, Rgb(1.0f)), 16 * 16) << packets;
    EXPECT_FALSE(moving.scene.coplanar.empty());
  }
  moving.moveTo(0);
  EXPECT_TRUE(moving.scene.coplanar.empty());
}

// From 1 s on the transform mirrors at x = 0.
Affine mirroring(double seconds) { return Affine::scaling({seconds < 1 ? 1.0 : -1.0, 1, 1}); }

// Adds a vault along y: heights and normals depend on x alone, and x and -x are alike.
void addVault(float shift, Mesh& mesh) {
  constexpr int kColumns = 8;
  for (int i = 0; i <= kColumns; ++i) {
    const float x = static_cast<float>(i) / (kColumns / 2) - 1;
    const auto first = size32(mesh.positions);
    for (const float y : {-1.0f, 1.0f}) {
      mesh.positions.push_back({x + shift, y, 0.5f - 0.5f * x * x});
      mesh.normals.emplace_back(normalized(Vec3d{x, 0, 1}));
    }

    // Two triangles join this column to the next one.
    if (i == kColumns) break;
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 1});
  }
}

// Joint 0, which mirrors, moves the vertices up to x = 1; joint 1, which stands still, moves the
// others. A morph target bends all of them.
std::shared_ptr<const Deformation> mirroredSkin(const Mesh& mesh) {
  Deformation d;
  d.positions = mesh.positions;
  d.normals = mesh.normals;

  d.targets.resize(1);
  for (const Vec3f& p : mesh.positions) d.targets[0].positions.push_back({0, 0, 0.1f * p.x * p.x});
  d.weights = {0.5};
  d.skeleton = std::make_shared<const Rig>(
      Rig{{kNoNode, Affine(), std::make_shared<const Motion>(mirroring)}, {}});
  d.joints = {{0, Affine()}, {1, Affine()}};
  d.firstInfluence = {0};

  for (const Vec3f& p : mesh.positions) {
    d.influences.push_back({p.x > 1 ? 1u : 0u, 1});
    d.firstInfluence.push_back(size32(d.influences));
  }
  return std::make_shared<const Deformation>(std::move(d));
}

enum class Mirrors { skin, partOfASkin, node };

Scene mirroredVault(Mirrors what, bool doubleSided) {
  SceneBuilder builder = movedBy(mirroring);
  Material material = diffuseMaterial(0.8f);
  material.doubleSided = doubleSided;
  Mesh mesh;
  mesh.materials = {builder.add(material)};
  addVault(0, mesh);
  if (what == Mirrors::partOfASkin) addVault(3, mesh);
  if (what != Mirrors::node) mesh.deformation = mirroredSkin(mesh);

  builder.place({"vault", {mesh}}, {Affine()});
  if (what == Mirrors::node) builder.description.instances[0].mover = 0;
  builder.description.lights = {lightAt({0, 2, 5}, 60)};
  builder.description.cameras = {{.eye = {1.03f, 0, 9}, .at = {1.03f, 0, 0}, .fov = 40}};
  return builder.build();
}

// A symmetric surface looks as before when it is mirrored, in packets and in the reference.
void expectAlikeMirrored(Scene scene) {
  MovingPicture moving(std::move(scene));
  for (const bool packets : {false, true}) {
    const Image before = moving.at(0, packets), after = moving.at(2, packets);
    const std::size_t lit = pixelsApart(before, Image(before.width, before.height), 0.1f);
    EXPECT_GT(lit, 100u) << packets;
    // Edges move in the last bits, so pixels at edges may differ.
    EXPECT_LE(pixelsApart(before, after, 1e-5f), lit / 100) << packets;
    EXPECT_EQ(firstDifference(moving.at(0, packets), before), "");
  }
}

TEST(MovingScene, MirroredSurfacesAreShadedAsBefore) {
  for (const Mirrors what : {Mirrors::skin, Mirrors::partOfASkin, Mirrors::node}) {
    for (const bool doubleSided : {true, false}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(what)) +
                   (doubleSided ? " from both sides" : ""));
      expectAlikeMirrored(mirroredVault(what, doubleSided));
    }
  }
}

}  // namespace
}  // namespace whit::test
