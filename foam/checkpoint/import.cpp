#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/float_span.h"
#include "foam/checkpoint/activation.h"
#include "foam/checkpoint/checkpoint.h"
#include "foam/checkpoint/checkpoint_views.h"
#include "foam/checkpoint/mapped_file.h"

namespace froth {
namespace {

constexpr uint64_t kMaxCells = UINT32_MAX;
// Foam bytes per file byte: 1 as published, 2 from float16, more where tensors are expanded.
constexpr uint64_t kMaxExpansion = 256;
constexpr uint64_t kSliceElements = 1 << 21;  // copied between two looks at a request to stop

// What may reach a shader: a device may take denormal numbers for 0, and so divide by 0 where a processor does not.
bool isPlain(float value) { return std::isnormal(value) || value == 0; }

class Importer {
 public:
  Importer(const NamedBytes& file, CheckpointViews views, const Progress& progress)
      : file_(file), views_(std::move(views)), progress_(progress) {}

  Result<Foam> import();

 private:
  Status readCounts();
  std::vector<uint64_t> expectedShape(Parameter parameter, size_t rank) const;
  Status checkShapes() const;
  Status checkExpansion() const;
  Status fillFoam();
  template <class Vec>
  Status readPlain(Parameter parameter, std::vector<Vec>& out);
  Status readActivated(Parameter parameter, float smallest, std::vector<float>& out);
  Status readOrientations();
  template <class Real, class Item>
  Status copy(const TensorView& from, std::vector<Item>& out);
  Error refuseValue(const TensorView& from, uint64_t cell, float value) const;
  Status checkPlain(const TensorView& view, std::span<const float> values) const;
  uint64_t totalCount() const;
  const TensorView& view(Parameter parameter) const { return views_[static_cast<size_t>(parameter)]; }

