#include "io/model.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "io/files.h"

namespace whit {
namespace {

using Opener = std::unique_ptr<Model> (*)(const ModelSource&);

std::unique_ptr<Model> openGltfFile(const ModelSource& source) { return openGltf(source); }

const std::map<std::string, Opener> kOpeners = {
    {".3ds", openByAssimp},  {".dae", openByAssimp}, {".fbx", openByAssimp}, {".glb", openGltfFile},
    {".gltf", openGltfFile}, {".obj", openObj},      {".off", openByAssimp}, {".ply", openPly},
    {".stl", openByAssimp},  {".vrm", openGltfFile}};

Opener openerOf(const std::filesystem::path& path) {
  const auto found = kOpeners.find(extensionOf(path));
  return found == kOpeners.end() ? nullptr : found->second;
}

// Turns the faces whose winding opposes the vertex normals at all three corners. The side of the
// normals is the front, and shading takes that of the winding.
void turnToNormals(Mesh& mesh) {
  if (mesh.normals.empty()) return;
  for (auto& t : mesh.triangles) {
    const auto at = [&](std::size_t corner) { return Vec3d(mesh.positions[t[corner]]); };
    const Vec3d winding = cross(at(1) - at(0), at(2) - at(0));
    const bool opposes = std::ranges::all_of(
        t, [&](std::uint32_t v) { return dot(winding, Vec3d(mesh.normals[v])) < 0; });
    if (opposes) std::swap(t[1], t[2]);
  }
}

}  // namespace

bool isModelFile(const std::filesystem::path& path) { return openerOf(path) != nullptr; }

std::string modelExtensions() { return joined(keysOf(kOpeners)); }

std::unique_ptr<Model> openModel(const ModelSource& source) {
  return openerOf(source.path)(source);
}

Body MeshModel::content(SceneLayout&, const std::vector<std::uint32_t>& materials) {
  Body body;
  if (mesh_.triangles.empty()) return body;
  turnToNormals(mesh_);
  addParts({mesh_}, materials, source_.path.string(), source_.budget, body);
  if (origin_ != Vec3d()) body.placements.front().toParent = Affine::translation(origin_);
  return body;
}

void warnNothingToDraw(const std::string& why, const std::string& file, Warnings& warnings) {
  // Readers of text skip lines that they do not know, so a file of another format seems empty.
  static const std::map<std::string, std::string> kBeginnings{
      {"glTF", ".glb"},  {"Kaydara", ".fbx"}, {"ply", ".ply"},
      {"solid", ".stl"}, {"{", ".gltf"},      {"PK\x03\x04", ".zip"}};
  const std::string found = readBeginning(file, 8), own = extensionOf(file);
  for (const auto& [beginning, extension] : kBeginnings) {
    if (extension == own || !found.starts_with(beginning)) continue;
    throwBadScene(file, "expected the content of a " + own + " file, found that of a " + extension +
                            " file: rename or convert it");
  }

  warnings.add("model with nothing to draw: " + why, file);
}

void appendCopy(std::uint32_t vertex, Mesh& mesh) {
  const auto append = [&](auto& values) {
    if (!values.empty()) values.push_back(values[vertex]);
  };
  append(mesh.positions);
  append(mesh.normals);
  append(mesh.uvs);
  append(mesh.colors);
}

void addParts(std::vector<Mesh> meshes, const std::vector<std::uint32_t>& materials,
              const std::string& file, MemoryBudget& budget, Body& to) {
  for (Mesh& mesh : meshes) {
    budget.charge(1, bytesOf(mesh), file);
    for (std::uint32_t& material : mesh.materials) material = materials[material];
    to.addMesh(std::move(mesh));
  }
}

}  // namespace whit
