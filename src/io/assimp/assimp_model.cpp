#include "io/assimp/assimp_model.h"

#ifdef WHIT_ASSIMP
#include <assimp/GltfMaterial.h>
#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/confined.h"
#include "io/model.h"
#include "io/smooth_normals.h"

namespace whit {

#ifdef WHIT_ASSIMP

namespace {

constexpr int kConversionSeconds = 60;

// The following functions run in the child, up to convert().

// STL stores only the normals of facets, which repeat the geometry, and the library smooths 3DS
// files without groups across all edges. The normals of both formats are computed anew.
const aiScene* importScene(const std::string& bytes, const std::string& extension) {
  aiPropertyStore* const settings = aiCreatePropertyStore();
  aiSetImportPropertyFloat(settings, AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothestDegrees);
  aiSetImportPropertyInteger(settings, AI_CONFIG_PP_SBP_REMOVE,
                             aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  aiSetImportPropertyInteger(settings, AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
  aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, 0);
  aiSetImportPropertyInteger(settings, AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);

  const bool bare = extension == ".stl" || extension == ".3ds";
  return aiImportFileFromMemoryWithProperties(bytes.data(), static_cast<unsigned>(bytes.size()),
                                              bare ? aiProcess_RemoveComponent : 0u,
                                              extension.c_str() + 1, settings);
}

template <typename T>
void copyCorners(const std::vector<unsigned>& vertices, T*& values) {
  if (!values) return;
  T* const own = new T[vertices.size()];
  for (const auto i : indices(vertices)) own[i] = values[vertices[i]];
  values = own;
}

// Gives each corner of the mesh's faces a vertex of its own, without which it has no normal of its
// own. The replaced arrays are not freed: they live until the child process ends.
void separateCorners(aiMesh& mesh) {
  // A corner's new index is its place in `vertices`, which holds the vertex that the corner copies.
  std::vector<unsigned> vertices;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    for (unsigned k = 0; k < mesh.mFaces[i].mNumIndices; ++k) {
      unsigned& index = mesh.mFaces[i].mIndices[k];
      vertices.push_back(std::exchange(index, static_cast<unsigned>(vertices.size())));
    }
  }

  mesh.mNumVertices = static_cast<unsigned>(vertices.size());
  copyCorners(vertices, mesh.mVertices);
  copyCorners(vertices, mesh.mColors[0]);
  for (aiVector3D*& uvs : mesh.mTextureCoords) copyCorners(vertices, uvs);
}

bool isFinite(const aiVector3D& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Returns how many faces it leaves out because of their corners, before the library joins those
// with others.
std::uint32_t leaveOutBadFaces(aiMesh& mesh) {
  const auto isBad = [&](const aiFace& face) {
    return std::any_of(face.mIndices, face.mIndices + face.mNumIndices, [&](unsigned vertex) {
      return vertex >= mesh.mNumVertices || !isFinite(mesh.mVertices[vertex]);
    });
  };

  aiFace* const end = mesh.mFaces + mesh.mNumFaces;
  const auto left = static_cast<std::uint32_t>(end - std::remove_if(mesh.mFaces, end, isBad));
  mesh.mNumFaces -= left;
  return left;
}

// Makes a mesh without faces a point. The library leaves points out, but crashes where a mesh has
// no vertices.
void makePoint(aiMesh& mesh) {
  mesh.mVertices = new aiVector3D[1];
  mesh.mFaces = new aiFace[1];
  mesh.mFaces[0].mIndices = new unsigned[1]{0};
  mesh.mFaces[0].mNumIndices = 1;
  mesh.mNumVertices = mesh.mNumFaces = 1;
  mesh.mPrimitiveTypes = aiPrimitiveType_POINT;
}

// JSON has neither numbers that are not finite nor text that is not UTF-8. Positions that are not
// finite belong to no face.
void makeFinite(aiMesh& mesh) {
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    if (!isFinite(mesh.mVertices[i])) mesh.mVertices[i] = {};
    if (mesh.mNormals && !isFinite(mesh.mNormals[i])) mesh.mNormals[i] = {};
    for (aiVector3D* const uvs : mesh.mTextureCoords) {
      if (uvs && !isFinite(uvs[i])) uvs[i] = {};
    }
  }
}

void makePrintable(aiString& name) { name.Set(printable(name.C_Str())); }

void makePrintable(aiNode& node) {
  makePrintable(node.mName);
  for (unsigned i = 0; i < node.mNumChildren; ++i) makePrintable(*node.mChildren[i]);
}

// These formats mean colors of vertices as the screen shows them, and glTF has linear ones. Files
// of OFF may have codes up to 255.
void makeLinear(aiMesh& mesh) {
  if (!mesh.mColors[0]) return;
  const std::span<aiColor4D> colors(mesh.mColors[0], mesh.mNumVertices);
  float largest = 0;
  for (const aiColor4D& c : colors) largest = std::max({largest, c.r, c.g, c.b});

  const double white = largest > kLargestColor ? 255 : 1;
  const auto linear = [white](float x) {
    return x > 0 ? static_cast<float>(srgbToLinear(std::min(x / white, 1.0))) : 0.0f;
  };
  for (aiColor4D& c : colors) c = {linear(c.r), linear(c.g), linear(c.b), c.a};
}

// Replaces a member of the material.
template <typename Value>
void setMember(aiMaterial& material, const Value& value, const char* key, unsigned type,
               unsigned index) {
  material.RemoveProperty(key, type, index);
  if constexpr (std::is_same_v<Value, aiString>) {
    material.AddProperty(&value, key, type, index);
  } else {
    material.AddProperty(&value, 1, key, type, index);
  }
}

bool hasMap(const aiMaterial& material, aiTextureType type) {
  return material.GetTextureCount(type) > 0;
}

// Replaces the factors of the surface by those that glTF has. Faces have two sides in these
// formats.
void convertFactors(aiMaterial& material, std::uint32_t& notes) {
  setMember(material, 1, AI_MATKEY_TWOSIDED);

  // The exponent n of Blinn's lobe corresponds to roughness^2 = sqrt(2 / (n + 2)), as in MTL files.
  float shininess = 0, roughness = 0, opacity = 1;
  material.Get(AI_MATKEY_SHININESS, shininess);
  if (material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) != aiReturn_SUCCESS) {
    const float exponent = std::isfinite(shininess) ? std::max(shininess, 0.0f) : 0.0f;
    setMember(material, std::pow(2 / (exponent + 2), 0.25f), AI_MATKEY_ROUGHNESS_FACTOR);
  }

