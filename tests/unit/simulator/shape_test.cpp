#include "simulator/shape.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <ostream>

namespace scree {

void PrintTo(ShapeKind kind, std::ostream* out) {
  *out << name_of(kind);
}

namespace {

struct Measured {
  double highest = 0, lowest = 0;
  double length = 0, width = 0;  ///< of the footprint's box along its longest way
};

Measured measure(const Shape& shape) {
  Measured measured;
  const double step = std::max(shape.reach() / 60, 0.01);
  for (double x = -shape.reach(); x <= shape.reach(); x += step) {
    for (double y = -shape.reach(); y <= shape.reach(); y += step) {
      const double height = shape.height({x, y});
      measured.highest = std::max(measured.highest, height);
      measured.lowest = std::min(measured.lowest, height);
    }
  }
  const Footprint footprint = shape.footprint();
  Eigen::Vector2d along(1, 0);
  for (const Eigen::Vector2d& a : footprint) {
    for (const Eigen::Vector2d& b : footprint) {
      if ((a - b).norm() <= measured.length) continue;
      measured.length = (a - b).norm();
      along = (a - b).normalized();
    }
  }
  const Eigen::Vector2d across(-along.y(), along.x());
  double least = 1e9;
  double most = -1e9;
  for (const Eigen::Vector2d& corner : footprint) {
    least = std::min(least, corner.dot(across));
    most = std::max(most, corner.dot(across));
  }
  measured.width = most - least;
  return measured;
}

class EveryShape : public testing::TestWithParam<ShapeKind> {};

TEST_P(EveryShape, HasTheSizeItsKindSays) {
  const ShapeKind kind = GetParam();
  Random random(1, static_cast<std::uint64_t>(kind));
  for (int i = 0; i < 20; ++i) {
    const Shape shape = Shape::draw(kind, random);
    const Measured measured = measure(shape);
    if (is_positive(kind)) {
      EXPECT_GT(measured.highest, 0.14);
      EXPECT_LT(measured.highest, kind == ShapeKind::pillar ? 1.61 : is_long(kind) ? 0.51 : 1.21);
      EXPECT_EQ(measured.lowest, 0);
    } else if (is_negative(kind)) {
      EXPECT_LT(measured.lowest, -0.19);
      EXPECT_GT(measured.lowest, -1.01);
      EXPECT_LT(measured.highest, kind == ShapeKind::crater ? 0.31 : 1e-9);
    }
    if (is_long(kind)) {
      EXPECT_GT(measured.length, 0.99);
      EXPECT_LT(measured.length, 6.6);
    }
    if (kind == ShapeKind::pothole) {
      EXPECT_GT(measured.length, 0.28);
      EXPECT_LT(measured.length, 1.3);
    }
  }
}

TEST_P(EveryShape, IsFlatBeyondItsReachAndOutlinedByItsFootprint) {
  const ShapeKind kind = GetParam();
  Random random(2, static_cast<std::uint64_t>(kind));
  for (int i = 0; i < 5; ++i) {
    const Shape shape = Shape::draw(kind, random);
    const Footprint footprint = shape.footprint();
    int differ = 0;
    int inside = 0;
    const double step = shape.reach() / 60;
    for (double x = -1.5 * shape.reach(); x <= 1.5 * shape.reach(); x += step) {
      for (double y = -1.5 * shape.reach(); y <= 1.5 * shape.reach(); y += step) {
        const Eigen::Vector2d at(x, y);
        if (at.norm() > shape.reach() + 1e-9) {
          EXPECT_EQ(shape.height(at), 0);
        }
        if (distance(footprint, at) > shape.margin() + 0.02) {
          EXPECT_NEAR(shape.height(at), 0, 0.02);
        }
        inside += shape.inside(at) ? 1 : 0;
        differ += shape.inside(at) != contains(footprint, at) ? 1 : 0;
      }
    }
    EXPECT_LT(differ, inside / 10 + 5);
  }
}

TEST(Undercut, IsAirBelowARockAroundWhereItTouchesTheGround) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Shape in_ground = Shape::draw(i % 2 == 0 ? ShapeKind::boulder : ShapeKind::log, random);
    Shape on_ground = in_ground;
    on_ground.undercut(random);
    EXPECT_EQ(on_ground.underside({0, 0}), 0);
    for (const Eigen::Vector2d& corner : on_ground.footprint()) {
      double air = 0;
      for (double share = 0; share < 0.99; share += 0.05) {
        const double deeper = on_ground.underside(share * corner);
        EXPECT_GE(deeper, air);
        EXPECT_LE(deeper, on_ground.height(share * corner));
        EXPECT_EQ(in_ground.underside(share * corner), 0);
        air = deeper;
      }
      EXPECT_GT(on_ground.underside(0.98 * corner), 0);
      EXPECT_EQ(on_ground.underside(1.01 * corner), 0);
      EXPECT_EQ(on_ground.height(1.01 * corner), 0);
    }
  }
}

TEST(Pillar, IsUprightOnAllSides) {
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const Shape pillar = Shape::draw(ShapeKind::pillar, random);
    const double top = pillar.height({0, 0});
    for (const Eigen::Vector2d& corner : pillar.footprint()) {
      const double away = corner.norm();
      EXPECT_LT(pillar.height((away + 0.02) / away * corner), 0.05 * top);
      if (away > 0.25) continue;  // along a wall its flank is as oblique as the wall is thin
      EXPECT_GT(pillar.height((away - 0.05) / away * corner), 0.5 * top);
    }
  }
}

/// The share that a footprint covers of the smallest rectangle around it.
double share_of_its_box(const Footprint& footprint) {
  double area = 0;
  for (std::size_t a = 0, b = footprint.size() - 1; a < footprint.size(); b = a++) {
    area += (footprint[b].x() * footprint[a].y() - footprint[a].x() * footprint[b].y()) / 2;
  }
  double smallest = 1e9;
  for (double angle = 0; angle < 1.58; angle += 0.01) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : footprint) {
      box.extend(Eigen::Rotation2Dd(angle) * corner);
    }
    smallest = std::min(smallest, box.volume());
  }
  return area / smallest;
}

TEST(Pillar, IsRoundOrSquareSeenFromAbove) {
  Random random(4);
  int round = 0;
  int square = 0;
  for (int i = 0; i < 40; ++i) {
    const double share = share_of_its_box(Shape::draw(ShapeKind::pillar, random).footprint());
    EXPECT_GT(share, 0.7);
    (share < 0.85 ? round : square) += 1;
  }
  EXPECT_GT(round, 10);
  EXPECT_GT(square, 10);
}

std::vector<ShapeKind> all_kinds() {
  std::vector<ShapeKind> kinds;
  for (std::size_t i = 0; i < kShapeKinds; ++i) kinds.push_back(static_cast<ShapeKind>(i));
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryShape, testing::ValuesIn(all_kinds()),
                         [](const auto& which) { return std::string(name_of(which.param)); });

}  // namespace
}  // namespace scree
