#include "simulator/feature_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "simulator/curves.hpp"

namespace scree {
namespace {

enum FeatureStream : std::uint64_t { kHoles = 201, kRocks, kSmooth, kSmall, kClose };

/// Shapes that keep their places to one another, about an origin of their own.
struct Group {
  std::vector<PlacedShape> members;
  double reach() const {
    double reach = 0;
    for (const PlacedShape& member : members) {
      reach = std::max(reach, member.center.norm() + member.shape.reach());
    }
    return reach;
  }
};

bool is_smooth(ShapeKind kind) {
  return !is_positive(kind) && !is_negative(kind);
}

Footprint moved(Footprint footprint, const Eigen::Vector2d& by) {
  for (Eigen::Vector2d& corner : footprint) corner += by;
  return footprint;
}

class Drawing {
public:
  Drawing(const ShapeWeights& weights, Random random) : weights_(weights), random_(random) {}

  Group rock() { return one(ShapeKind::boulder, ShapeKind::pillar); }
  Group hole() { return one(ShapeKind::bowl, ShapeKind::ditch); }
  Group smooth() { return one(ShapeKind::mound, ShapeKind::hollow); }

  Group small() {
    const bool dent = random_.chance(0.3);
    const ShapeKind kind = dent ? kind_of(ShapeKind::bowl, ShapeKind::pothole)
                                : kind_of(ShapeKind::boulder, ShapeKind::bump);
    const SizeRange size = dent ? SizeRange{0.05, 0.17} : SizeRange{0.05, 0.12};
    PlacedShape stone{Shape::draw(kind, random_, size)};
    stone.is_small = true;
    return {{stone}};
  }

  /// Two rocks, every other time both tall.
  Group pair() {
    const bool tall = random_.chance(0.5);
    const auto rock = [&] {
      if (tall) {
        return Shape::draw(kind_of(ShapeKind::boulder, ShapeKind::bump), random_,
                           SizeRange{0.5, 1.2});
      }
      return Shape::draw(kind_of(ShapeKind::boulder, ShapeKind::ledge), random_);
    };
    Shape first = rock();
    return side_by_side(first, rock());
  }

  Group neighbours() {
    Shape hole = Shape::draw(ShapeKind::pothole, random_);
    return side_by_side(hole, Shape::draw(kind_of(ShapeKind::boulder, ShapeKind::bump), random_));
  }

  /// A hole or a rock in a hollow or on the flank of a mound.
  Group nest() {
    const bool hollow = random_.chance(0.6);
    const bool hole = random_.chance(hollow ? 0.7 : 0.3);
    PlacedShape inner{hole ? Shape::draw(kind_of(ShapeKind::pit, ShapeKind::pothole), random_)
                           : Shape::draw(kind_of(ShapeKind::boulder, ShapeKind::bump), random_)};
    constexpr int kTries = 10;
    const ShapeKind around = hollow ? ShapeKind::hollow : ShapeKind::mound;
    PlacedShape outer{Shape::draw(around, random_)};
    for (int i = 0; i < kTries && outer.shape.reach() < inner.shape.reach() + 0.8; ++i) {
      outer.shape = Shape::draw(around, random_);
    }
    const double share = hollow ? random_.uniform(0, 0.4) : random_.uniform(0.3, 0.6);
    inner.center = share * outer.shape.reach() * direction();
    return {{outer, inner}};
  }

  Random& random() { return random_; }

private:
  ShapeKind kind_of(ShapeKind first, ShapeKind last) {
    const auto from = static_cast<std::size_t>(first);
    const auto count = static_cast<std::size_t>(last) - from + 1;
    const auto weights = std::span(weights_).subspan(from, count);
    double drawn = random_.uniform(0, std::accumulate(weights.begin(), weights.end(), 0.0));
    std::size_t kind = 0;
    while (kind + 1 < count && drawn >= weights[kind]) drawn -= weights[kind++];
    return static_cast<ShapeKind>(from + kind);
  }

  Group one(ShapeKind first, ShapeKind last) {
    const ShapeKind kind = kind_of(first, last);
    return {{PlacedShape{Shape::draw(kind, random_)}}};
  }

  Eigen::Vector2d direction() { return unit_vector(random_.uniform(0, 2 * std::numbers::pi)); }

  Group side_by_side(const Shape& first, const Shape& second) {
    const double gap = random_.chance(0.4) ? random_.uniform(0.3, 0.33) : random_.uniform(0.3, 0.6);
    const Eigen::Vector2d way = direction();
    const Footprint a = first.footprint();
    const Footprint b = second.footprint();
    double near = 0;
    double far = first.reach() + second.reach() + gap;
    constexpr int kHalvings = 24;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (near + far) / 2;
      (distance(a, moved(b, middle * way)) < gap ? near : far) = middle;
    }
    const Eigen::Vector2d half = far / 2 * way;
    return {{PlacedShape{first, -half, 1}, PlacedShape{second, half, 0}}};
  }

  ShapeWeights weights_;
  Random random_;
};

/// What has been placed so far, and whether there is room for more.
class Ground {
public:
  Ground(const TerrainSettings& settings, const IsTaken& is_taken)
      : settings_(settings), is_taken_(is_taken) {}