  // The strength of highlights is no reflectance, and an index of refraction is often 1 in opaque
  // materials.
  material.RemoveProperty(AI_MATKEY_COLOR_SPECULAR);
  material.RemoveProperty(AI_MATKEY_SPECULAR_FACTOR);
  material.RemoveProperty(AI_MATKEY_GLOSSINESS_FACTOR);
  material.RemoveProperty(AI_MATKEY_SHININESS);
  material.RemoveProperty(AI_MATKEY_REFRACTI);

  // Exporters disagree on whether 0 or 1 is opaque.
  material.Get(AI_MATKEY_OPACITY, opacity);
  if (!(opacity > 0)) {
    setMember(material, 1.0f, AI_MATKEY_OPACITY);
    notes |= kMadeOpaque;
  }
}

// A diffuse map replaces the color, and its alpha counts if it is named as the map of opacity, too.
// Backslashes separate folders in files that were written on Windows.
void convertMaps(aiMaterial& material, std::uint32_t& notes) {
  constexpr aiTextureType kKept[] = {aiTextureType_DIFFUSE,           aiTextureType_BASE_COLOR,
                                     aiTextureType_NORMALS,           aiTextureType_EMISSIVE,
                                     aiTextureType_LIGHTMAP,          aiTextureType_METALNESS,
                                     aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_UNKNOWN};

  aiString opacity, diffuse;
  material.GetTexture(aiTextureType_OPACITY, 0, &opacity);
  material.GetTexture(aiTextureType_DIFFUSE, 0, &diffuse);
  const bool byAlpha = opacity.length > 0 && opacity == diffuse;
  if (byAlpha) setMember(material, aiString("BLEND"), AI_MATKEY_GLTF_ALPHAMODE);
  if (diffuse.length > 0) setMember(material, aiColor4D(1, 1, 1, 1), AI_MATKEY_COLOR_DIFFUSE);

  for (unsigned type = aiTextureType_DIFFUSE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    const auto kind = static_cast<aiTextureType>(type);
    const bool isKept = contains(kKept, kind) || (kind == aiTextureType_OPACITY && byAlpha);
    if (hasMap(material, kind) && !isKept) notes |= kMapLeftOut;

    for (unsigned i = 0; i < material.GetTextureCount(kind); ++i) {
      aiString path;
      material.GetTexture(kind, i, &path);
      std::replace(path.data, path.data + path.length, '\\', '/');
      makePrintable(path);
      setMember(material, path, AI_MATKEY_TEXTURE(type, i));
    }
  }
}

// Surfaces that a Collada file calls constant send out their emission and reflect no light.
void leaveOutReflection(aiMaterial& material) {
  setMember(material, aiColor4D(0, 0, 0, 1), AI_MATKEY_COLOR_DIFFUSE);
  setMember(material, 1.0f, AI_MATKEY_REFRACTI);
}

// True if the library made the material up for meshes without one. STL and OFF files have none.
// Materials of the other files may have its name, but hardly its gray.
bool isMadeUp(const aiMaterial& material, const std::string& extension) {
  if (extension == ".stl" || extension == ".off") return true;

  constexpr float kGrays[] = {0.6f, 0.8f};  // the reader of FBX has a gray of its own
  aiString name;
  aiColor3D color(kGrays[0]);  // stays if the material has no color
  material.Get(AI_MATKEY_NAME, name);
  material.Get(AI_MATKEY_COLOR_DIFFUSE, color);

  return name == aiString(AI_DEFAULT_MATERIAL_NAME) && contains(kGrays, color.r) &&
         color == aiColor3D(color.r) && !hasMap(material, aiTextureType_DIFFUSE) &&
         !hasMap(material, aiTextureType_BASE_COLOR);
}

// Meshes without a material get that of models without materials.
void makeDefaultMaterial(const aiScene& scene, unsigned index) {
  const auto isColored = [&](const aiMesh* mesh) {
    return mesh->mMaterialIndex == index && mesh->mColors[0];
  };
  const bool colored = std::any_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes, isColored);

