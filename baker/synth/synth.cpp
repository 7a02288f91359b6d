#include "baker/synth/synth.h"

#include "baker/synth/gallery_foam.h"
#include "baker/synth/small_scenes.h"

namespace froth {

namespace {

struct Scene {
  const char* name;
  Result<Foam> (*make)(const SynthOptions& options, const Progress& progress);
};

Result<Foam> makeGallery(const SynthOptions& options, const Progress& progress) {
  GallerySize size;
  if (options.cellCount) size.cells = options.cellCount;
  if (options.detailCount) size.detailSites = options.detailCount;
  if (options.lobeCount) size.lobes = options.lobeCount;
  return synthesizeGallery(size, options.seed, progress);
}

constexpr Scene kScenes[] = {
    {"gallery", makeGallery},
    {"one", [](const SynthOptions& options, const Progress&) { return synthesizeOne(options); }},
    {"two", [](const SynthOptions& options, const Progress&) { return synthesizeTwo(options); }},
    {"grid", synthesizeGrid},
    {"shell", synthesizeShell},
    {"random", synthesizeRandom},
};

}  // namespace

std::vector<std::string> synthNames() {
  std::vector<std::string> names;
  for (const Scene& scene : kScenes) names.emplace_back(scene.name);
  return names;
}

Result<Foam> synthesizeFoam(const SynthOptions& options, const Progress& progress) {
  std::string known;
  for (const Scene& scene : kScenes) {
    if (options.name == scene.name) return scene.make(options, progress);
    known += known.empty() ? scene.name : std::string(", ") + scene.name;
  }
  return makeError(ErrorKind::kUsage, "no procedural scene is called '%s'; there are: %s", options.name.c_str(),
                   known.c_str());
}

}  // namespace froth
