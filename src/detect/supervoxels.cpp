#include "scree/detect/supervoxels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scree/detect/label.hpp"

namespace scree {

Supervoxels::Supervoxels(std::size_t max_points)
    : point_cells_(max_points),
      voxels_(max_points),
      voxel_centers_(max_points),
      seed_cells_(max_points),
      voxel_of_(max_points),
      neighbours_(max_points * kNeighbours),
      block_means_(max_points),
      block_voxels_(max_points),
      owner_(max_points),
      next_owner_(max_points),
      distance_(max_points),
      new_label_(max_points),
      centers_(max_points),
      labels_(max_points),
      block_points_(max_points) {}

void Supervoxels::Profile::add(const Profile& other) {
  x += other.x;
  y += other.y;
  z += other.z;
  reflectivity += other.reflectivity;
  normal_x += other.normal_x;
  normal_y += other.normal_y;
  normal_z += other.normal_z;
}

void Supervoxels::Profile::average(std::uint32_t count) {
  const float share = 1.0F / static_cast<float>(count);
  x *= share;
  y *= share;
  z *= share;
  reflectivity *= share;
  // Never zero: every normal points into the ground.
  const float norm = std::sqrt(normal_x * normal_x + normal_y * normal_y + normal_z * normal_z);
  normal_x /= norm;
  normal_y /= norm;
  normal_z /= norm;
}

float Supervoxels::squared_metric(const Profile& a, const Profile& b,
                                  const SupervoxelSettings& settings) {
  const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  const float dc = a.reflectivity - b.reflectivity;
  const float dn =
      1.0F - std::abs(a.normal_x * b.normal_x + a.normal_y * b.normal_y + a.normal_z * b.normal_z);
  const float seed = settings.seed_distance;
  return settings.reflectivity_weight * dc * dc +
         settings.spatial_weight * (dx * dx + dy * dy + dz * dz) / (3.0F * seed * seed) +
         settings.normal_weight * dn * dn;
}

void Supervoxels::segment(const CandidatePoints& edges, const SupervoxelSettings& settings) {
  fill_voxels(edges, settings.voxel_size);
  find_neighbours();
  place_seeds(settings);
  grow(settings);
  label_points(edges);
}

void Supervoxels::fill_voxels(const CandidatePoints& edges, float voxel_size) {
  const PointCloud& points = edges.points;
  point_cells_.build(points, voxel_size, std::numeric_limits<float>::infinity());
  voxels_.clear();
  voxel_centers_.clear();
  voxel_of_.resize(points.size());
  for (std::size_t voxel = 0; voxel < point_cells_.cells(); ++voxel) {
    const Run run = point_cells_.run(voxel);
    Profile mean;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const std::uint32_t point = point_cells_.source(i);
      const float slope_x = edges.slope_x[point], slope_y = edges.slope_y[point];
      const float down = 1.0F / std::sqrt(1.0F + slope_x * slope_x + slope_y * slope_y);
      mean.add({points.x[point], points.y[point], points.z[point],
                points.reflectivity[point] / 255.0F, slope_x * down, slope_y * down, -down});
      voxel_of_[point] = static_cast<std::uint32_t>(voxel);
    }
    mean.average(run.end - run.begin);
    voxels_.push_back(mean);
    voxel_centers_.push_back(mean.x, mean.y, mean.z, mean.reflectivity);
  }
}

void Supervoxels::find_neighbours() {
  neighbours_.assign(voxels_.size() * kNeighbours, kNoLabel);
  std::size_t slot = 0;
  for (int direction = 0; direction < 27; ++direction) {
    if (direction == 13) continue;  // the voxel itself
    point_cells_.for_each_pair(direction / 9 - 1, direction / 3 % 3 - 1, direction % 3 - 1,
                               [&](std::size_t voxel, std::size_t other) {
                                 neighbours_[voxel * kNeighbours + slot] =
                                     static_cast<std::uint32_t>(other);
                               });
    ++slot;
  }
}

