// What the oracle renders, in its own words: those of scenes/README.md. write_scene.h makes a scene
// file of it.
#pragma once

#include <array>
#include <vector>

#include "oracle/vector.h"

namespace oracle {

inline constexpr int kNone = -1;

// Where so little is there rays pass, as through a hole.
inline constexpr double kClear = 1.0 / 1024;

// Of a member that a file may leave out.
enum class Choice { unsaid, no, yes };

struct Texture {
  int width = 0, height = 0;
  // From the top left, 0 to 255; of colors 0 or 255, which are exact as sRGB.
  std::vector<std::array<int, 3>> texels;
  bool isData = false;  // normals, of powers of two a side, and masks
};

struct Material {
  Color diffuse = gray(0.8);
  Color specular;
  double roughness = 0.5;
  Color emission;
  Color mirror, mirrorGrazing;
  Color transmission;
  double ior = 1.5;
  Color absorption;
  int priority = 0;
  Choice glossyReflection = Choice::unsaid;
  bool diffuseReflection = true;  // of indirect light
  bool castsShadow = true;
  int diffuseMap = kNone, specularMap = kNone, emissionMap = kNone;  // multiply what they name

  int normalMap = kNone;  // of tangent space, y along v
  int alphaMap = kNone;   // its first channel, mixed: cut out below the cutoff
  double alphaCutoff = 0.5;
  double coverage = 1;      // the share that is there
  int coverageMap = kNone;  // its first channel multiplies it
  bool thin = false;
  bool frosted = false;  // the roughness is also that of the light that passes
  bool coat = false;     // the mirror dims what lies below it, of which the oracle knows nothing

  bool isInPart() const { return coverage < 1 || coverageMap != kNone; }
  bool transmits() const { return largest(transmission) > 0; }
  // Light goes on behind it, into another medium or, of a sheet, straight on.
  bool passesLight() const { return transmits() || isInPart(); }
  bool isDielectric() const { return transmits() && !thin && !isInPart(); }
  bool isMirror() const { return largest(mirror) > 0 || largest(mirrorGrazing) > 0; }
  // Whether the glossy lobe reflects the scene, where anything asks for it.
  bool reflectsGlossily() const {
    if (!(largest(specular) > 0)) return false;
    if (glossyReflection != Choice::unsaid) return glossyReflection == Choice::yes;
    return !isMirror() && !transmits();
  }
  // Whether the lobe takes light from what lies below it: beside a mirror or an interface that
  // reflect the scene in its place it is their highlight.
  bool lobeCovers() const {
    return largest(specular) > 0 && (reflectsGlossily() || !(isMirror() || transmits()));
  }
};

struct Mesh {
  std::vector<Vec> positions;
  std::vector<Vec> normals;                   // empty: flat
  std::vector<Color> colors;                  // empty: white
  std::vector<std::array<double, 2>> uvs;     // empty: all 0
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
};

// Scaled first, then turned about the axis, then moved.
struct Transform {
  Vec scale{1, 1, 1};
  Vec axis{0, 1, 0};
  double degrees = 0;
  Vec translate;
};

// Turned about one axis. What moves rests before the first key and after the last one.
struct Motion {
  struct Key {
    double time = 0;
    Vec scale{1, 1, 1};
    double degrees = 0;
    Vec translate;
  };
  std::vector<Key> keys;  // none: it does not move
  Vec axis{0, 1, 0};
  bool inSteps = false;  // from key to key, not linearly between them
};

struct Body {
  int object = 0;
  Transform transform;
  bool inPlace = false;  // what the object holds is written where the body stands
  Motion motion{};       // after the transform
};

// A mesh or an exact sphere of one material, among uses of other objects. Where several bodies show
// one object, whit makes instances of it, but for those that are written in place.
struct Object {
  int mesh = 0, material = 0;
  std::vector<Body> before, after;
  double radius = 0;  // above 0: of a sphere instead of the mesh
};

struct Light {
  enum class Kind { point, spot, directional };
  Kind kind = Kind::point;
  Vec position;
  Color intensity;  // of a directional light its irradiance
  double radius = 0.01;
  Vec direction{0, -1, 0};
  double innerConeAngle = 0, outerConeAngle = 45;  // degrees
  Motion motion{};
};

struct Sky {
  enum class Kind { gradient, image };
  Kind kind = Kind::gradient;
  Color zenith, horizon, ground;
  int width = 0, height = 0;  // of the image
  std::vector<Color> texels;  // from the top left; fractions of 256, exact in the file's format
  double scale = 1, rotation = 0;
};

struct Ambient {
  Color up, down;
  double fromSky = 0;    // above 0: so much of a gradient's mean instead
  double occlusion = 0;  // how far a surface looks for what hides ambient light; 0: it does not
};

struct Camera {
  Vec eye{0, 1, 5}, at, up{0, 1, 0};
  double fov = 45;                // vertical, degrees
  double orthographicHeight = 0;  // above 0: parallel rays
  double aperture = 0;            // radius of the lens
  double focus = 0;               // distance of the plane in focus along the view; 0: that of `at`
  Motion motion{};
};

struct Scene {
  int width = 48, height = 32;
  double time = 0;  // of what moves, seconds
  Camera camera;
  std::vector<Light> lights;
  Sky sky;
  Ambient ambient;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Object> objects;
  std::vector<Body> bodies;
};

enum class Filter { nearest, bilinear, trilinear };

// Of a render: the options of whit of the same names.
struct Options {
  int depth = 8;
  int glossy = 0, indirect = 0;
  int lightSamples = 1, ambientSamples = 0;
  int spp = 1;  // of whit's; the oracle is told how many samples to draw
  // These are whit's alone: no mean depends on roulette, and the oracle knows none of the others.
  double roulette = 0, cutoff = 0;
  bool blurredSky = false;
  bool terminator = false;
  Filter filter = Filter::bilinear;
  bool schlickFresnel = false;

  // Samples of a lobe where the eye sees it. Paths of indirect light sample lobes, too.
  int lobeSamples() const { return glossy == 0 && indirect > 0 ? 1 : glossy; }
};

}  // namespace oracle
