// The camera's rays through the pixels of a queue.
#include "simd/kernels.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/generate_rays.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep

#include "simd/random_streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace whit::simd::HWY_NAMESPACE {

// Points of the unit disk that belong to points of the unit square (reference/generate_rays.cpp).
struct DiskPoints {
  VF x, y;
};

HWY_INLINE DiskPoints DiskPointsOf(const UnitPoints& square) {
  const FloatTag d;
  const VF one = Set(1.0f), two = Set(2.0f);
  const VF a = MulThenSub(two, square.u, one), b = MulThenSub(two, square.v, one);

  // The larger coordinate becomes the radius, so squares about the center become circles.
  const MF byA = Gt(Abs(a), Abs(b));
  const VF radius = IfThenElse(byA, a, b), other = IfThenElse(byA, b, a);

  // The smaller one becomes the angle, at most an eighth of a turn from the axis.
  const VF divisor = IfThenElse(Eq(radius, Zero()), one, radius);
  const VF turn = Mul(Set(0.785398163f), Div(other, divisor));
  const VF along = Mul(radius, hn::Cos(d, turn)), across = Mul(radius, hn::Sin(d, turn));
  return {IfThenElse(byA, along, across), IfThenElse(byA, across, along)};
}

// Moves the starts of rays to points of the lens and turns the rays, so that they meet in the plane
// of focus where they met it before.
class Lens {
 public:
  explicit Lens(const CameraFrame& camera)
      : right_(Broadcast3(Vec3f(normalized(camera.right) * camera.aperture))),
        up_(Broadcast3(Vec3f(normalized(camera.up) * camera.aperture))) {
    // Neither factor of the sum is above 1, so that no component overflows.
    const double largest = std::max(camera.aperture, camera.focus);
    forward_ = Set(static_cast<float>(camera.focus / largest));
    turnRight_ = Broadcast3(Vec3f(normalized(camera.right) * (-camera.aperture / largest)));
    turnUp_ = Broadcast3(Vec3f(normalized(camera.up) * (-camera.aperture / largest)));
  }

  // `direction` reaches from the start to the plane at distance 1.
  HWY_INLINE void Bend(const DiskPoints& at, V3& origin, V3& direction) const {
    origin = MulAdd3(right_, at.x, MulAdd3(up_, at.y, origin));
    direction = MulAdd3(turnRight_, at.x, MulAdd3(turnUp_, at.y, Scale3(direction, forward_)));
  }

 private:
  V3 right_, up_, turnRight_, turnUp_;
  VF forward_;
};

// Bends places in the picture to directions (the scalar reference: reference/generate_rays.cpp).
class Projector {
 public:
  explicit Projector(const CameraFrame& camera) : camera_(camera) {
    for (size_t i = 0; i < 8; ++i) distortion_[i] = static_cast<float>(camera.distortion[i]);
  }

  // Returns the directions along right, up and forward through the points x, y pixels right of and
  // above the center. Clears the lanes of `seen` that see nothing.
  HWY_INLINE V3 Bend(VF x, VF y, MF& seen) const {
    if (camera_.projection == Projection::directions) {
      return Towards(Azimuth(x), Entry(camera_.elevations, Neg(y), camera_.viewHeight));
    }

    // The other projections take tangents, radians or focal lengths instead of pixels.
    x = Mul(x, Set(static_cast<float>(length(camera_.right))));
    y = Mul(y, Set(static_cast<float>(length(camera_.up))));
    if (camera_.projection == Projection::panorama) return Towards(x, y);
    if (camera_.projection != Projection::perspective) return Fisheye(x, y, seen);
    return Undistorted(x, Neg(y), seen);
  }

  // Returns radians to the right of the view, for projections by azimuth and elevation.
  HWY_INLINE VF Azimuth(VF x) const {
    if (camera_.projection == Projection::directions) {
      return Entry(camera_.azimuths, x, camera_.viewWidth);
    }
    return Mul(x, Set(static_cast<float>(length(camera_.right))));
  }

 private:
  // Returns a coefficient of the distortion, times the factor.
  HWY_INLINE VF Coefficient(size_t i, float factor = 1) const {
    return Set(factor * distortion_[i]);
  }

