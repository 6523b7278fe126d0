// A closed room of diffuse walls with a panel of light in its ceiling, against radiosity: the
// radiance of every wall follows from the form factors of small patches (Goral, Torrance, Greenberg
// and Battaile 1984, "Modeling the interaction of light between diffuse surfaces"). Only the scene
// is shared with src.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "pi.h"
#include "render/renderer.h"
#include "verify/scene_builder.h"

namespace whit::test {
namespace {

using namespace verify;

constexpr double kPanel = 5;  // radiance of the panel, a third of the ceiling each way

// A wall of the room [-1, 1]^3 runs from its corner along two edges of length 2; u x v points
// inwards.
struct Wall {
  Vec3d corner, u, v;
  double albedo;
  Vec3d normal() const { return cross(u, v); }
  Vec3d at(double s, double t) const { return corner + u * s + v * t; }
};
const std::array<Wall, 6>& walls() {
  static const std::array<Wall, 6> all{{{{-1, -1, -1}, {0, 0, 1}, {1, 0, 0}, 0.7},
                                        {{-1, 1, -1}, {1, 0, 0}, {0, 0, 1}, 0.6},
                                        {{-1, -1, -1}, {0, 1, 0}, {0, 0, 1}, 0.8},
                                        {{1, -1, -1}, {0, 0, 1}, {0, 1, 0}, 0.3},
                                        {{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, 0.5},
                                        {{-1, -1, 1}, {0, 1, 0}, {1, 0, 0}, 0.9}}};
  return all;
}
constexpr std::size_t kCeiling = 1;

bool isPanel(std::size_t wall, double s, double t) {
  constexpr double kThird = 2.0 / 3;
  return wall == kCeiling && s > kThird && s < 2 * kThird && t > kThird && t < 2 * kThird;
}

// Returns the form factor of a point to a rectangle that lies wholly above its surface (Lambert
// 1760).
double factor(const Vec3d& point, const Vec3d& normal, const std::array<Vec3d, 4>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = normalized(corners[i] - point), b = normalized(corners[(i + 1) % 4] - point);
    const Vec3d across = cross(a, b);
    const double sine = length(across);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(across, normal) / sine;
  }
  return std::fabs(sum) / (2 * kPi);
}

class Radiosity {
 public:
  // Each wall has side x side patches; `side` is a multiple of 3.
  explicit Radiosity(int side) : step_(2.0 / side) {
    for (std::size_t w = 0; w < walls().size(); ++w) {
      for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
          const double s = i * step_, t = j * step_;
          patches_.push_back({w,
                              walls()[w].at(s + step_ / 2, t + step_ / 2),
                              {walls()[w].at(s, t), walls()[w].at(s + step_, t),
                               walls()[w].at(s + step_, t + step_), walls()[w].at(s, t + step_)},
                              isPanel(w, s + step_ / 2, t + step_ / 2) ? kPanel : 0});
        }
      }
    }
    solve();
  }

  double at(std::size_t wall, const Vec3d& point) const {
    double gathered = 0;
    for (std::size_t j = 0; j < patches_.size(); ++j) {
      if (patches_[j].wall == wall) continue;
      gathered += factor(point, walls()[wall].normal(), patches_[j].corners) * radiance_[j];
    }
    return walls()[wall].albedo * gathered;
  }

 private:
  struct Patch {
    std::size_t wall;
    Vec3d center;
    std::array<Vec3d, 4> corners;
    double emission;
  };

  void solve() {
    const std::size_t n = patches_.size();
    std::vector<double> factors(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      const Patch& p = patches_[i];
      for (std::size_t j = 0; j < n; ++j) {
        if (patches_[j].wall == p.wall) continue;
        factors[i * n + j] = factor(p.center, walls()[p.wall].normal(), patches_[j].corners);
      }
    }

    // Gauss-Seidel iteration: a sweep leaves at most 0.9 of the error, and far less in this room.
    radiance_.assign(n, 0);

    for (int sweep = 0; sweep < 60; ++sweep) {
      for (std::size_t i = 0; i < n; ++i) {
        double gathered = 0;
        for (std::size_t j = 0; j < n; ++j) gathered += factors[i * n + j] * radiance_[j];
        const double albedo = patches_[i].emission > 0 ? 0 : walls()[patches_[i].wall].albedo;
        radiance_[i] = patches_[i].emission + albedo * gathered;
      }
    }
  }

