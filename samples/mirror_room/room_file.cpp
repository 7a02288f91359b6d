#include "samples/mirror_room/room_file.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

// TinyGLTF as a part of this file, under a name of its own: libdraco.a, which froth_baker links, has parts of another
// version, and a linker takes one of two functions of one name.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf froth_tinygltf
#include <tiny_gltf.h>

namespace froth {
namespace {

constexpr double kGlossyBelow = 0.3;  // roughness
constexpr const char* kLights = "KHR_lights_punctual";

// Reads one file; what it does not know is an error that names the place.
class RoomReader {
 public:
  RoomReader(const std::filesystem::path& path, const tinygltf::Model& model) : path_(path), model_(model) {}

  Result<Room> read();

 private:
  Status readNode(const tinygltf::Node& node);
  Status readMesh(const tinygltf::Mesh& mesh);
  Status readPart(const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive);
  void readMaterial(const tinygltf::Material& material);
  void readCamera(const RoomNode& node, double yfov);
  Status readSun(const tinygltf::Node& node, int light);
  Status findMirror();

  // The bytes of accessor `index`, `width` components of `type` per element; null if it is another one.
  const uint8_t* bytesOf(int index, int component, int type, size_t bytesPerElement) const;
  Status fail(const char* place, const std::string& name, const char* what) const {
    return makeError(ErrorKind::kBadInput, "%s: %s '%s': %s", path_.c_str(), place, name.c_str(), what);
  }

  const std::filesystem::path& path_;
  const tinygltf::Model& model_;
  Room room_;
  bool hasFoam_ = false, hasCentre_ = false, hasBall_ = false, hasCamera_ = false, hasSun_ = false;
};

Result<Room> RoomReader::read() {
  for (const tinygltf::Material& material : model_.materials) readMaterial(material);
  for (const tinygltf::Node& node : model_.nodes) {
    if (Status done = readNode(node); !done) return done.error();
  }
  const auto missing = [&](const char* what) {
    return makeError(ErrorKind::kBadInput, "%s: %s is missing; add it, as in samples/mirror_room/meshes/room.gltf",
                     path_.c_str(), what);
  };
  if (Status found = findMirror(); !found) return found.error();
  if (room_.mirror.normal == glm::dvec3(0)) return missing("a mirror (metal of roughness 0)");
  if (!hasFoam_) return missing("the node 'foam'");
  if (!hasCentre_) return missing("the node 'centre'");
  if (!hasBall_) return missing("the mesh node 'ball'");
  if (!hasCamera_) return missing("a perspective camera");
  if (!hasSun_) return missing("a directional light (KHR_lights_punctual)");
  return std::move(room_);
}

void RoomReader::readMaterial(const tinygltf::Material& material) {
  const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
  RoomMaterialInfo info;
  for (int i = 0; i < 3; ++i) info.colour[i] = static_cast<float>(pbr.baseColorFactor[static_cast<size_t>(i)]);
  info.roughness = static_cast<float>(pbr.roughnessFactor);
  if (pbr.roughnessFactor < kGlossyBelow) info.kind = MaterialKind::kGlossy;
  if (pbr.roughnessFactor == 0 && pbr.metallicFactor == 1) info.kind = MaterialKind::kMirror;
  room_.materials.push_back(info);
}

Status RoomReader::readNode(const tinygltf::Node& node) {
  if (!node.children.empty() || !node.matrix.empty()) {
    return fail("node", node.name, "has children or a matrix; give translation, rotation and scale");
  }
  RoomNode made;
  made.name = node.name;
  if (!node.translation.empty()) made.position = {node.translation[0], node.translation[1], node.translation[2]};
  if (!node.rotation.empty()) {
    made.rotation = glm::normalize(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
  }
  if (!node.scale.empty()) made.scale = node.scale[0];
  if (!node.scale.empty() && (node.scale[1] != made.scale || node.scale[2] != made.scale || !(made.scale > 0))) {
    return fail("node", node.name, "its scale is not one number > 0 for all axes");
  }
  if (made.name == "foam") {
    room_.foam = made;
    room_.isFoamFitted = !node.scale.empty();
    hasFoam_ = true;
  }
  if (made.name == "centre") {
    room_.centre = made;
    hasCentre_ = true;
  }
  if (node.camera >= 0) readCamera(made, model_.cameras[static_cast<size_t>(node.camera)].perspective.yfov);
  room_.nodes.push_back(made);
  const auto light = node.extensions.find(kLights);
  if (light != node.extensions.end()) {
    if (Status read = readSun(node, light->second.Get("light").GetNumberAsInt()); !read) return read;
  }
  if (node.mesh < 0) return {};
  if (made.name == "ball") {
    room_.ball = static_cast<uint32_t>(room_.nodes.size() - 1);
    hasBall_ = true;
  }
  return readMesh(model_.meshes[static_cast<size_t>(node.mesh)]);
}

void RoomReader::readCamera(const RoomNode& node, double yfov) {
  // A glTF camera looks along its -z with y up; ours along z with y down.
  const glm::dquat halfTurn(0, 1, 0, 0);
  room_.camera = {node.position, node.rotation * halfTurn, std::tan(0.5 * yfov)};
  hasCamera_ = true;
}

Status RoomReader::readSun(const tinygltf::Node& node, int index) {
  if (index < 0 || static_cast<size_t>(index) >= model_.lights.size()) {
    return fail("node", node.name, "names a light that is not there");
  }
  const tinygltf::Light& light = model_.lights[static_cast<size_t>(index)];
  if (light.type != "directional") return fail("light", light.name, "is not directional");
  room_.toSun = room_.nodes.back().rotation * glm::dvec3(0, 0, 1);
  for (int i = 0; i < 3; ++i) {
    const double share = light.color.size() == 3 ? light.color[static_cast<size_t>(i)] : 1.0;
    room_.sun[i] = static_cast<float>(light.intensity * share);
  }
  hasSun_ = true;
  return {};
}

Status RoomReader::readMesh(const tinygltf::Mesh& mesh) {
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    if (Status read = readPart(mesh, primitive); !read) return read;
  }
  return {};
}

const uint8_t* RoomReader::bytesOf(int index, int component, int type, size_t bytesPerElement) const {
  if (index < 0 || static_cast<size_t>(index) >= model_.accessors.size()) return nullptr;
  const tinygltf::Accessor& accessor = model_.accessors[static_cast<size_t>(index)];
  if (accessor.componentType != component || accessor.type != type || accessor.bufferView < 0) return nullptr;
  if (static_cast<size_t>(accessor.bufferView) >= model_.bufferViews.size()) return nullptr;
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<size_t>(accessor.bufferView)];
  if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model_.buffers.size() || view.byteStride != 0) {
    return nullptr;
  }
  const std::vector<unsigned char>& bytes = model_.buffers[static_cast<size_t>(view.buffer)].data;
  const size_t start = view.byteOffset + accessor.byteOffset;
  if (start > bytes.size() || accessor.count > (bytes.size() - start) / bytesPerElement) return nullptr;
  return bytes.data() + start;
}

