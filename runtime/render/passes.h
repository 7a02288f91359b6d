// The passes of a view, a row each: enumerators, pipelines and their numbers follow from the rows.
#pragma once

#include <cstdint>

namespace froth {

// ONE(Name, shader, lenses): one pipeline. COLOURS: one for each format of the colour image, Name16 and Name32, from
// shader_rgba16f and shader_rgba32f. FORMS: those, and both once more for full frames (gpu::kConstantIsFull), which
// cost time: NameFull16, NameFull32. lenses: the classes of lenses for which a pass has pipelines of its own (kAnyLens
// and so on); others take the pinhole's.

// Made with the context.
#define FROTH_COMMON_PASSES(ONE, COLOURS, FORMS)    \
  ONE(CullCells, cull_cells, kEachLens)             \
  ONE(ChooseCells, choose_cells, kAnyLens)          \
  ONE(SortScatter, sort_scatter, kAnyLens)          \
  ONE(SortScatterMany, sort_scatter_many, kAnyLens) \
  ONE(CountTiles, count_tiles, kEachLens)           \
  ONE(NearestBalls, nearest_balls, kEachLens)       \
  ONE(EmitPairs, emit_pairs, kEachLens)             \
  ONE(OrderTiles, order_tiles, kAnyLens)            \
  ONE(ExpandCells, expand_cells, kEyeOrNone)        \
  ONE(Locate, locate, kEachLens)                    \
  ONE(AimRays, aim_rays, kMapped)                   \
  ONE(AimRaysByImage, aim_rays_by_image, kMapped)   \
  ONE(WidenCones, widen_cones, kMapped)             \
  ONE(PublishBorders, publish_borders, kAnyLens)    \
  COLOURS(Clear, clear, kAnyLens)                   \
  COLOURS(Fade, fade, kAnyLens)

// Made where a view draws several instances.
#define FROTH_MERGED_PASSES(ONE, COLOURS, FORMS)  \
  ONE(ShareTiles, share_tiles, kAnyLens)          \
  FORMS(RasterOrdered, raster_ordered, kEachLens) \
  FORMS(RasterMerged, raster_merged, kEachLens)   \
  FORMS(WalkMerged, walk_merged, kEachLens)

// Made for each shape of assets, on which they are specialized. RasterLong: of tiles with long lists.
#define FROTH_SHAPED_PASSES(ONE, COLOURS, FORMS)  \
  ONE(CompactCells, compact_cells, kEyeOrNone)    \
  ONE(ShadeDetails, shade_details, kEyeOrNone)    \
  FORMS(RasterLong, raster_long_tiles, kEachLens) \
  FORMS(Raster, raster_tiles, kEachLens)          \
  FORMS(Walk, walk, kEachLens)

#define FROTH_PASS_ONE(name, shader, lenses) k##name,
#define FROTH_PASS_COLOURS(name, shader, lenses) k##name##16, k##name##32,
#define FROTH_PASS_FORMS(name, shader, lenses) k##name##16, k##name##32, k##name##Full16, k##name##Full32,

enum class Pass : uint32_t {
  FROTH_COMMON_PASSES(FROTH_PASS_ONE, FROTH_PASS_COLOURS, FROTH_PASS_FORMS)
      FROTH_MERGED_PASSES(FROTH_PASS_ONE, FROTH_PASS_COLOURS, FROTH_PASS_FORMS)
          FROTH_SHAPED_PASSES(FROTH_PASS_ONE, FROTH_PASS_COLOURS, FROTH_PASS_FORMS) kCount
};

#undef FROTH_PASS_ONE
#undef FROTH_PASS_COLOURS
#undef FROTH_PASS_FORMS

inline constexpr uint32_t kPassCount = static_cast<uint32_t>(Pass::kCount);
inline constexpr uint32_t kFirstMergedPass = static_cast<uint32_t>(Pass::kShareTiles);
inline constexpr uint32_t kFirstShapedPass = static_cast<uint32_t>(Pass::kCompactCells);

}  // namespace froth