  double step_;
  std::vector<Patch> patches_;
  std::vector<double> radiance_;
};

Scene room() {
  SceneBuilder builder;
  const std::uint32_t panel = builder.add(emittingMaterial(static_cast<float>(kPanel)));
  for (std::size_t w = 0; w < walls().size(); ++w) {
    const Wall& wall = walls()[w];
    const std::uint32_t own = builder.add(diffuseMaterial(static_cast<float>(wall.albedo)));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double s = i * 2.0 / 3, t = j * 2.0 / 3, d = 2.0 / 3;
        const bool lit = isPanel(w, s + d / 2, t + d / 2);
        builder.add(quad(Vec3f(wall.at(s, t)), Vec3f(wall.at(s + d, t)),
                         Vec3f(wall.at(s + d, t + d)), Vec3f(wall.at(s, t + d)),
                         lit ? panel : own));
      }
    }
  }

  Camera& camera = builder.lookFrom({-0.8f, 0.7f, 0.85f}, {0.3f, -0.35f, -0.6f});
  camera.fov = 100;
  return builder.build();
}

constexpr int kPicture = 48;

// A pixel's ray hits `wall`, whose radiance is known. Pixels do not count that contain two walls or
// the panel's edge.
struct Seen {
  bool counts = false;
  std::size_t wall = 0;
  double radiance = 0;
};

struct Met {
  std::size_t wall = 0;
  double s = 0, t = 0;
};
Met meet(const Vec3d& eye, const Vec3d& direction) {
  Met met;
  double nearest = 1e9;

  for (std::size_t w = 0; w < walls().size(); ++w) {
    const Wall& wall = walls()[w];
    const double towards = dot(direction, wall.normal());
    if (!(towards < 0)) continue;
    const double distance = dot(wall.corner - eye, wall.normal()) / towards;
    if (distance >= nearest) continue;

    nearest = distance;
    const Vec3d at = eye + direction * distance - wall.corner;
    met = {w, dot(at, wall.u), dot(at, wall.v)};
  }
  return met;
}

std::vector<Seen> wantedImage(const Scene& scene, const Radiosity& radiosity) {
  const Camera& camera = scene.cameras[0];
  const Vec3d eye(camera.eye), forward = normalized(Vec3d(camera.at) - eye);
  const Vec3d right = normalized(cross(forward, {0, 1, 0})), up = cross(right, forward);
  const double half = std::tan(double{camera.fov} * kPi / 360);
  const auto through = [&](double x, double y) {
    return meet(eye, forward + right * (half * (2 * x / kPicture - 1)) +
                         up * (half * (1 - 2 * y / kPicture)));
  };

  std::vector<Seen> image;
  for (int y = 0; y < kPicture; ++y) {
    for (int x = 0; x < kPicture; ++x) {
      const Met met = through(x + 0.5, y + 0.5);

      // A pixel lies on one wall if its corners do.
      bool whole = !isPanel(met.wall, met.s, met.t);
      for (const int corner : {0, 1, 2, 3}) {
        const Met other = through(x + corner % 2, y + corner / 2);
        whole = whole && other.wall == met.wall && !isPanel(other.wall, other.s, other.t);
      }

      Seen seen{whole, met.wall, 0};
      if (whole) seen.radiance = radiosity.at(met.wall, walls()[met.wall].at(met.s, met.t));
      image.push_back(seen);
    }
  }
  return image;
}

struct Residuals {
  double sum = 0, squares = 0, wanted = 0, n = 0;
  void add(double got, double expected) {
    sum += got - expected;
    squares += (got - expected) * (got - expected);
    wanted += expected;
    ++n;
  }

  double mean() const { return sum / n; }
  double error() const { return std::sqrt((squares / n - mean() * mean()) / n); }
  double rmse() const { return std::sqrt(squares / n); }
};