  HWY_INLINE V3 Undistorted(VF u, VF v, MF& seen) const {
    const VF one = Set(1.0f), two = Set(2.0f), zero = Zero();

    // Newton's method starts at the distorted point.
    VF x = u, y = v;
    for (int step = 0;; ++step) {
      const VF x2 = Mul(x, x), y2 = Mul(y, y), r2 = Add(x2, y2);
      const VF twoXY = Mul(two, Mul(x, y));

      // The radial part of OpenCV's model scales by a quotient of polynomials in r^2.
      const auto polynomial = [&](VF c0, VF c1, VF c2)
                                  HWY_ATTR { return MulThenAdd(MulThenAdd(c2, r2, c1), r2, c0); };
      const VF above =
          MulThenAdd(polynomial(Coefficient(0), Coefficient(1), Coefficient(4)), r2, one);
      const VF below =
          MulThenAdd(polynomial(Coefficient(5), Coefficient(6), Coefficient(7)), r2, one);
      const VF scale = Div(above, below);

      // The scale changes by `slope` * r with r, and the distorted radius by `radial`.
      const VF change =
          NegMulThenAdd(scale, polynomial(Coefficient(5), Coefficient(6, 2), Coefficient(7, 3)),
                        polynomial(Coefficient(0), Coefficient(1, 2), Coefficient(4, 3)));
      const VF slope = Mul(two, Div(change, below));
      const VF radial = MulThenAdd(slope, r2, scale);

      // The residual is the model's image of (x, y), with the tangential part, minus (u, v).
      const auto off = [&](VF at, VF at2, VF p, VF q, VF wanted) HWY_ATTR {
        const VF tangential = MulThenAdd(p, twoXY, Mul(q, MulThenAdd(two, at2, r2)));
        return Add(MulThenSub(at, scale, wanted), tangential);
      };
      const VF offX = off(x, x2, Coefficient(2), Coefficient(3), u),
               offY = off(y, y2, Coefficient(3), Coefficient(2), v);

      // The result counts if it is precise and does not lie beyond a fold of the picture.
      if (step == kLensSteps) {
        const VF error = Max(Abs(offX), Abs(offY));
        const VF least = Min(Min(scale, below), radial);
        seen = And(Lt(error, Set(static_cast<float>(kLensError))), Gt(least, zero));
        return {x, Neg(y), one};
      }

      // The step inverts the radial part's Jacobian, scale * I + slope * p * p^T, by Sherman and
      // Morrison's formula.
      const VF share = Div(Mul(slope, MulThenAdd(x, offX, Mul(y, offY))), radial);
      x = Sub(x, Div(NegMulThenAdd(x, share, offX), scale));
      y = Sub(y, Div(NegMulThenAdd(y, share, offY), scale));
    }
  }

  HWY_INLINE VF FisheyeAngle(VF radius, MF& seen) const {
    const FloatTag d;
    // In an equisolid projection r = 2 sin(angle / 2).
    if (camera_.projection == Projection::equisolid) {
      const VF half = hn::Asin(d, Mul(radius, Set(0.5f)));
      return Add(half, half);
    }

    // The others have OpenCV's r = angle * (1 + k1 angle^2 + k2 angle^4 + ...), which Newton's
    // method inverts.
    VF angle = radius;
    for (int step = 0;; ++step) {
      const VF a2 = Mul(angle, angle);
      const auto polynomial = [&](VF c1, VF c2, VF c3, VF c4) HWY_ATTR {
        const VF inner = MulThenAdd(MulThenAdd(c4, a2, c3), a2, c2);
        return MulThenAdd(MulThenAdd(inner, a2, c1), a2, Set(1.0f));
      };

      const VF off = MulThenSub(
          angle, polynomial(Coefficient(0), Coefficient(1), Coefficient(2), Coefficient(3)),
          radius);
      const VF slope =
          polynomial(Coefficient(0, 3), Coefficient(1, 5), Coefficient(2, 7), Coefficient(3, 9));

      if (step == kLensSteps) {
        seen = And(Lt(Abs(off), Set(static_cast<float>(kLensError))), Gt(slope, Zero()));
        return angle;
      }

      angle = Sub(angle, Div(off, slope));
    }
  }

