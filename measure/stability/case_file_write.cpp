// Writing stiff cases as files.
#include <nlohmann/json.hpp>

#include <charconv>
#include <limits>

#include "baker/bake/check_foam.h"
#include "base/atomic_file.h"
#include "measure/stability/case_file.h"

namespace froth {
namespace {

using WrittenJson = nlohmann::ordered_json;

// The double that prints with the few digits of a float, if those give the float back.
double shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double decimal = 0;
  std::from_chars(text, end, decimal);
  return static_cast<float>(decimal) == value ? decimal : double{value};
}

template <class Vector>
WrittenJson toJson(const Vector& vector) {
  WrittenJson array = WrittenJson::array();
  for (int axis = 0; axis < Vector::length(); ++axis) {
    if constexpr (std::is_same_v<typename Vector::value_type, float>) {
      array.push_back(shortest(vector[axis]));
    } else {
      array.push_back(vector[axis]);
    }
  }
  return array;
}

WrittenJson detailToJson(const Foam& foam, size_t site) {
  WrittenJson detail = {{"place", toJson(foam.detailSites[site])}, {"height", shortest(foam.detailHeights[site])}};
  if (!foam.baseColours.empty()) detail["base"] = toJson(foam.baseColours[site]);
  WrittenJson lobes = WrittenJson::array();
  const LobeRange range = lobesOf(foam, site);
  for (uint64_t m = range.first; m < range.first + range.count; ++m) {
    WrittenJson lobe = toJson(foam.lobeAxes[m]);
    for (int channel = 0; channel < 3; ++channel) lobe.push_back(shortest(foam.lobeColours[m][channel]));
    lobes.push_back(std::move(lobe));
  }
  detail["lobes"] = std::move(lobes);
  return detail;
}

WrittenJson knownToJson(const std::vector<KnownFault>& known) {
  WrittenJson list = WrittenJson::array();
  for (const KnownFault& fault : known) {
    list.push_back({{"preset", fault.preset},
                    {"renderer", fault.renderer},
                    {"kind", fault.kind},
                    {"factor", fault.factor},
                    {"cause", fault.cause}});
  }
  return list;
}

WrittenJson cellToJson(const Foam& foam, uint32_t cell) {
  WrittenJson details = WrittenJson::array();
  for (uint32_t k = 0; k < foam.detailCount; ++k) {
    details.push_back(detailToJson(foam, size_t{cell} * foam.detailCount + k));
  }
  return {{"site", toJson(foam.sites[cell])},
          {"radius", shortest(foam.radii[cell])},
          {"density", shortest(foam.densities[cell])},
          {"orientation", toJson(foam.orientations[cell])},
          {"details", std::move(details)}};
}

WrittenJson placesToJson(const std::vector<CasePlace>& places) {
  WrittenJson list = WrittenJson::array();
  for (const CasePlace& place : places) {
    const glm::quat& q = place.rotation;
    list.push_back({{"position", toJson(place.position)},
                    {"rotation", toJson(glm::vec4(q.w, q.x, q.y, q.z))},
                    {"scale", shortest(place.scale)}});
  }
  return list;
}

// Rows of an image that has the size of its view.
WrittenJson endsToJson(const Image& ends) {
  WrittenJson rows = WrittenJson::array();
  for (uint32_t y = 0; y < ends.height; ++y) {
    WrittenJson row = WrittenJson::array();
    for (uint32_t x = 0; x < ends.width; ++x) {
      const float end = *ends.pixel(x, y);
      row.push_back(end == std::numeric_limits<float>::infinity() ? WrittenJson(kNeverInCaseFile)
                                                                  : WrittenJson(shortest(end)));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// A file has no sizes of images of its own: they are the views'.
Status checkEnds(const StiffCase& stiff, const std::string& file) {
  if (stiff.ends.empty()) return {};
  if (stiff.ends.size() != stiff.views.size()) {
    return makeError(ErrorKind::kUsage, "%s, field 'ends': found %zu images; give one for each of the %zu views",
                     file.c_str(), stiff.ends.size(), stiff.views.size());
  }
  for (size_t i = 0; i < stiff.ends.size(); ++i) {
    const Image& image = stiff.ends[i];
    const View& view = stiff.views[i];
    if (image.width == view.width && image.height == view.height && image.channels == 1 &&
        image.values.size() == size_t{view.width} * view.height) {
      continue;
    }
    return makeError(ErrorKind::kUsage,
                     "%s, field 'ends': view %zu: found %u x %u pixels of %u channels; give %u x %u of one",
                     file.c_str(), i, image.width, image.height, image.channels, view.width, view.height);
  }
  return {};
}

// A detail site or a row of numbers on one line, everything else indented.
void print(const WrittenJson& value, size_t depth, std::string& text) {
  constexpr size_t kDetailDepth = 4;
  const bool isRow = value.is_array() && (value.empty() || value.front().is_primitive());
  if (!value.is_structured() || isRow || depth >= kDetailDepth) {
    text += value.dump(-1, ' ', false, WrittenJson::error_handler_t::replace);
    return;
  }
  text += value.is_object() ? '{' : '[';
  const char* separator = "\n";
  for (const auto& [key, child] : value.items()) {
    text += separator + std::string(depth + 1, ' ');
    separator = ",\n";
    if (value.is_object()) text += '"' + key + "\": ";
    print(child, depth + 1, text);
  }
  text += '\n' + std::string(depth, ' ') + (value.is_object() ? '}' : ']');
}

}  // namespace

Status writeCase(const std::filesystem::path& path, const StiffCase& stiffCase) {
  if (const Status status = checkFoam(stiffCase.foam); !status) return status;
  if (const Status status = checkEnds(stiffCase, path.string()); !status) return status;
  CameraSet cameras;
  cameras.views = stiffCase.views;
  const Result<std::string> views = camerasText(cameras, path.string());
  if (!views) return views.error();

  const Foam& foam = stiffCase.foam;
  WrittenJson cells = WrittenJson::array();
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) cells.push_back(cellToJson(foam, cell));
  WrittenJson ends = WrittenJson::array();
  for (const Image& image : stiffCase.ends) ends.push_back(endsToJson(image));
  const WrittenJson root = {{"name", stiffCase.name},
                            {"what", stiffCase.what},
                            {"analysis", stiffCase.analysis},
                            {"moved", toJson(stiffCase.moved)},
                            {"imported", stiffCase.isImported},
                            {"known", knownToJson(stiffCase.known)},
                            {"places", placesToJson(stiffCase.places)},
                            {"ends", std::move(ends)},
                            {"jitter", toJson(stiffCase.jitter)},
                            {"layers", stiffCase.layers},
                            {"chunk_cells", stiffCase.chunkCells},
                            {"most_lobes", foam.lobeCount},
                            {"cells", std::move(cells)},
                            {"views", WrittenJson::parse(*views)["views"]}};
  std::string text;
  print(root, 0, text);
  text += '\n';
  const std::span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size());
  if (const Result<StiffCase> readBack = parseCase(bytes, path.string()); !readBack) {
    return makeError(ErrorKind::kUsage, "%s", readBack.error().message.c_str());
  }
  return writeFileAtomically(path, bytes);
}

}  // namespace froth