  // Colors of vertices multiply the material's color, so that meshes which have them get white.
  const float gray = colored ? 1 : kModelGray;
  aiMaterial& material = *scene.mMaterials[index];
  setMember(material, aiString(kNoMaterialName), AI_MATKEY_NAME);
  setMember(material, aiColor4D(gray, gray, gray, 1), AI_MATKEY_COLOR_DIFFUSE);
}

void convertMaterials(const aiScene& scene, const std::string& extension, std::uint32_t& notes) {
  for (unsigned i = 0; i < scene.mNumMaterials; ++i) {
    aiMaterial& material = *scene.mMaterials[i];
    int shading = 0;
    material.Get(AI_MATKEY_SHADING_MODEL, shading);
    convertFactors(material, notes);
    // The reader of 3DS takes shading that it does not know for none.
    if (shading == aiShadingMode_NoShading && extension == ".dae") leaveOutReflection(material);
    convertMaps(material, notes);

    aiString name;
    material.Get(AI_MATKEY_NAME, name);
    makePrintable(name);
    setMember(material, name, AI_MATKEY_NAME);
    if (isMadeUp(material, extension)) makeDefaultMaterial(scene, i);
  }
}

// A skin depends on the pose in which it was bound, which writers of these formats and the library
// understand in several ways. The mesh therefore stays in its rest pose.
void leaveOutSkins(aiScene& scene, std::uint32_t& notes) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i]->mNumBones > 0) notes |= kSkinLeftOut;
    scene.mMeshes[i]->mNumBones = 0;
  }

  if ((notes & kSkinLeftOut) != 0) scene.mNumAnimations = 0;
}