  HWY_INLINE V3 Fisheye(VF x, VF y, MF& seen) const {
    const FloatTag d;
    const VF radius = Sqrt(MulThenAdd(x, x, Mul(y, y)));
    VF angle = FisheyeAngle(radius, seen);

    // Nothing is seen outside the image circle.
    seen = And(seen, Le(angle, Set(static_cast<float>(camera_.limit))));
    angle = IfThenElseZero(seen, angle);
    const VF divisor = Max(radius, Set(1e-30f));
    const VF across = Div(hn::Sin(d, angle), divisor);
    return {Mul(x, across), Mul(y, across), hn::Cos(d, angle)};
  }

  HWY_INLINE static V3 Towards(VF azimuth, VF elevation) {
    const FloatTag d;
    const VF level = hn::Cos(d, elevation);
    return {Mul(hn::Sin(d, azimuth), level), hn::Sin(d, elevation),
            Mul(hn::Cos(d, azimuth), level)};
  }

  // Returns radians. The table is stretched over `pixels` pixels; `at` counts them from the center.
  HWY_INLINE static VF Entry(const std::vector<float>& degrees, VF at, int pixels) {
    const FloatTag d;
    const IntTag di;
    const int last = static_cast<int>(degrees.size()) - 1;
    const auto scale = static_cast<float>(static_cast<double>(degrees.size()) / pixels);

    // Entries stand for the centers of equal spans of pixels; the first and the last one hold
    // beyond them.
    const VF pixel = Add(at, Set(static_cast<float>(pixels) / 2));
    VF place = MulThenSub(pixel, Set(scale), Set(0.5f));
    place = Min(Max(place, Zero()), Set(static_cast<float>(last)));

    const VI before = ConvertTo(di, place);
    const VI after = Min(Add(before, Set(1)), Set(last));
    const VF a = GatherIndex(d, degrees.data(), before);
    const VF b = GatherIndex(d, degrees.data(), after);
    const VF share = Sub(place, ConvertTo(d, before));

    constexpr float kRadians = 0.0174532925f;
    return Mul(MulThenAdd(Sub(b, a), share, a), Set(kRadians));
  }

  const CameraFrame& camera_;
  std::array<float, 8> distortion_{};
};

// Returns the start and the axes of each view of the frame, twelve numbers each.
std::array<float, 72> ViewNumbers(const CameraFrame& camera) {
  std::array<float, 72> numbers{};
  float* to = numbers.data();
  for (const CameraView& view : camera.views) {
    for (const Vec3d& v : {camera.eye + view.aside, view.forward, view.right, view.up}) {
      for (int i = 0; i < 3; ++i) *to++ = static_cast<float>(v[i]);
    }
  }
  return numbers;
}

// Takes a place in the picture to its place in a view, whose number it returns.
HWY_INLINE VI ViewAt(VI& place, int size, int count) {
  const FloatTag d;
  const IntTag di;
  const VF number = Div(ConvertTo(d, place), Set(static_cast<float>(size)));
  const VI whole = Min(ConvertTo(di, number), Set(count - 1));
  place = Sub(place, Mul(whole, Set(size)));
  return whole;
}