// The voxel nearest to the centre of each occupied cell of the seed grid, unless it stands nearly
// alone: with fewer voxels around it than a twentieth of a plane's (as PCL has it).
void Supervoxels::place_seeds(const SupervoxelSettings& settings) {
  const float inverse = 1.0F / settings.seed_distance;
  const float reach = settings.seed_distance / 2;
  const float fill = reach / settings.voxel_size;
  const float least = 0.05F * std::numbers::pi_v<float> * fill * fill;
  const auto squared_distance = [&](std::uint32_t voxel, float x, float y, float z) {
    const float dx = voxels_[voxel].x - x, dy = voxels_[voxel].y - y, dz = voxels_[voxel].z - z;
    return dx * dx + dy * dy + dz * dz;
  };
  owner_.assign(voxels_.size(), kNoLabel);
  distance_.assign(voxels_.size(), std::numeric_limits<float>::max());
  block_means_.clear();
  seed_cells_.build(voxel_centers_, settings.seed_distance, std::numeric_limits<float>::infinity());
  for (std::size_t cell = 0; cell < seed_cells_.cells(); ++cell) {
    std::uint32_t seed = seed_cells_.source(seed_cells_.run(cell).begin);
    const auto middle = [&](float value) { return (std::floor(value * inverse) + 0.5F) / inverse; };
    const float x = middle(voxels_[seed].x), y = middle(voxels_[seed].y),
                z = middle(voxels_[seed].z);
    float nearest = squared_distance(seed, x, y, z);
    seed_cells_.for_each_near(x, y, z, [&](std::uint32_t voxel) {
      const float square = squared_distance(voxel, x, y, z);
      if (square >= nearest) return;
      nearest = square;
      seed = voxel;
    });
    if (owner_[seed] != kNoLabel) continue;  // the nearest to another cell's centre, too
    const Profile& center = voxels_[seed];
    std::size_t around = 0;
    seed_cells_.for_each_near(center.x, center.y, center.z, [&](std::uint32_t voxel) {
      if (squared_distance(voxel, center.x, center.y, center.z) <= reach * reach) ++around;
    });
    if (static_cast<float>(around) <= least) continue;
    owner_[seed] = static_cast<std::uint32_t>(block_means_.size());
    block_means_.push_back(center);
  }
}

// All blocks grow at once: in every round each looks one voxel further, and takes what is nearer to
// its mean than to the present owner's. 1.8 Rseed bounds a block, as in PCL.
void Supervoxels::grow(const SupervoxelSettings& settings) {
  const int rounds =
      static_cast<int>(std::min(1.8F * settings.seed_distance / settings.voxel_size, 1000.0F));
  next_owner_.resize(voxels_.size());
  for (int round = 1; round < rounds; ++round) {
    std::copy(owner_.begin(), owner_.end(), next_owner_.begin());
    for (std::size_t voxel = 0; voxel < voxels_.size(); ++voxel) {
      const std::uint32_t block = owner_[voxel];
      if (block == kNoLabel) continue;
      for (std::size_t slot = 0; slot < kNeighbours; ++slot) {
        const std::uint32_t neighbour = neighbours_[voxel * kNeighbours + slot];
        if (neighbour == kNoLabel || next_owner_[neighbour] == block) continue;
        const float metric = squared_metric(block_means_[block], voxels_[neighbour], settings);
        if (metric < distance_[neighbour]) {
          distance_[neighbour] = metric;
          next_owner_[neighbour] = block;
        }
      }
    }
    if (std::equal(owner_.begin(), owner_.end(), next_owner_.begin())) break;
    std::swap(owner_, next_owner_);
    average_blocks();
  }
}

void Supervoxels::average_blocks() {
  block_voxels_.assign(block_means_.size(), 0);
  for (std::size_t voxel = 0; voxel < voxels_.size(); ++voxel) {
    const std::uint32_t block = owner_[voxel];
    if (block == kNoLabel) continue;
    if (block_voxels_[block]++ == 0) block_means_[block] = {};
    block_means_[block].add(voxels_[voxel]);
  }
  for (std::size_t block = 0; block < block_means_.size(); ++block) {
    if (block_voxels_[block] > 0) block_means_[block].average(block_voxels_[block]);
  }
}

void Supervoxels::label_points(const CandidatePoints& edges) {
  labels_.resize(edges.size());
  block_points_.assign(block_means_.size(), 0);
  centers_.resize(block_means_.size());
  for (auto* axis : {&centers_.x, &centers_.y, &centers_.z, &centers_.reflectivity}) {
    std::fill(axis->begin(), axis->end(), 0.0F);
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::uint32_t block = owner_[voxel_of_[i]];
    labels_[i] = block;
    if (block == kNoLabel) continue;
    // Running means stay near the points, where float is exact enough.
    const float share = 1.0F / static_cast<float>(++block_points_[block]);
    centers_.x[block] += (edges.points.x[i] - centers_.x[block]) * share;
    centers_.y[block] += (edges.points.y[i] - centers_.y[block]) * share;
    centers_.z[block] += (edges.points.z[i] - centers_.z[block]) * share;
    centers_.reflectivity[block] +=
        (edges.points.reflectivity[i] - centers_.reflectivity[block]) * share;
  }
  remove_small(1);
}

void Supervoxels::remove_small(std::uint32_t min_points) {
  new_label_.assign(centers_.size(), kNoLabel);
  std::uint32_t count = 0;
  for (std::size_t block = 0; block < centers_.size(); ++block) {
    if (block_points_[block] < min_points) continue;
    centers_.x[count] = centers_.x[block];
    centers_.y[count] = centers_.y[block];
    centers_.z[count] = centers_.z[block];
    centers_.reflectivity[count] = centers_.reflectivity[block];
    block_points_[count] = block_points_[block];
    new_label_[block] = count++;
  }
  centers_.resize(count);
  block_points_.resize(count);
  for (std::uint32_t& label : labels_) {
    if (label != kNoLabel) label = new_label_[label];
  }
}

}  // namespace scree
