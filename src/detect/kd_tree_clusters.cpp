#include "scree/detect/kd_tree_clusters.hpp"

#include <algorithm>
#include <nanoflann.hpp>
#include <numeric>
#include <vector>

#include "scree/detect/label.hpp"

namespace scree {

/// What nanoflann asks of the points.
struct KdTreeClusters::TreePoints {
  PointView points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i];
  }
};

/// nanoflann builds the tree. Its nodes come from memory taken once, instead of from the pool that
/// nanoflann's own index frees and takes anew with each cloud.
class KdTreeClusters::Tree
    : public nanoflann::KDTreeBaseClass<
          KdTreeClusters::Tree, nanoflann::L2_Simple_Adaptor<float, TreePoints>, TreePoints, 3> {
  struct Nodes {
    FixedVector<Node> nodes;

    template <class T>
    T* allocate() {
      nodes.resize(nodes.size() + 1);
      return &nodes.back();
    }
    void free_all() { nodes.clear(); }
  };

public:
  // By these names the base class asks for them. nanoflann 1.5 changed them, and those of its own.
#if NANOFLANN_VERSION < 0x150
  TreePoints dataset{};
  Nodes pool;
#define SCREE_TREE_NAME(before, since) before
#else
  TreePoints dataset_{};
  Nodes pool_;
#define SCREE_TREE_NAME(before, since) since
#endif

  explicit Tree(std::size_t max_points)
      : SCREE_TREE_NAME(pool, pool_){FixedVector<Node>(2 * max_points)} {
    SCREE_TREE_NAME(m_leaf_max_size, leaf_max_size_) = kLeafPoints;
    SCREE_TREE_NAME(dim, dim_) = 3;
    order_.reserve(max_points);
  }

  void build(PointView points) {
    points_ = points;
    freeIndex(*this);
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0U);
    if (points.size() == 0) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto values = axis == 0 ? points.x : axis == 1 ? points.y : points.z;
      const auto [low, high] = std::ranges::minmax(values);
      bounds_[axis] = {low, high};
    }
    root_ = divideTree(*this, 0, points.size(), bounds_);
  }

  /// Calls visit(index) for the points whose squared distance from point i is no more than this.
  template <class Visit>
  void for_each_within(std::uint32_t i, float square, Visit&& visit) const {
    if (root_ != nullptr) descend(*root_, i, square, visit);
  }

private:
  static constexpr std::size_t kLeafPoints = 16;

  template <class Visit>
  void descend(const Node& node, std::uint32_t i, float square, Visit& visit) const {
    if (node.child1 == nullptr) {
      for (auto at = node.node_type.lr.left; at < node.node_type.lr.right; ++at) {
        if (square_distance(i, order_[at]) <= square) visit(order_[at]);
      }
      return;
    }
    const auto& cut = node.node_type.sub;
    const float place = TreePoints{points_}.kdtree_get_pt(i, static_cast<std::size_t>(cut.divfeat));
    // Rounding never makes a distance along one axis larger than the distance, so nothing is lost.
    const float to_low = place - cut.divlow, to_high = cut.divhigh - place;
    if (to_low <= 0 || to_low * to_low <= square) descend(*node.child1, i, square, visit);
    if (to_high <= 0 || to_high * to_high <= square) descend(*node.child2, i, square, visit);
  }

  float square_distance(std::uint32_t i, std::uint32_t j) const {
    const float dx = points_.x[i] - points_.x[j], dy = points_.y[i] - points_.y[j],
                dz = points_.z[i] - points_.z[j];
    return dx * dx + dy * dy + dz * dz;
  }

  PointView& points_ = SCREE_TREE_NAME(dataset, dataset_).points;
  std::vector<std::uint32_t>& order_ = SCREE_TREE_NAME(vAcc, vAcc_);
  BoundingBox& bounds_ = SCREE_TREE_NAME(root_bbox, root_bbox_);
  NodePtr& root_ = SCREE_TREE_NAME(root_node, root_node_);
#undef SCREE_TREE_NAME
};

KdTreeClusters::KdTreeClusters(std::size_t max_points)
    : tree_(std::make_unique<Tree>(max_points)),
      labels_(max_points),
      sizes_(max_points),
      queue_(max_points) {}
KdTreeClusters::~KdTreeClusters() = default;
KdTreeClusters::KdTreeClusters(KdTreeClusters&&) noexcept = default;
KdTreeClusters& KdTreeClusters::operator=(KdTreeClusters&&) noexcept = default;

void KdTreeClusters::cluster(PointView points, float tolerance) {
  tree_->build(points);
  labels_.assign(points.size(), kNoLabel);
  sizes_.clear();
  for (std::uint32_t seed = 0; seed < points.size(); ++seed) {
    if (labels_[seed] != kNoLabel) continue;
    const auto label = static_cast<std::uint32_t>(sizes_.size());
    queue_.clear();
    const auto take = [&](std::uint32_t i) {
      if (labels_[i] != kNoLabel) return;
      labels_[i] = label;
      queue_.push_back(i);
    };
    take(seed);
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      tree_->for_each_within(queue_[next], tolerance * tolerance, take);
    }
    sizes_.push_back(static_cast<std::uint32_t>(queue_.size()));
  }
}

}  // namespace scree
