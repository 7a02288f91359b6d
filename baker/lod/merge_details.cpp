#include "baker/lod/merge_details.h"

#include <algorithm>
#include <cmath>

#include "baker/lod/detail_sharpness.h"
#include "baker/lod/ridge_solve.h"
#include "foam/detail_colour.h"
#include "shaders/foam/appearance.h"

namespace froth {
namespace {

constexpr double kLeastShare = 1e-3;  // of a cell: what a detail site counts that no sample of the face shows
// Towards the mean of a cluster, in units of what a detail site shows: the blend alone leaves sites undetermined that
// hardly show.
constexpr double kDetailRidge = 0.5;
constexpr double kOfColours = 1;  // a squared difference [display-coded], of a squared distance [radii]
constexpr double kHighest = 1;    // of a face over its site [radii]

// A detail site of either cell on the merged face, or the mean of some.
struct Cluster {
  glm::dvec3 place{0};   // u, v, height [radii of the merged cell]
  glm::dvec3 colour{0};  // from straight before the face [display-coded]
  double weight = 0;
  std::vector<uint32_t> members;
};

class DetailMerger {
 public:
  DetailMerger(const Foam& cells, const MergeParts& parts, const MergedShape& shape)
      : cells_(cells), parts_(parts), shape_(shape), K_(cells.detailCount) {}

  MergedDetails merge(bool keepsPlain) {
    placeDetails();
    joinNearest();
    MergedDetails merged;
    for (const Cluster& cluster : clusters_) {
      merged.places.emplace_back(cluster.place);
      merged.heaviest.push_back(*std::max_element(cluster.members.begin(), cluster.members.end(),
                                                  [&](uint32_t a, uint32_t b) { return weights_[a] < weights_[b]; }));
    }
    fit(merged);
    if (keepsPlain) merged.heights.assign(K_, 0.0);
    return merged;
  }

 private:
  glm::dvec3 onFace(const glm::dvec3& place) const {
    const glm::dvec3 x = place - shape_.site;
    return glm::dvec3(glm::dot(x, shape_.frame.tangent), glm::dot(x, shape_.frame.bitangent),
                      glm::dot(x, shape_.frame.normal)) /
           shape_.radius;
  }

  void placeDetails() {
    weights_.assign(2 * K_, 0.0);
    clusters_.resize(2 * K_);
    for (uint32_t side = 0; side < 2; ++side) {
      const MergePart& part = parts_[side];
      const double each = part.weight / double(part.samples.face.size());
      for (size_t i = 0; i < part.samples.shares.size(); ++i) {
        weights_[side * K_ + i % K_] += each * part.samples.shares[i];
      }
      const FaceFrame<double> frame = faceFrame<double>(cells_.orientations[part.cell]);
      for (uint32_t k = 0; k < K_; ++k) {
        const uint32_t j = side * K_ + k;
        const size_t own = size_t{part.cell} * K_ + k;
        weights_[j] += kLeastShare * part.weight + 1e-12;
        const glm::dvec2 place(cells_.detailSites[own]);
        const glm::dvec3 local =
            place.x * frame.tangent + place.y * frame.bitangent + double{cells_.detailHeights[own]} * frame.normal;
        const glm::vec3 colour = detailColour(cells_, own, glm::vec3(-frame.normal));
        clusters_[j] = {onFace(part.offset + double{cells_.radii[part.cell]} * local), colour, weights_[j], {j}};
      }
    }
  }

  // Ward's method: joins what raises the weighted variance least, until K are left; equals by index.
  void joinNearest() {
    while (clusters_.size() > K_) {
      size_t first = 0, second = 1;
      double least = INFINITY;
      for (size_t a = 0; a < clusters_.size(); ++a) {
        for (size_t b = a + 1; b < clusters_.size(); ++b) {
          const glm::dvec3 between = clusters_[a].place - clusters_[b].place;
          const glm::dvec3 colours = clusters_[a].colour - clusters_[b].colour;
          const double wa = clusters_[a].weight, wb = clusters_[b].weight;
          const double rise =
              wa * wb / (wa + wb) * (glm::dot(between, between) + kOfColours * glm::dot(colours, colours));
          if (rise < least) least = rise, first = a, second = b;
        }
      }
      Cluster& kept = clusters_[first];
      const Cluster& gone = clusters_[second];
      kept.place = (kept.weight * kept.place + gone.weight * gone.place) / (kept.weight + gone.weight);
      kept.colour = (kept.weight * kept.colour + gone.weight * gone.colour) / (kept.weight + gone.weight);
      kept.weight += gone.weight;
      kept.members.insert(kept.members.end(), gone.members.begin(), gone.members.end());
      clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(second));
    }
  }

  // Heights and mixes whose blend over the merged face comes nearest to the blends over both faces.
  void fit(MergedDetails& merged) {
    const size_t columns = 2 * K_ + 1;  // sources of a mix, then the height
    std::vector<double> matrix(size_t{K_} * K_), right(K_ * columns), shares(K_);
    for (uint32_t side = 0; side < 2; ++side) {
      const MergePart& part = parts_[side];
      const double each = part.weight / double(part.samples.face.size());
      for (size_t i = 0; i < part.samples.face.size(); ++i) {
        const glm::dvec3 place = onFace(part.offset + part.samples.face[i]);
        double sum = 0;
        for (uint32_t k = 0; k < K_; ++k) {
          sum += shares[k] = foam::detailWeight(glm::dvec3(place.x, place.y, 0), merged.places[k], kTrainedSharpness);
        }
        for (uint32_t k = 0; k < K_; ++k) {
          const double share = shares[k] / foam::flooredWeightSum(sum);
          for (uint32_t l = k; l < K_; ++l) {
            matrix[k * K_ + l] += each * share * shares[l] / foam::flooredWeightSum(sum);
          }
          double* const row = &right[k * columns];
          for (uint32_t l = 0; l < K_; ++l) row[side * K_ + l] += each * share * part.samples.shares[i * K_ + l];
          row[2 * K_] += each * share * place.z;
        }
      }
    }
    for (uint32_t k = 0; k < K_; ++k) {
      const double ridge = kDetailRidge / K_;
      matrix[k * K_ + k] += ridge;
      for (const uint32_t j : clusters_[k].members) {
        right[k * columns + j] += ridge * weights_[j] / clusters_[k].weight;
      }
      right[k * columns + 2 * K_] += ridge * clusters_[k].place.z;
    }
    solveDefinite(matrix, right, K_, columns);
    for (uint32_t k = 0; k < K_; ++k) {
      const double* const row = &right[k * columns];
      merged.mix.insert(merged.mix.end(), row, row + 2 * K_);
      merged.heights.push_back(std::clamp(row[2 * K_], -kHighest, kHighest));
    }
  }

  const Foam& cells_;
  const MergeParts& parts_;
  const MergedShape& shape_;
  const uint32_t K_;
  std::vector<double> weights_;  // [2K] what each detail site shows of both faces
  std::vector<Cluster> clusters_;
};

}  // namespace

MergedDetails mergeDetails(const Foam& cells, const MergeParts& parts, const MergedShape& shape, bool keepsPlain) {
  return DetailMerger(cells, parts, shape).merge(keepsPlain);
}

}  // namespace froth
