// Time of OSPRay's frames of an OBJ model, for tests/bench/peers.py.
//   ospray_frames MODEL.obj WIDTH HEIGHT RENDERER FRAMES PICTURE.ppm eye at fov light...
// RENDERER is scivis (one sample, shadow rays, no ambient occlusion) or pathtracer. Vectors are
// x,y,z; fov is vertical, in degrees; a light is x,y,z,r,g,b with its radiant intensity. The
// model's triangles have one gray material. Prints the milliseconds of each frame, a line each,
// after one that is not counted.
#include <ospray/ospray_util.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Triangles {
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;
};

// Reads positions and polygons, which become fans, and passes over everything else.
Triangles readObj(const char* path) {
  Triangles mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;

    if (word == "v") {
      for (float x; words >> x;) mesh.positions.push_back(x);
    } else if (word == "f") {
      std::vector<std::uint32_t> polygon;
      // Negative numbers of vertices count back from the last one.
      const auto vertices = static_cast<long>(mesh.positions.size() / 3);
      while (words >> word) {
        const long number = std::strtol(word.c_str(), nullptr, 10);
        polygon.push_back(static_cast<std::uint32_t>(number > 0 ? number - 1 : vertices + number));
      }
      for (std::size_t i = 2; i < polygon.size(); ++i) {
        mesh.corners.insert(mesh.corners.end(), {polygon[0], polygon[i - 1], polygon[i]});
      }
    }
  }
  return mesh;
}

std::vector<float> numbersOf(const char* text) {
  std::vector<float> numbers;
  std::istringstream stream(text);
  for (std::string number; std::getline(stream, number, ',');) numbers.push_back(std::stof(number));
  return numbers;
}

template <typename... Objects>
void commitAll(Objects... objects) {
  (ospCommit(objects), ...);
}

OSPData dataOf(std::vector<OSPObject> objects, OSPDataType type) {
  const OSPData shared = ospNewSharedData1D(objects.data(), type, objects.size());
  const OSPData copy = ospNewData1D(type, objects.size());
  ospCopyData1D(shared, copy, 0);
  commitAll(shared, copy);
  return copy;
}

OSPWorld makeWorld(const Triangles& mesh, char** lightTexts, int lightCount) {
  const OSPGeometry geometry = ospNewGeometry("mesh");
  const OSPData positions =
      ospNewSharedData1D(mesh.positions.data(), OSP_VEC3F, mesh.positions.size() / 3);
  const OSPData corners =
      ospNewSharedData1D(mesh.corners.data(), OSP_VEC3UI, mesh.corners.size() / 3);
  commitAll(positions, corners);
  ospSetObject(geometry, "vertex.position", positions);
  ospSetObject(geometry, "index", corners);

  const OSPMaterial material = ospNewMaterial("obj");
  ospSetVec3f(material, "kd", 0.6f, 0.6f, 0.6f);
  const OSPGeometricModel model = ospNewGeometricModel(geometry);
  ospSetObject(model, "material", material);
  commitAll(geometry, material, model);

  const OSPGroup group = ospNewGroup();
  ospSetObject(group, "geometry", dataOf({model}, OSP_GEOMETRIC_MODEL));
  ospCommit(group);
  const OSPInstance instance = ospNewInstance(group);
  ospCommit(instance);

  std::vector<OSPObject> lights;
  for (int i = 0; i < lightCount; ++i) {
    const std::vector<float> values = numbersOf(lightTexts[i]);
    const OSPLight light = ospNewLight("sphere");
    ospSetVec3f(light, "position", values.at(0), values.at(1), values.at(2));
    ospSetVec3f(light, "color", values.at(3), values.at(4), values.at(5));
    ospSetInt(light, "intensityQuantity", OSP_INTENSITY_QUANTITY_INTENSITY);
    ospSetFloat(light, "radius", 0);
    ospCommit(light);
    lights.push_back(light);
  }

  const OSPWorld world = ospNewWorld();
  ospSetObject(world, "instance", dataOf({instance}, OSP_INSTANCE));
  ospSetObject(world, "light", dataOf(lights, OSP_LIGHT));
  ospCommit(world);
  return world;
}

OSPCamera makeCamera(const char* eyeText, const char* atText, const char* fov, float aspect) {
  const std::vector<float> eye = numbersOf(eyeText), at = numbersOf(atText);
  const OSPCamera camera = ospNewCamera("perspective");
  ospSetVec3f(camera, "position", eye.at(0), eye.at(1), eye.at(2));
  ospSetVec3f(camera, "direction", at.at(0) - eye[0], at.at(1) - eye[1], at.at(2) - eye[2]);
  ospSetVec3f(camera, "up", 0, 1, 0);
  ospSetFloat(camera, "fovy", std::stof(fov));
  ospSetFloat(camera, "aspect", aspect);
  ospCommit(camera);
  return camera;
}

void writePicture(OSPFrameBuffer frame, int width, int height, const char* path) {
  const auto* pixels = static_cast<const std::uint8_t*>(ospMapFrameBuffer(frame, OSP_FB_COLOR));
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << width << " " << height << "\n255\n";

  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      file.write(reinterpret_cast<const char*>(pixels + 4 * (y * width + x)), 3);
    }
  }
  ospUnmapFrameBuffer(pixels, frame);
}

}  // namespace

int main(int argc, const char** argv) {
  if (argc < 11) return 2;
  const OSPError error = ospInit(&argc, argv);
  if (error != OSP_NO_ERROR) {
    std::fprintf(stderr, "OSPRay does not start: error %d\n", static_cast<int>(error));
    return 1;
  }

  const int width = std::atoi(argv[2]), height = std::atoi(argv[3]);
  const Triangles mesh = readObj(argv[1]);
  const OSPWorld world = makeWorld(mesh, const_cast<char**>(argv) + 10, argc - 10);
  const OSPCamera camera =
      makeCamera(argv[7], argv[8], argv[9], static_cast<float>(width) / static_cast<float>(height));

  const OSPRenderer renderer = ospNewRenderer(argv[4]);
  ospSetInt(renderer, "pixelSamples", 1);
  ospSetBool(renderer, "shadows", 1);
  ospSetInt(renderer, "aoSamples", 0);
  ospCommit(renderer);
  const OSPFrameBuffer frame = ospNewFrameBuffer(width, height, OSP_FB_SRGBA, OSP_FB_COLOR);
  ospCommit(frame);

  // Frame -1 warms up and is not counted.
  for (int i = -1; i < std::atoi(argv[5]); ++i) {
    ospResetAccumulation(frame);
    const auto start = std::chrono::steady_clock::now();
    ospWait(ospRenderFrame(frame, renderer, camera, world), OSP_TASK_FINISHED);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    if (i >= 0) std::printf("%.3f\n", taken.count());
  }

  writePicture(frame, width, height, argv[6]);
  std::fflush(stdout);
  std::_Exit(0);  // OSPRay 3.2 crashes when its tables of albedos are destroyed at exit
}