  const NamedBytes& file_;
  const CheckpointViews views_;
  const Progress& progress_;
  uint64_t done_ = 0;  // elements read
  Foam foam_;
};

Result<Foam> Importer::import() {
  if (Status status = readCounts(); !status) {
    return status.error();
  }
  if (Status status = fillFoam(); !status) {
    return status.error();
  }
  return std::move(foam_);
}

// The counts follow from three shapes; all others must agree with them.
Status Importer::readCounts() {
  const auto& points = view(Parameter::kPoints).shape;
  const uint64_t cells = points.size() == 2 ? points[0] : 0;
  if (cells < 1 || cells > kMaxCells) {
    return badInput(file_.name,
                    "tensor 'points' has shape {}, expected [N, 3] with 1 <= N <= {}; save a foam with cells",
                    describeShape(points), kMaxCells);
  }
  const auto& sites = view(Parameter::kDetailSites).shape;
  const uint64_t details = sites.size() == 3 ? sites[1] : 0;
  if (details < 1 || details > kMaxDetails) {
    return badInput(file_.name,
                    "tensor 'texel_sites' has shape {}, expected [N, K, 2] with 1 <= K <= {}; train with such K",
                    describeShape(sites), kMaxDetails);
  }
  const auto& axes = view(Parameter::kLobeAxes).shape;
  const uint64_t lobes = axes.size() == 4 ? axes[2] : axes.size() == 3 ? axes[2] / 3 : 0;
  if (lobes < 1 || lobes > kMaxLobes) {
    return badInput(file_.name,
                    "tensor 'texel_sv_axis' has shape {}, expected [N, K, 3M] or [N, K, M, 3] with 1 <= M <= "
                    "{}; train with such M",
                    describeShape(axes), kMaxLobes);
  }
  foam_.cellCount = static_cast<uint32_t>(cells);
  foam_.detailCount = static_cast<uint32_t>(details);
  foam_.lobeCount = static_cast<uint32_t>(lobes);
  if (Status status = checkShapes(); !status) {
    return status;
  }
  return checkExpansion();
}

std::vector<uint64_t> Importer::expectedShape(Parameter parameter, size_t rank) const {
  const uint64_t cells = foam_.cellCount, details = foam_.detailCount, lobes = foam_.lobeCount;
  switch (parameter) {
    case Parameter::kPoints:
      return {cells, 3};
    case Parameter::kDensity:
    case Parameter::kRadii:
      return {cells};
    case Parameter::kOrientations:
      return {cells, 4};
    case Parameter::kDetailSites:
      return {cells, details, 2};
    case Parameter::kDetailHeights:
      return {cells, details};
    case Parameter::kLobeAxes:
    case Parameter::kLobeColours:
      break;
  }
  return rank == 4 ? std::vector<uint64_t>{cells, details, lobes, 3} : std::vector<uint64_t>{cells, details, 3 * lobes};
}

Status Importer::checkShapes() const {
  for (size_t i = 0; i < kParameterCount; ++i) {
    const TensorView& found = views_[i];
    const auto expected = expectedShape(static_cast<Parameter>(i), found.shape.size());
    if (found.shape != expected) {
      return badInput(file_.name, "tensor '{}' has shape {}, the others ask for {}; save the tensors of one foam",
                      found.key, describeShape(found.shape), describeShape(expected));
    }
  }
  return {};
}

// Strides of 0 repeat elements, so that a small file can ask for any amount of memory.
Status Importer::checkExpansion() const {
  const uint64_t bytes = totalCount() * sizeof(float);
  if (bytes / kMaxExpansion > file_.bytes.size()) {
    return badInput(file_.name, "its tensors expand to {} bytes, over {} times the file's {}; save them contiguous",
                    bytes, kMaxExpansion, file_.bytes.size());
  }
  return {};
}

Status Importer::fillFoam() {
  constexpr float kSmallestRadius = std::numeric_limits<float>::min(), kSmallestDensity = 0;
  Status status = readPlain(Parameter::kPoints, foam_.sites);
  if (status) status = readActivated(Parameter::kRadii, kSmallestRadius, foam_.radii);
  if (status) status = readActivated(Parameter::kDensity, kSmallestDensity, foam_.densities);
  if (status) status = readOrientations();
  if (status) status = readPlain(Parameter::kDetailSites, foam_.detailSites);
  if (status) status = readPlain(Parameter::kDetailHeights, foam_.detailHeights);
  if (status) status = readPlain(Parameter::kLobeAxes, foam_.lobeAxes);
  if (status) status = readPlain(Parameter::kLobeColours, foam_.lobeColours);
  return status;
}

template <class Vec>
Status Importer::readPlain(Parameter parameter, std::vector<Vec>& out) {
  const TensorView& from = view(parameter);
  if (Status status = copy<float>(from, out); !status) {
    return status;
  }
  return checkPlain(from, floatsOf(out));
}

Status Importer::readActivated(Parameter parameter, float smallest, std::vector<float>& out) {
  const TensorView& from = view(parameter);
  std::vector<double> raw;
  if (Status status = copy<double>(from, raw); !status) {
    return status;
  }
  out.resize(from.count);
  for (size_t i = 0; i < raw.size(); ++i) {
    out[i] = static_cast<float>(raw[i]);
    if (!isPlain(out[i])) continue;  // told below: infinity must not pass as the density 0 that it would become
    out[i] = static_cast<float>(softplus(raw[i]));
    if (out[i] < std::numeric_limits<float>::min()) out[i] = 0;
  }
  if (Status status = checkPlain(from, out); !status) {
    return status;
  }
  const auto low = std::find_if(out.begin(), out.end(), [&](float value) { return value < smallest; });
  if (low != out.end()) {
    const auto cell = low - out.begin();
    return badInput(file_.name, "tensor '{}': cell {} has the raw value {}, which activates to 0; remove the cell",
                    from.key, cell, raw[static_cast<size_t>(cell)]);
  }
  return {};
}

Status Importer::readOrientations() {
  const TensorView& from = view(Parameter::kOrientations);
  std::vector<glm::dvec4> raw;
  if (Status status = copy<double>(from, raw); !status) {
    return status;
  }
  foam_.orientations.resize(raw.size());
  for (size_t i = 0; i < raw.size(); ++i) {
    const double length = glm::length(raw[i]);
    const glm::vec4 asFloats(raw[i]);
    for (int component = 0; component < 4; ++component) {
      if (std::fpclassify(asFloats[component]) == FP_SUBNORMAL) return refuseValue(from, i, asFloats[component]);
    }
    if (!(length > 0) || std::isinf(length)) {
      return badInput(file_.name,
                      "tensor '{}': the quaternion of cell {} has length {}; remove the cell or train again", from.key,
                      i, length);
    }
    foam_.orientations[i] = normaliseQuaternion(raw[i]);
  }
  return {};
}

Error Importer::refuseValue(const TensorView& from, uint64_t cell, float value) const {
  return badInput(file_.name, "tensor '{}': cell {} of {} holds {} (as float32); remove the cell or train again",
                  from.key, cell, foam_.cellCount, value);
}

Status Importer::checkPlain(const TensorView& from, std::span<const float> values) const {
  const auto bad = std::find_if_not(values.begin(), values.end(), isPlain);
  if (bad == values.end()) return {};
  return refuseValue(from, static_cast<uint64_t>(bad - values.begin()) / (from.count / foam_.cellCount), *bad);
}

// By rows: reading from a slow disk can take long. `out` is empty, an Item a few Reals.
template <class Real, class Item>
Status Importer::copy(const TensorView& from, std::vector<Item>& out) {
  constexpr size_t kReals = sizeof(Item) / sizeof(Real);
  const uint64_t rows = foam_.cellCount, width = from.count / rows;
  out.reserve(from.count / kReals);
  const uint64_t sliceRows = std::max<uint64_t>(kSliceElements / width, 1);
  for (uint64_t first = 0; first < rows; first += sliceRows) {
    const TensorView slice = rowsOf(from, first, std::min(sliceRows, rows - first));
    out.resize(out.size() + slice.count / kReals);
    copyElements(slice, reinterpret_cast<Real*>(out.data() + out.size()) - slice.count);
    done_ += slice.count;
    if (!report(progress_, "import", done_, totalCount())) {
      return stoppedOnRequest(file_.name + ": import");
    }
  }
  return {};
}

uint64_t Importer::totalCount() const {
  uint64_t total = 0;
  for (const TensorView& tensor : views_) {
    total += tensor.count;
  }
  return total;
}

}  // namespace

Result<Foam> importCheckpointBytes(std::span<const uint8_t> bytes, const std::string& name, const Progress& progress) {
  const NamedBytes file{bytes, name};
  Result<CheckpointViews> views = viewCheckpoint(file, progress);
  if (!views) {
    return views.error();
  }
  return Importer(file, std::move(*views), progress).import();
}

Result<Foam> importCheckpoint(const std::filesystem::path& path, const Progress& progress) {
  const Result<MappedFile> file = MappedFile::open(path);
  if (!file) {
    return file.error();
  }
  return importCheckpointBytes(file->bytes(), path.string(), progress);
}

}  // namespace froth