// FBX files name the axis that is up in them. From version 5.4 on the library turns them itself,
// but flattens those that do not name all axes.
void turnUp(aiScene& scene) {
  int up = 1;
  aiMatrix4x4& root = scene.mRootNode->mTransformation;
  const bool isTurned = !root.IsIdentity() && root.Determinant() != 0;
  if (isTurned || !scene.mMetaData || !scene.mMetaData->Get("UpAxis", up) || up == 1) return;

  // Each matrix rotates the axis that is up to y.
  const aiMatrix4x4 fromZ(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
  const aiMatrix4x4 fromX(0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  root = up == 2 ? fromZ : fromX;
}

// Where an OFF file has no such vertex, the library takes the last one and only logs it.
void noteLog(const char* message, char* isMended) {
  if (std::strstr(message, "ertex index is out of range")) *isMended = 1;
}

// Converts the model and writes the answer: a 1, the notes, the number of faces left out and the
// GLB, or a 0 and the library's error message.
void convert(const std::string& bytes, const std::string& extension, const ConfinedWriter& write) {
  const auto fail = [&](const std::string& why) {
    const char failed = 0;
    write(&failed, 1);
    write(why.data(), why.size());
  };

  char isMended = 0;
  const aiLogStream log{noteLog, &isMended};
  aiAttachLogStream(&log);

  const aiScene* imported = importScene(bytes, extension);
  if (!imported) {
    fail(aiGetErrorString());
    return;
  }

  std::uint32_t badFaces = 0;
  bool hasFaces = false;
  for (unsigned i = 0; i < imported->mNumMeshes; ++i) {
    aiMesh& mesh = *imported->mMeshes[i];
    badFaces += leaveOutBadFaces(mesh);
    hasFaces = hasFaces || mesh.mNumFaces > 0;
    if (mesh.mNumFaces == 0) makePoint(mesh);
    if (!mesh.mNormals && mesh.mNumAnimMeshes + mesh.mNumBones == 0) separateCorners(mesh);
    std::ranges::fill(mesh.mNumUVComponents, 2u);  // glTF has no more; 3ds Max writes three
  }
  if (!hasFaces) {
    fail("it has no faces");
    return;
  }

  // Normals are smoothed before the polygons are split, so that each polygon counts once and not
  // once for each of its triangles.
  constexpr unsigned kFinish =
      aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;
  imported = aiApplyPostProcessing(imported, aiProcess_GenSmoothNormals);
  if (imported) imported = aiApplyPostProcessing(imported, kFinish);

  if (!imported) {
    fail(aiGetErrorString());
    return;
  }
  if (imported->mNumMeshes == 0 || !imported->mRootNode) {
    fail("it has no faces");
    return;
  }

  // The scene is adapted to what glTF can express; `notes` records what is lost.
  auto& scene = *const_cast<aiScene*>(imported);
  std::uint32_t notes = scene.mNumLights + scene.mNumCameras > 0 ? kViewLeftOut : 0u;
  if (isMended != 0) notes |= kIndexMended;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    makeFinite(*scene.mMeshes[i]);
    makeLinear(*scene.mMeshes[i]);
    makePrintable(scene.mMeshes[i]->mName);
  }

  makePrintable(*scene.mRootNode);
  convertMaterials(scene, extension, notes);
  leaveOutSkins(scene, notes);
  turnUp(scene);

  const aiExportDataBlob* const blob = aiExportSceneToBlob(&scene, "glb2", 0);
  if (!blob) {
    fail(aiGetErrorString());
    return;
  }
  write("\1", 1);
  write(&notes, sizeof notes);
  write(&badFaces, sizeof badFaces);
  write(blob->data, blob->size);
}

}  // namespace