  void place(std::vector<Group> groups, Random& random) {
    // Large ones first, while there is room for them.
    std::stable_sort(groups.begin(), groups.end(),
                     [](const Group& a, const Group& b) { return a.reach() > b.reach(); });
    for (const Group& group : groups) {
      constexpr int kTries = 200;
      for (int i = 0; i < kTries && !try_to_place(group, random); ++i) continue;
    }
  }

  std::vector<PlacedShape> placed() && { return std::move(placed_); }

private:
  /// Where to try next; nothing where the terrain has no room for it.
  bool draw_center(double reach, Random& random, Eigen::Vector2d& center) const {
    const double most = settings_.size / 2 - reach;
    if (settings_.corridor.empty()) {
      const double within = std::min(settings_.placed_within - reach, most);
      center = {random.uniform(-within, within), random.uniform(-within, within)};
      return within > 0;
    }
    const Eigen::Vector2d& by = settings_.corridor[random.index(settings_.corridor.size())];
    // Denser near the way, where a low sensor sees into holes.
    const double away = settings_.placed_within * std::pow(random.uniform(), 0.8);
    center = by + away * unit_vector(random.uniform(0, 2 * std::numbers::pi));
    return center.cwiseAbs().maxCoeff() < most;
  }

  bool try_to_place(const Group& group, Random& random) {
    Eigen::Vector2d center;
    if (!draw_center(group.reach(), random, center)) return false;
    std::vector<PlacedShape> members = group.members;
    std::vector<Footprint> footprints;
    footprints.reserve(members.size());
    for (PlacedShape& member : members) {
      member.center += center;
      footprints.push_back(moved(member.shape.footprint(), member.center));
      if (!is_free(member, footprints.back())) return false;
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].partner >= 0) {
        members[i].partner += static_cast<int>(placed_.size() - i);
      }
      placed_.push_back(members[i]);
      footprints_.push_back(footprints[i]);
    }
    return true;
  }

  bool is_free(const PlacedShape& shape, const Footprint& footprint) const {
    const double reach = shape.shape.reach();
    if (settings_.clear_radius > 0 &&
        shape.center.norm() < settings_.clear_radius + reach + settings_.gap) {
      return false;
    }
    if (is_taken_ && is_taken_(shape.center, reach + settings_.gap)) return false;
    const double off = settings_.corridor_half_width + shape.shape.margin();
    for (const Eigen::Vector2d& by : settings_.corridor) {
      if (is_smooth(shape.shape.kind())) break;
      if ((by - shape.center).norm() > off + reach) continue;
      if (distance(footprint, by) < off) return false;
    }
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const Shape& other = placed_[i].shape;
      const double apart = (placed_[i].center - shape.center).norm();
      if (apart > reach + other.reach() + settings_.gap) continue;
      const double least = settings_.gap + shape.shape.margin() + other.margin();
      if (distance(footprint, footprints_[i]) < least) return false;
    }
    return true;
  }

  const TerrainSettings& settings_;
  const IsTaken& is_taken_;
  std::vector<PlacedShape> placed_;
  std::vector<Footprint> footprints_;
};

template <class Draw>
std::vector<Group> several(int count, Draw draw) {
  std::vector<Group> groups;
  groups.reserve(static_cast<std::size_t>(std::max(count, 0)));
  for (int i = 0; i < count; ++i) groups.push_back(draw());
  return groups;
}

}  // namespace

std::vector<PlacedShape> lay_out_features(const TerrainSettings& settings, std::uint64_t seed,
                                          const IsTaken& is_taken) {
  Ground ground(settings, is_taken);
  int rocks = settings.positive;
  int holes = settings.negative;
  int smooth = settings.smooth;

  Drawing close(settings.weights, Random(seed, kClose));
  std::vector<Group> groups;
  for (int i = 0; i < settings.pairs && rocks >= 2; ++i, rocks -= 2) groups.push_back(close.pair());
  for (int i = 0; i < settings.neighbours && rocks >= 1 && holes >= 1; ++i, --rocks, --holes) {
    groups.push_back(close.neighbours());
  }
  for (int i = 0; i < settings.nests && smooth >= 1; ++i) {
    Group nest = close.nest();
    int& left = is_positive(nest.members.back().shape.kind()) ? rocks : holes;
    if (left == 0) continue;
    --left;
    --smooth;
    groups.push_back(std::move(nest));
  }
  ground.place(std::move(groups), close.random());

  Drawing of_holes(settings.weights, Random(seed, kHoles));
  ground.place(several(holes, [&] { return of_holes.hole(); }), of_holes.random());
  Drawing of_rocks(settings.weights, Random(seed, kRocks));
  ground.place(several(rocks, [&] { return of_rocks.rock(); }), of_rocks.random());
  Drawing of_smooth(settings.weights, Random(seed, kSmooth));
  ground.place(several(smooth, [&] { return of_smooth.smooth(); }), of_smooth.random());
  Drawing of_small(settings.weights, Random(seed, kSmall));
  ground.place(several(settings.small, [&] { return of_small.small(); }), of_small.random());
  return std::move(ground).placed();
}

}  // namespace scree