Status RoomReader::readPart(const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive) {
  const auto accessorOf = [&](const char* attribute) {
    const auto found = primitive.attributes.find(attribute);
    return found == primitive.attributes.end() ? -1 : found->second;
  };
  const int positions = accessorOf("POSITION"), normals = accessorOf("NORMAL");
  const uint8_t* position = bytesOf(positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, sizeof(glm::vec3));
  const uint8_t* normal = bytesOf(normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, sizeof(glm::vec3));
  const uint8_t* index =
      bytesOf(primitive.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, sizeof(uint16_t));
  const bool isKnown = primitive.mode == TINYGLTF_MODE_TRIANGLES && position && normal && index &&
                       primitive.material >= 0 && static_cast<size_t>(primitive.material) < room_.materials.size();
  if (!isKnown) {
    return fail("mesh", mesh.name, "is not of packed triangles with normals, 16-bit indices and a material");
  }
  const size_t vertexCount = model_.accessors[static_cast<size_t>(positions)].count;
  const size_t indexCount = model_.accessors[static_cast<size_t>(primitive.indices)].count;
  if (model_.accessors[static_cast<size_t>(normals)].count != vertexCount || indexCount % 3 != 0) {
    return fail("mesh", mesh.name, "has another number of normals than of positions, or no whole triangles");
  }
  const auto first = static_cast<uint32_t>(room_.vertices.size());
  for (size_t i = 0; i < vertexCount; ++i) {
    RoomVertex& vertex = room_.vertices.emplace_back();
    std::memcpy(&vertex.position, position + i * sizeof(glm::vec3), sizeof(glm::vec3));
    std::memcpy(&vertex.normal, normal + i * sizeof(glm::vec3), sizeof(glm::vec3));
  }
  RoomPart part{static_cast<uint32_t>(room_.nodes.size() - 1), static_cast<uint32_t>(primitive.material),
                static_cast<uint32_t>(room_.indices.size()), static_cast<uint32_t>(indexCount)};
  for (size_t i = 0; i < indexCount; ++i) {
    uint16_t value = 0;
    std::memcpy(&value, index + i * sizeof(value), sizeof(value));
    if (value >= vertexCount) return fail("mesh", mesh.name, "an index is beyond its vertices");
    room_.indices.push_back(first + value);
  }
  room_.parts.push_back(part);
  return {};
}

Status RoomReader::findMirror() {
  constexpr double kFlat = 1e-4;  // [metres]
  for (const RoomPart& part : room_.parts) {
    if (room_.materials[part.material].kind != MaterialKind::kMirror) continue;
    const RoomNode& node = room_.nodes[part.node];
    for (uint32_t i = 0; i < part.indexCount; ++i) {
      const RoomVertex& vertex = room_.vertices[room_.indices[part.firstIndex + i]];
      const glm::dvec3 point = node.toWorld(vertex.position);
      if (room_.mirror.normal == glm::dvec3(0)) {
        room_.mirror.normal = glm::normalize(node.rotation * glm::dvec3(vertex.normal));
        room_.mirror.offset = -glm::dot(room_.mirror.normal, point);
      }
      if (std::abs(glm::dot(room_.mirror.normal, point) + room_.mirror.offset) > kFlat) {
        return fail("node", node.name,
                    "its mirror is not in the plane of the first one; give other metals a roughness");
      }
    }
  }
  return {};
}

}  // namespace

Result<Room> readRoom(const std::filesystem::path& path) {
  tinygltf::TinyGLTF loader;
  tinygltf::Model model;
  std::string error, warning;
  if (!loader.LoadASCIIFromFile(&model, &error, &warning, path.string())) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    return makeError(ErrorKind::kBadInput, "%s: %s", path.c_str(), error.empty() ? "no glTF" : error.c_str());
  }
  return RoomReader(path, model).read();
}

}  // namespace froth