ConvertedModel convertByAssimp(const std::string& file, const std::string& bytes,
                               std::uint64_t mostBytes) {
  if (bytes.empty()) return {"", "it is empty"};
  if (bytes.size() > std::numeric_limits<unsigned>::max()) {
    return {"", "it has more than 2^32 - 1 bytes"};
  }

  const ConfinedAnswer answer = runConfined(
      file,
      [&, extension = extensionOf(file)](const ConfinedWriter& write) {
        convert(bytes, extension, write);
      },
      mostBytes, kConversionSeconds);

  // The answer has the form in which convert() writes it.
  ConvertedModel model;
  const std::string& reply = answer.bytes;
  constexpr std::size_t kHead = 1 + sizeof model.notes + sizeof model.badFaces;
  if (!answer.failure.empty()) {
    model.failure = answer.failure;
  } else if (reply.size() < kHead || reply[0] != 1) {
    model.failure =
        reply.empty() ? "its reader gave no answer" : "it reports: " + excerpt(reply.substr(1));
  } else {
    std::memcpy(&model.notes, reply.data() + 1, sizeof model.notes);
    std::memcpy(&model.badFaces, reply.data() + 1 + sizeof model.notes, sizeof model.badFaces);
    model.glb = reply.substr(kHead);
  }

  return model;
}

#else

ConvertedModel convertByAssimp(const std::string&, const std::string&, std::uint64_t) {
  return {"", "this whit was built without libassimp-dev"};
}

#endif

namespace {

// True if a face of an OFF file has numbers behind its corners, which are a color. The library
// reads those of vertices alone.
bool hasColoredFaces(const std::string& bytes) {
  std::istringstream text(bytes);
  std::size_t vertices = 0, faces = 0;
  bool isHeaderRead = false;

  for (std::string line; std::getline(text, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    std::istringstream words(line);
    const std::vector<std::string> all(std::istream_iterator<std::string>(words), {});
    const bool isKeyword = !isHeaderRead && !all.empty() && all[0].ends_with("OFF");
    if (all.empty() || (isKeyword && all.size() == 1)) continue;

    const std::size_t first = isKeyword ? 1 : 0;
    const auto number = [&](std::size_t i) {
      return i < all.size() ? std::strtoull(all[i].c_str(), nullptr, 10) : 0;
    };
    if (!isHeaderRead) {
      vertices = number(first);
      faces = number(first + 1);
      isHeaderRead = true;
    } else if (vertices > 0) {
      --vertices;
    } else if (faces-- == 0) {
      break;
    } else if (all.size() > number(0) + 1) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::unique_ptr<Model> openByAssimp(const ModelSource& source) {
  const std::string file = source.path.string();
  const std::string bytes = readFile(source.path, source.budget.left() / 2);
  const MemoryHold hold(&source.budget, bytes.size(), 1, file);

  // A damaged file can make the library take any amount of memory. A sound one takes little
  // compared with its size.
  const std::uint64_t most = (512 + bytes.size() / 2048) << 20;
  const ConvertedModel model =
      convertByAssimp(file, bytes, std::min(most, source.budget.left() / 2));

  if (!model.failure.empty()) {
    throwBadScene(file, "expected a model that the library assimp can read, but " + model.failure);
  }

  constexpr std::pair<AssimpNote, const char*> kNotes[] = {
      {kSkinLeftOut, "skins and animations of a rigged model left out: it is shown at rest"},
      {kViewLeftOut, "cameras and lights of a model left out"},
      {kMapLeftOut, "map of a kind that is not read from such files left out"},
      {kMadeOpaque, "material that the file calls invisible made opaque"},
      {kIndexMended, "vertex index out of range replaced by the last vertex"}};
  for (const auto& [bit, text] : kNotes) {
    if ((model.notes & bit) != 0) source.warnings.add(text, file);
  }
  if (extensionOf(source.path) == ".off" && hasColoredFaces(bytes)) {
    source.warnings.add("colors of faces left out", file);
  }
  source.warnings.add("face with a corner that is not finite or not there left out", file,
                      model.badFaces);

  return openGltf(source, model.glb);
}

}  // namespace whit
