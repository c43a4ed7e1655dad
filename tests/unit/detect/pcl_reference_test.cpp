// The stages that PCL has too, against PCL, on synthetic clouds and on real ones.
#include <gtest/gtest.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <filesystem>
#include <map>
#include <set>

#include "detect/clouds.hpp"
#include "scree/core/pcl_cloud.hpp"
#include "scree/detect/cell.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/euclidean_clusters.hpp"
#include "scree/detect/kd_tree_clusters.hpp"
#include "scree/detect/label.hpp"
#include "scree/detect/supervoxels.hpp"
#include "scree/detect/voxel_grid.hpp"

namespace scree {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZI>;

/// A real cloud of an off-road robot, or nothing where the recordings are absent.
std::optional<PointCloud> recording(const std::string& name) {
  const std::string file = std::string(SCREE_SHARED_DATA) + "/clouds/" + name;
  PclCloud read;
  if (!std::filesystem::exists(file) || pcl::io::loadPCDFile(file, read) != 0) return std::nullopt;
  return from_pcl(read);
}

std::vector<PointCloud> clouds() {
  std::vector<PointCloud> all;
  all.push_back(test::bump_and_bowl(60'000));
  all.push_back(test::scattered(20'000, 10, 2));
  for (const char* name : {"offroad_marv.pcd", "offroad_husky.pcd"}) {
    if (auto cloud = recording(name)) {
      all.push_back(std::move(*cloud));
    } else {
      std::cout << "not compared on " << name << ": no such recording in " << SCREE_SHARED_DATA
                << "\n";
    }
  }
  return all;
}

PointCloud thinned(PointView cloud, float leaf) {
  PointCloud out(cloud.size());
  VoxelGrid(cloud.size()).filter(cloud, leaf, reach_of_cells(leaf, cloud.size(), 3), out);
  return out;
}

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(float x, float y, float z, float leaf) {
  const float inverse = 1 / leaf;
  return {std::int64_t(std::floor(x * inverse)), std::int64_t(std::floor(y * inverse)),
          std::int64_t(std::floor(z * inverse))};
}

TEST(PclReference, VoxelGridHasTheSameVoxelsAndCentroids) {
  for (const PointCloud& cloud : clouds()) {
    for (const float leaf : {0.0592F, 0.25F}) {
      pcl::VoxelGrid<pcl::PointXYZI> reference;
      reference.setInputCloud(to_pcl(cloud));
      reference.setLeafSize(leaf, leaf, leaf);
      PclCloud expected;
      reference.filter(expected);

      const PointCloud actual = thinned(cloud, leaf);
      ASSERT_EQ(actual.size(), expected.size());
      // A centroid may round onto its voxel's rim: sort both by voxel, then compare as they stand.
      const auto by_voxel = [&](const auto& a, const auto& b) {
        return cell_of(a[0], a[1], a[2], leaf) < cell_of(b[0], b[1], b[2], leaf);
      };
      std::vector<std::array<float, 4>> ours, theirs;
      for (std::size_t i = 0; i < actual.size(); ++i) {
        ours.push_back({actual.x[i], actual.y[i], actual.z[i], actual.reflectivity[i]});
        theirs.push_back({expected[i].x, expected[i].y, expected[i].z, expected[i].intensity});
      }
      std::ranges::sort(ours, by_voxel);
      std::ranges::sort(theirs, by_voxel);
      std::size_t far_apart = 0;
      for (std::size_t i = 0; i < ours.size(); ++i) {
        // PCL sums in float: a centroid is off by some roundings of the largest coordinate.
        for (std::size_t k = 0; k < 3; ++k)
          far_apart += std::abs(ours[i][k] - theirs[i][k]) > 1e-4F;
        far_apart += std::abs(ours[i][3] - theirs[i][3]) > 1e-2F;
      }
      EXPECT_EQ(far_apart, 0U);
    }
  }
}

using Sets = std::set<std::set<std::uint32_t>>;

/// The points of each cluster that a stage finds.
template <class Stage>
Sets sets_of(const PointCloud& cloud, float tolerance) {
  Stage clusters(cloud.size());
  clusters.cluster(cloud, tolerance);
  std::map<std::uint32_t, std::set<std::uint32_t>> by_label;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) by_label[clusters.labels()[i]].insert(i);
  Sets sets;
  for (const auto& [label, members] : by_label) sets.insert(members);
  return sets;
}

TEST(PclReference, EuclideanClustersAreTheSameSets) {
  for (const PointCloud& whole : clouds()) {
    const PointCloud cloud = thinned(whole, 0.2F);
    for (const float tolerance : {0.1F, 0.21F, 0.35F}) {
      const auto input = to_pcl(cloud);
      auto tree = std::make_shared<pcl::search::KdTree<pcl::PointXYZI>>();
      tree->setInputCloud(input);
      pcl::EuclideanClusterExtraction<pcl::PointXYZI> reference;
      reference.setClusterTolerance(tolerance);
      reference.setMinClusterSize(1);
      reference.setSearchMethod(tree);
      reference.setInputCloud(input);
      std::vector<pcl::PointIndices> found;
      reference.extract(found);
      Sets expected;
      for (const auto& cluster : found) {
        expected.emplace(cluster.indices.begin(), cluster.indices.end());
      }
      EXPECT_TRUE(sets_of<EuclideanClusters>(cloud, tolerance) == expected) << tolerance;
      EXPECT_TRUE(sets_of<KdTreeClusters>(cloud, tolerance) == expected) << tolerance;
    }
  }
}

/// Edge points of a cloud: all points that have a slope, so that PCL gets the same normals.
CandidatePoints with_slopes(const PointCloud& cloud) {
  const ElevationGradient gradient{0.1F, 0.15F, 0.3F, 1};
  PlaneCells cells(cloud.size());
  cells.build(cloud, gradient.reach());
  std::vector<float> slope_x(cloud.size()), slope_y(cloud.size());
  gradient.compute(cells, slope_x, slope_y);
  CandidatePoints edges(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!std::isnan(slope_x[i])) edges.push_back(cells.points(), i, slope_x[i], slope_y[i]);
  }
  return edges;
}

struct BlockStatistics {
  double count = 0, mean_size = 0, median_size = 0, assigned = 0, mean_radius = 0;
};

BlockStatistics statistics(const CandidatePoints& edges, std::span<const std::uint32_t> labels) {
  std::map<std::uint32_t, std::vector<std::size_t>> blocks;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != kNoLabel) blocks[labels[i]].push_back(i);
  }
  BlockStatistics result;
  std::vector<std::size_t> sizes;
  for (const auto& [label, members] : blocks) {
    sizes.push_back(members.size());
    result.assigned += static_cast<double>(members.size());
    double x = 0, y = 0, z = 0;
    const auto share = 1.0 / static_cast<double>(members.size());
    for (const std::size_t i : members) {
      x += edges.points.x[i] * share;
      y += edges.points.y[i] * share;
      z += edges.points.z[i] * share;
    }
    for (const std::size_t i : members) {
      result.mean_radius +=
          std::hypot(edges.points.x[i] - x, edges.points.y[i] - y, edges.points.z[i] - z);
    }
  }
  std::ranges::sort(sizes);
  result.count = static_cast<double>(blocks.size());
  result.mean_size = result.assigned / result.count;
  result.median_size = static_cast<double>(sizes[sizes.size() / 2]);
  result.mean_radius /= result.assigned;
  result.assigned /= static_cast<double>(edges.size());
  return result;
}

// PCL's metric is a weighted sum where the paper's is a root of squares, and PCL grows block after
// block where ours grow at once, so blocks differ one by one; their statistics must not.
TEST(PclReference, SupervoxelsAgreeStatistically) {
  const float voxel = 0.08F, seed = 0.3F;
  for (const PointCloud& whole : clouds()) {
    const CandidatePoints edges = with_slopes(thinned(whole, 0.06F));
    ASSERT_GT(edges.size(), 1000U);
    auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZRGBA>>();
    auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      pcl::PointXYZRGBA point;
      point.x = edges.points.x[i];
      point.y = edges.points.y[i];
      point.z = edges.points.z[i];
      point.r = point.g = point.b = 128;
      points->push_back(point);
      const Eigen::Vector3f normal =
          Eigen::Vector3f(edges.slope_x[i], edges.slope_y[i], -1).normalized();
      normals->push_back(pcl::Normal(normal.x(), normal.y(), normal.z()));
    }
    pcl::SupervoxelClustering<pcl::PointXYZRGBA> reference(voxel, seed);
    reference.setUseSingleCameraTransform(false);
    reference.setInputCloud(points);
    reference.setNormalCloud(normals);
    reference.setColorImportance(0);
    reference.setSpatialImportance(0.4F);
    reference.setNormalImportance(1.0F);
    std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZRGBA>::Ptr> found;
    reference.extract(found);
    std::vector<std::uint32_t> labels(edges.size(), kNoLabel);
    const auto labelled = reference.getLabeledCloud();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if ((*labelled)[i].label != 0) labels[i] = (*labelled)[i].label;
    }
    const BlockStatistics expected = statistics(edges, labels);

    Supervoxels ours(edges.size());
    ours.segment(edges, {voxel, seed, 0.0F, 0.4F, 1.0F});
    const BlockStatistics actual = statistics(edges, ours.labels());

    EXPECT_NEAR(actual.count / expected.count, 1, 0.2);
    EXPECT_NEAR(actual.mean_size / expected.mean_size, 1, 0.2);
    EXPECT_NEAR(actual.median_size, expected.median_size, 0.2 * expected.median_size);
    EXPECT_NEAR(actual.mean_radius, expected.mean_radius, 0.2 * voxel);
    EXPECT_NEAR(actual.assigned, expected.assigned, 0.01);
  }
}

}  // namespace
}  // namespace scree
