#include "trainer/loop/state_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/atomic_file.h"
#include "base/input_file.h"
#include "trainer/loop/schedule.h"

namespace froth {
namespace {

constexpr uint32_t kVersion = 3;
// "rothams3" and older, little-endian.
constexpr uint64_t magicOf(uint64_t version) { return ('0' + version) << 56 | 0x736d6168746f72; }
constexpr uint32_t kMostSettings = 1 << 16;

struct StateHeader {
  uint64_t magic = magicOf(kVersion);
  uint32_t stepsDone = 0, settingsBytes = 0;
  uint32_t cellCount = 0, detailCount = 0, lobeCount = 0;
  uint32_t photosPerStep = 1;
  uint64_t averagedSteps = 0;  // [<= stepsDone] 0: no mean values follow
  uint64_t fileBytes = 0;      // of the whole file
};

// Calls visit(bytes) for the arrays of a foam in the order of the file. Balls are activated again.
template <class Visit>
Status visitArrays(FoamStorage<float>& foam, Visit&& visit) {
  const auto visitVector = [&](auto& values) {
    return visit(std::span(reinterpret_cast<uint8_t*>(values.data()), values.size() * sizeof(values[0])));
  };
  for (auto* tensors : {&foam.values, &foam.firstMoments, &foam.secondMoments, &foam.meanValues}) {
    for (std::vector<float>& tensor : *tensors) {
      if (Status went = visitVector(tensor); !went) return went;
    }
  }
  if (Status went = visitVector(foam.lastSteps); !went) return went;
  if (Status went = visitVector(foam.contributions); !went) return went;
  return visitVector(foam.errors);
}

FoamShape shapeOf(const StateHeader& header) { return {header.cellCount, header.detailCount, header.lobeCount}; }

uint64_t bytesOf(const StateHeader& header) {
  const FoamShape shape = shapeOf(header);
  const uint64_t tensors = header.averagedSteps > 0 ? 4 : 3;  // values, moments, mean values
  uint64_t perCell = 3;                                       // last step and two means
  for (size_t i = 0; i < kParameterCount; ++i) perCell += tensors * widthOf(static_cast<Parameter>(i), shape);
  return sizeof(StateHeader) + header.settingsBytes + (uint64_t{header.stepsDone} + 1) * sizeof(double) +
         perCell * shape.cellCount * sizeof(float);
}

bool isSound(const StateHeader& header) {
  return header.magic == magicOf(kVersion) && header.settingsBytes <= kMostSettings && header.cellCount > 0 &&
         header.detailCount > 0 && header.detailCount <= kMaxDetails && header.lobeCount > 0 &&
         header.lobeCount <= kMaxLobes && header.photosPerStep > 0 && header.photosPerStep <= kMostPhotosPerStep &&
         header.averagedSteps <= header.stepsDone && header.fileBytes == bytesOf(header);
}

Status checkHeader(const std::filesystem::path& path, const StateHeader& header, uint64_t fileBytes) {
  for (uint32_t version = 1; version < kVersion; ++version) {
    if (header.magic != magicOf(version)) continue;
    return makeError(ErrorKind::kBadInput,
                     "%s: a state of version %u, this froth reads version %u; go on with the froth that wrote it, or "
                     "begin without --resume",
                     path.c_str(), version, kVersion);
  }
  if (isSound(header) && header.fileBytes == fileBytes) return {};
  return makeError(ErrorKind::kBadInput,
                   "%s: no state of training of this version, or a part of one (%llu bytes, its header says %llu); "
                   "begin without --resume",
                   path.c_str(), static_cast<unsigned long long>(fileBytes),
                   static_cast<unsigned long long>(header.fileBytes));
}

bool isTime(const std::vector<double>& seconds) {
  const auto goesBack = [](double before, double after) { return !(before <= after); };
  return seconds.front() == 0 && std::isfinite(seconds.back()) &&
         std::adjacent_find(seconds.begin(), seconds.end(), goesBack) == seconds.end();
}

}  // namespace

Status writeState(const std::filesystem::path& path, TrainingState& state) {
  const FoamShape shape = state.foam.shape;
  StateHeader header;
  header.stepsDone = static_cast<uint32_t>(state.seconds.size() - 1);
  header.settingsBytes = static_cast<uint32_t>(state.settings.size());
  header.cellCount = shape.cellCount;
  header.detailCount = shape.detailCount;
  header.lobeCount = shape.lobeCount;
  header.photosPerStep = state.photosPerStep;
  header.averagedSteps = state.foam.averagedSteps;
  header.fileBytes = bytesOf(header);
  return streamFileAtomically(path, [&](const ByteSink& sink) -> Status {
    const auto asBytes = [](const void* data, size_t size) {
      return std::span(static_cast<const uint8_t*>(data), size);
    };
    if (Status written = sink(asBytes(&header, sizeof(header))); !written) return written;
    if (Status written = sink(asBytes(state.settings.data(), state.settings.size())); !written) return written;
    const size_t secondsBytes = state.seconds.size() * sizeof(double);
    if (Status written = sink(asBytes(state.seconds.data(), secondsBytes)); !written) return written;
    return visitArrays(state.foam, [&](std::span<const uint8_t> bytes) { return sink(bytes); });
  });
}

Result<TrainingState> readState(const std::filesystem::path& path) {
  const Result<InputFile> file = InputFile::open(path);
  if (!file) return file.error();
  StateHeader header;
  if (file->size() < sizeof(header)) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes are no state of training; begin without --resume",
                     path.c_str(), static_cast<unsigned long long>(file->size()));
  }
  const std::span<uint8_t> headerBytes(reinterpret_cast<uint8_t*>(&header), sizeof(header));
  if (Status read = file->readAt(0, headerBytes); !read) return read.error();
  if (Status sound = checkHeader(path, header, file->size()); !sound) return sound.error();
  TrainingState state;
  state.photosPerStep = header.photosPerStep;
  state.seconds.resize(size_t{header.stepsDone} + 1);
  state.settings.resize(header.settingsBytes);
  resizeStorage(state.foam, shapeOf(header));
  if (header.averagedSteps > 0) {
    state.foam.averagedSteps = static_cast<uint32_t>(header.averagedSteps);
    for (size_t i = 0; i < kParameterCount; ++i) state.foam.meanValues[i].resize(state.foam.values[i].size());
  }
  uint64_t offset = sizeof(header);
  const auto readInto = [&](std::span<uint8_t> bytes) -> Status {
    const uint64_t at = offset;
    offset += bytes.size();
    return file->readAt(at, bytes);
  };
  const std::span<uint8_t> settings(reinterpret_cast<uint8_t*>(state.settings.data()), state.settings.size());
  if (Status read = readInto(settings); !read) return read.error();
  const std::span<uint8_t> seconds(reinterpret_cast<uint8_t*>(state.seconds.data()),
                                   state.seconds.size() * sizeof(double));
  if (Status read = readInto(seconds); !read) return read.error();
  if (!isTime(state.seconds)) {
    return makeError(ErrorKind::kBadInput, "%s: the seconds of its steps do not grow from 0; begin without --resume",
                     path.c_str());
  }
  if (Status read = visitArrays(state.foam, readInto); !read) return read.error();
  return state;
}

}  // namespace froth