void GenerateRays(Chunk& c) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;

  const CameraFrame& camera = c.frame->camera;
  const RayColumns rays = c.rays;
  const uint32_t* const pixels = c.pixels.data() + c.first;
  const size_t n = c.n;
  const auto firstSlot = static_cast<uint32_t>(c.first);
  const uint32_t sampleNumber = c.sampleNumber, seed = c.frame->seed;

  const bool media = c.has(Feature::transmission), cones = c.has(Feature::cones);
  const bool streams = c.has(Feature::streams);

  // All lanes share these unless the picture consists of several views.
  V3 eye = Broadcast3(Vec3f(camera.eye)), forward = Broadcast3(Vec3f(camera.forward));
  V3 right = Broadcast3(Vec3f(camera.right)), up = Broadcast3(Vec3f(camera.up));
  const auto coneWidth = static_cast<float>(pixelCone(camera).width);

  // Whole pixels minus half the size are exact in float; the sample's place is added last.
  const VF shiftX = Set(c.sample.x), shiftY = Set(c.sample.y);
  const VF centerX = Set(static_cast<float>(camera.centerX));
  const VF centerY = Set(static_cast<float>(camera.centerY));
  const VF skew = Set(static_cast<float>(camera.skew));

  // Projections bend rays along the unit vectors of right and up.
  const VF widthOfPixel = Set(static_cast<float>(1 / length(camera.right)));
  const VF heightOfPixel = Set(static_cast<float>(1 / length(camera.up)));
  const Projector projector(camera);

  const std::array<float, 72> views = ViewNumbers(camera);
  const int columns = camera.viewColumns, rows = camera.viewRows;
  const bool isStraight = camera.isStraight();
  const VF one = Set(1.0f);

  const Lens lens(camera);
  const bool hasLens = camera.aperture > 0;
  const LobeSampling ofLens = lensSampling(sampleNumber);

  const bool eyesTurn = camera.turning > 0;
  const V3 turnRight = Broadcast3(Vec3f(normalized(camera.right) * camera.turning));
  const V3 turnForward = Broadcast3(Vec3f(camera.forward * camera.turning));
  VF side = one;

  for (size_t i = 0; i < n; i += Lanes(d)) {
    const VU packed = LoadU(du, pixels + i);
    VI px = BitCast(di, And(packed, Set(0xFFFFu)));
    VI py = BitCast(di, ShiftRight<16>(packed));

    // In a stereo pair or a cube map the pixel belongs to one of the views.
    if (!camera.views.empty()) {
      const VI row = ViewAt(py, camera.viewHeight, rows);
      const VI column = ViewAt(px, camera.viewWidth, columns);
      const VI view = Add(Mul(row, Set(columns)), column);

      // The left eye has the first view.
      const MF isLeft = RebindMask(d, Eq(view, Zero(di)));
      side = IfThenElse(isLeft, Neg(one), one);

      VI at = Mul(view, Set(12));
      for (V3* v : {&eye, &forward, &right, &up}) {
        for (VF* to : {&v->x, &v->y, &v->z}) {
          *to = GatherIndex(d, views.data(), at);
          at = Add(at, Set(1));
        }
      }
    }

    // The place counts pixels right of and above the principal point.
    VF x = Add(Sub(ConvertTo(d, px), centerX), shiftX);
    const VF y = Sub(Sub(centerY, ConvertTo(d, py)), shiftY);
    x = MulThenAdd(skew, y, x);

    // Orthographic rays differ in their starts, all others in their directions.
    MF seen = Eq(x, x);
    V3 origin = eye, direction = forward;
    if (camera.orthographic) {
      origin = MulAdd3(right, x, MulAdd3(up, y, eye));
    } else if (isStraight) {
      direction = MulAdd3(right, x, MulAdd3(up, y, forward));
    } else {
      const V3 along = projector.Bend(x, y, seen);
      direction = MulAdd3(right, Mul(along.x, widthOfPixel), Scale3(forward, along.z));
      direction = MulAdd3(up, Mul(along.y, heightOfPixel), direction);
    }

    // Omni-directional stereo (Google 2015, "Rendering omni-directional stereo content"): the eyes
    // stand on the tangent to the circle where the azimuth meets it.
    if (eyesTurn) {
      const VF azimuth = projector.Azimuth(x);
      const VF back = Neg(Mul(hn::Sin(d, azimuth), side));
      origin = MulAdd3(turnRight, Mul(hn::Cos(d, azimuth), side), origin);
      origin = MulAdd3(turnForward, back, origin);
    }

    if (hasLens) {
      const VU path = StreamOfPixel(packed, sampleNumber, seed);
      lens.Bend(DiskPointsOf(SaltedPoints(path, ofLens, kLensSalt, 0)), origin, direction);
    }

    // A ray that sees nothing has the direction 0.
    if (hasLens || !camera.orthographic) direction = Normalize3(direction);
    if (!isStraight) direction = Select3(seen, direction, Broadcast3(Vec3f()));

    Store3(origin, rays.org, i);
    Store3(direction, rays.dir, i);

    // A primary ray has the weight 1, and its parent is the slot of its pixel.
    Store3({one, one, one}, rays.weight, i);
    Store(one, rays.throughput, i);
    Store(hn::Iota(du, firstSlot + static_cast<uint32_t>(i)), rays.parent, i);

    if (media) Store(Set(camera.media), rays.media, i);
    if (cones) Store(Set(coneWidth), rays.cone, i);
    if (streams) Store(StreamOfPixel(packed, sampleNumber, seed), rays.path, i);
  }
}

}  // namespace whit::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace whit::simd {
WHIT_EXPORT_KERNEL(GenerateRays)
}  // namespace whit::simd
#endif
