#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "foam/cech_pairs.h"
#include "foam/cell_graph.h"
#include "foam/checkpoint/activation.h"
#include "foam/checkpoint/checkpoint.h"
#include "foam/checkpoint/parameters.h"
#include "foam/checkpoint/pickle_writer.h"
#include "foam/checkpoint/zip_writer.h"
#include "foam/foam_arrays.h"

namespace froth {
namespace {

constexpr size_t kPieceBytes = 64 << 20;  // between two reports of progress

struct ExportedTensor {
  TensorDeclaration declaration;
  std::span<const uint8_t> bytes;
};

template <class Element>
std::span<const uint8_t> asBytes(const std::vector<Element>& elements) {
  return {reinterpret_cast<const uint8_t*>(elements.data()), elements.size() * sizeof(Element)};
}

// What importCheckpoint() would refuse is not written.
template <class Vec>
Status checkValues(const std::string& file, const char* name, const std::vector<Vec>& values, uint64_t expected) {
  if (values.size() != expected) {
    return makeError(ErrorKind::kUsage, "%s: the foam has %zu %s, its counts ask for %llu; make the foam consistent",
                     file.c_str(), values.size(), name, static_cast<unsigned long long>(expected));
  }
  const auto numbers = reinterpret_cast<const float*>(values.data());
  const size_t count = values.size() * sizeof(Vec) / sizeof(float);
  const auto bad = std::find_if_not(numbers, numbers + count, [](float number) { return std::isfinite(number); });
  if (bad != numbers + count) {
    return makeError(ErrorKind::kUsage, "%s: the foam's %s hold %g at place %td; make them finite", file.c_str(), name,
                     double{*bad},
                     (bad - numbers) * static_cast<ptrdiff_t>(sizeof(float)) / static_cast<ptrdiff_t>(sizeof(Vec)));
  }
  return {};
}

Status checkFoam(const std::string& file, const Foam& foam) {
  const uint64_t cells = foam.cellCount, details = cells * foam.detailCount, lobes = details * foam.lobeCount;
  Status status;
  visitArrays([&](const FoamArray& array, auto values) {
    if (!status || array.canBeEmpty) return;
    const uint64_t count = array.index == FoamIndex::kCell ? cells : array.index == FoamIndex::kLobe ? lobes : details;
    status = checkValues(file, array.name, foam.*values, count);
  });
  if (status && (lobes == 0 || foam.detailCount > kMaxDetails || foam.lobeCount > kMaxLobes)) {
    status =
        makeError(ErrorKind::kUsage, "%s: a foam of %u cells, %u detail sites, %u lobes; expected >= 1, 1..32, 1..32",
                  file.c_str(), foam.cellCount, foam.detailCount, foam.lobeCount);
  }
  const auto isPositive = [](float value) { return value > 0; };
  const auto isNegative = [](float value) { return value < 0; };
  if (status && (!std::all_of(foam.radii.begin(), foam.radii.end(), isPositive) ||
                 std::any_of(foam.densities.begin(), foam.densities.end(), isNegative))) {
    status =
        makeError(ErrorKind::kUsage, "%s: a radius <= 0 or a density < 0; no raw value activates to it", file.c_str());
  }
  const auto hasNoLength = [](const glm::vec4& quaternion) { return quaternion == glm::vec4(0); };
  if (status && std::any_of(foam.orientations.begin(), foam.orientations.end(), hasNoLength)) {
    status = makeError(ErrorKind::kUsage, "%s: an orientation of length 0; give every cell a quaternion", file.c_str());
  }
  return status;
}

std::vector<float> deactivate(const std::vector<float>& activated) {
  std::vector<float> raw(activated.size());
  std::transform(activated.begin(), activated.end(), raw.begin(), inverseSoftplus);
  return raw;
}

// The graph of the spheres as a reader of the file will see them.
CellGraph findWrittenPairs(const Foam& foam, const std::vector<float>& rawRadii) {
  std::vector<float> radii(rawRadii.size());
  std::transform(rawRadii.begin(), rawRadii.end(), radii.begin(),
                 [](float raw) { return static_cast<float>(softplus(raw)); });
  return findCechPairs(foam.sites, radii);
}

Status writeTensor(ZipWriter& archive, std::string name, std::span<const uint8_t> bytes,
                   const std::function<Status(size_t)>& advance) {
  Status status = archive.begin(std::move(name), bytes.size());
  for (size_t done = 0; status && done < bytes.size(); done += kPieceBytes) {
    const auto piece = bytes.subspan(done, std::min(kPieceBytes, bytes.size() - done));
    status = archive.append(piece);
    if (status) status = advance(piece.size());
  }
  return status ? archive.end() : status;
}

// Members, their order and their content as torch.save writes them.
Status writeArchive(ZipWriter& archive, std::span<const ExportedTensor> tensors,
                    const std::function<Status(size_t)>& advance) {
  std::vector<TensorDeclaration> declarations;
  for (const ExportedTensor& tensor : tensors) {
    declarations.push_back(tensor.declaration);
  }
  const std::string prefix = "model/";
  Status status = archive.add(prefix + "data.pkl", pickleTensors(declarations));
  if (status) status = archive.add(prefix + ".format_version", "1");
  if (status) status = archive.add(prefix + ".storage_alignment", "64");
  if (status) status = archive.add(prefix + "byteorder", "little");
  for (size_t i = 0; status && i < tensors.size(); ++i) {
    status = writeTensor(archive, prefix + "data/" + std::to_string(i), tensors[i].bytes, advance);
  }
  if (status) status = archive.add(prefix + "version", "3\n");
  return status ? archive.finish() : status;
}

Status writeFoam(const std::filesystem::path& path, const Foam& foam, const std::vector<float>& radii,
                 const CellGraph* adjacency, const Progress& progress) {
  const std::vector<float> densities = deactivate(foam.densities);
  const uint64_t cells = foam.cellCount, details = foam.detailCount, lobes = foam.lobeCount;
  const auto keyOf = [](Parameter parameter) { return kParameterKeys[static_cast<size_t>(parameter)]; };
  std::vector<ExportedTensor> tensors = {
      {{keyOf(Parameter::kPoints), ScalarType::kFloat, {cells, 3}}, asBytes(foam.sites)},
      {{keyOf(Parameter::kDensity), ScalarType::kFloat, {cells}}, asBytes(densities)},
      {{keyOf(Parameter::kRadii), ScalarType::kFloat, {cells}}, asBytes(radii)},
      {{keyOf(Parameter::kOrientations), ScalarType::kFloat, {cells, 4}}, asBytes(foam.orientations)},
      {{keyOf(Parameter::kDetailSites), ScalarType::kFloat, {cells, details, 2}}, asBytes(foam.detailSites)},
      {{keyOf(Parameter::kLobeAxes), ScalarType::kFloat, {cells, details, 3 * lobes}}, asBytes(foam.lobeAxes)},
      {{keyOf(Parameter::kLobeColours), ScalarType::kFloat, {cells, details, 3 * lobes}}, asBytes(foam.lobeColours)},
      {{keyOf(Parameter::kDetailHeights), ScalarType::kFloat, {cells, details}}, asBytes(foam.detailHeights)}};
  if (adjacency) {
    const CellGraph& graph = *adjacency;
    tensors.push_back({{kAdjacencyKey, ScalarType::kInt, {graph.neighbours.size()}}, asBytes(graph.neighbours)});
    tensors.push_back({{kAdjacencyOffsetsKey, ScalarType::kInt, {graph.offsets.size()}}, asBytes(graph.offsets)});
  }
  uint64_t done = 0, total = 0;
  for (const ExportedTensor& tensor : tensors) {
    total += tensor.bytes.size();
  }
  const auto advance = [&](size_t bytes) -> Status {
    done += bytes;
    if (!report(progress, "export", done, total)) {
      return stoppedOnRequest(path.string() + ": export");
    }
    return {};
  };
  return streamFileAtomically(path, [&](const ByteSink& sink) {
    ZipWriter archive(sink);
    return writeArchive(archive, tensors, advance);
  });
}

}  // namespace

Status exportCheckpoint(const std::filesystem::path& path, const Foam& foam, const Progress& progress) {
  if (Status status = checkFoam(path.string(), foam); !status) {
    return status;
  }
  const std::vector<float> radii = deactivate(foam.radii);
  const CellGraph graph = findWrittenPairs(foam, radii);
  if (graph.neighbours.size() > INT32_MAX) {
    return makeError(ErrorKind::kUnsupported,
                     "%s: %zu neighbours, the layout's int32 offsets end at 2^31 - 1; export fewer cells", path.c_str(),
                     graph.neighbours.size());
  }
  return writeFoam(path, foam, radii, &graph, progress);
}

Status exportUnchecked(const std::filesystem::path& path, const Foam& foam) {
  return writeFoam(path, foam, deactivate(foam.radii), nullptr, {});
}

}  // namespace froth