class RadiosityRoom : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new Scene(room());
    wanted_ = new std::vector<Seen>(wantedImage(*scene_, Radiosity(12)));
  }
  static void TearDownTestSuite() {
    delete wanted_;
    delete scene_;
  }

  static RenderOptions options(int indirect, int spp) {
    RenderOptions o;
    o.size = ImageSize{kPicture, kPicture};
    o.indirect = indirect;
    o.spp = spp;
    o.cutoff = 0;
    // At most 0.9^40 of the light is left, and of the whitest wall's light alone.
    o.depth = 40;
    return o;
  }

  static std::array<Residuals, 6> residualsOf(const RenderOptions& o) {
    Renderer renderer(*scene_, o);
    Film film = makeFilm(*scene_, o);
    renderer.render(scene_->cameras[0], film);
    std::array<Residuals, 6> walls;
    for (std::size_t i = 0; i < wanted_->size(); ++i) {
      const Seen& seen = (*wanted_)[i];
      if (seen.counts) walls[seen.wall].add(double{film.image.pixels[i].x}, seen.radiance);
    }
    return walls;
  }

  static Residuals all(const std::array<Residuals, 6>& walls) {
    Residuals sum;
    for (const Residuals& w : walls) {
      sum.sum += w.sum;
      sum.squares += w.squares;
      sum.wanted += w.wanted;
      sum.n += w.n;
    }
    return sum;
  }

  static Scene* scene_;
  static std::vector<Seen>* wanted_;
};
Scene* RadiosityRoom::scene_ = nullptr;
std::vector<Seen>* RadiosityRoom::wanted_ = nullptr;

TEST_F(RadiosityRoom, PatchesAreSmallEnough) {
  const Radiosity coarse(6), fine(12);
  for (std::size_t w = 0; w < walls().size(); ++w) {
    const Vec3d at = walls()[w].at(0.4, 1.3);
    EXPECT_NEAR(coarse.at(w, at), fine.at(w, at), 4e-3 * fine.at(w, at)) << w;
  }
}

// With 256 samples a pixel, the mean of each wall is within three standard errors, and so is that
// of all walls, whose standard error is a hundredth at most.
TEST_F(RadiosityRoom, WallsSendWhatRadiositySays) {
  for (const float roulette : {0.0f, 0.5f}) {
    RenderOptions o = options(64, 4);
    o.roulette = roulette;
    const std::array<Residuals, 6> walls = residualsOf(o);
    for (std::size_t w = 0; w < walls.size(); ++w) {
      if (walls[w].n < 50) continue;
      std::printf("wall %zu, %.0f pixels: %.5f, off by %.5f, standard error %.5f\n", w, walls[w].n,
                  walls[w].wanted / walls[w].n, walls[w].mean(), walls[w].error());

      EXPECT_LE(std::fabs(walls[w].mean()), 3 * walls[w].error()) << w;
    }

    const Residuals room = all(walls);
    EXPECT_LE(std::fabs(room.mean()), 3 * room.error());
    EXPECT_LE(room.error(), 0.01 * room.wanted / room.n);
  }
}

// Returns the slope of the line of least squares through the logarithms.
double slopeOf(const std::vector<std::pair<double, double>>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(errors.size());
  for (const auto& [samples, error] : errors) {
    const double a = std::log(samples), b = std::log(error);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

TEST_F(RadiosityRoom, ErrorFallsAsTheRootOfTheSamples) {
  std::vector<std::pair<double, double>> errors;
  for (const auto& [indirect, spp] : {std::pair{1, 1}, {4, 1}, {16, 1}, {64, 1}, {64, 4}}) {
    errors.emplace_back(indirect * spp, all(residualsOf(options(indirect, spp))).rmse());
    std::printf("%4.0f samples: RMSE %.5f\n", errors.back().first, errors.back().second);
  }

  const double slope = slopeOf(errors);
  std::printf("slope %.3f\n", slope);
  EXPECT_NEAR(slope, -0.5, 0.05);
}

}  // namespace
}  // namespace whit::test
