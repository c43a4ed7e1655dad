#include "simulator/volumes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr double kCell = 0.5;
// Metres around each volume, so that a beam meets it that enters on a cell's very border or on top.
constexpr double kMargin = 1e-6;

struct Chord {
  double from, to;
};

/// Where a ray is inside a ball of radius 1 about the origin; of a cylinder only y and z count.
std::optional<Chord> chord_of_ball(const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - 1);
  if (discriminant <= 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return Chord{(-b - root) / a, (-b + root) / a};
}

/// Where it is between -1 and 1 along the first `axes` axes.
std::optional<Chord> chord_of_cube(const Eigen::Vector3d& o, const Eigen::Vector3d& d, int axes) {
  constexpr double kParallel = 1e-12;
  Chord chord{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < axes; ++axis) {
    if (std::abs(d[axis]) < kParallel) {
      if (std::abs(o[axis]) > 1) return std::nullopt;
      continue;
    }
    const double one = (-1 - o[axis]) / d[axis];
    const double other = (1 - o[axis]) / d[axis];
    chord.from = std::max(chord.from, std::min(one, other));
    chord.to = std::min(chord.to, std::max(one, other));
  }
  if (chord.from >= chord.to) return std::nullopt;
  return chord;
}

std::optional<Chord> chord_of_cylinder(const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  auto ends = chord_of_cube(o, d, 1);
  if (!ends) return std::nullopt;
  const Eigen::Vector3d across(0, d.y(), d.z());
  if (across.squaredNorm() <= 0) {
    if (Eigen::Vector2d(o.y(), o.z()).squaredNorm() > 1) return std::nullopt;
    return ends;
  }
  const auto mantle = chord_of_ball({0, o.y(), o.z()}, across);
  if (!mantle) return std::nullopt;
  const Chord both{std::max(ends->from, mantle->from), std::min(ends->to, mantle->to)};
  if (both.from >= both.to) return std::nullopt;
  return both;
}

/// The part of a ray inside a volume.
std::optional<Chord> chord(const Volume& volume, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction) {
  const Eigen::Vector3d scale = volume.half.cwiseInverse();
  Eigen::Vector3d from = origin - volume.center;
  Eigen::Vector3d way = direction;
  if (volume.is_turned) {
    from = volume.axes.transpose() * from;
    way = volume.axes.transpose() * way;
  }
  const Eigen::Vector3d o = from.cwiseProduct(scale);
  const Eigen::Vector3d d = way.cwiseProduct(scale);
  switch (volume.form) {
    case Volume::Form::ellipsoid:
      return chord_of_ball(o, d);
    case Volume::Form::box:
      return chord_of_cube(o, d, 3);
    case Volume::Form::cylinder:
      return chord_of_cylinder(o, d);
  }
  return std::nullopt;
}

}  // namespace

Volume Volume::tuft(const Eigen::Vector3d& base, double radius, double height, double density) {
  Volume tuft;
  tuft.center = base;
  tuft.half = {radius, radius, height};
  tuft.density = density;
  return tuft;
}

Volume Volume::rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
  Volume rod;
  rod.form = Form::cylinder;
  rod.center = (from + to) / 2;
  rod.half = {(to - from).norm() / 2, radius, radius};
  rod.density = kSolid;
  rod.axes =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), to - from).toRotationMatrix();
  rod.is_turned = true;
  return rod;
}

Volume Volume::block(const Eigen::Vector3d& center, const Eigen::Vector3d& half, double yaw) {
  Volume block;
  block.form = Form::box;
  block.center = center;
  block.half = half;
  block.density = kSolid;
  block.axes = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  block.is_turned = true;
  return block;
}

double Volume::light_along(int axis) const {
  return std::exp(-density * 2 * half[axis]);
}

Eigen::Vector3d Volume::reach() const {
  return axes.cwiseAbs() * half;
}

std::optional<double> Volume::range_to(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction) const {
  const auto inside = chord(*this, origin, direction);
  return inside && inside->from >= 0 ? std::optional(inside->from) : std::nullopt;
}

Eigen::Vector3d Volume::normal(const Eigen::Vector3d& at) const {
  const Eigen::Vector3d own = (axes.transpose() * (at - center)).cwiseQuotient(half);
  Eigen::Vector3d out = own.cwiseQuotient(half);
  Eigen::Index nearest = 0;
  own.cwiseAbs().maxCoeff(&nearest);
  const bool is_end = std::abs(own.x()) > Eigen::Vector2d(own.y(), own.z()).norm();
  if (form == Form::box || (form == Form::cylinder && is_end)) {
    if (form == Form::cylinder) nearest = 0;
    out = Eigen::Vector3d::Unit(nearest) * own[nearest];
  } else if (form == Form::cylinder) {
    out.x() = 0;
  }
  return (axes * out).normalized();
}

Volumes::Volumes(std::vector<Volume> volumes, double size)
    : half_(size / 2),
      cells_(static_cast<std::size_t>(std::ceil(size / kCell)) + 1),
      volumes_(std::move(volumes)),
      first_(cells_ * cells_ + 1),
      highest_(cells_ * cells_, std::numeric_limits<float>::lowest()),
      lowest_(cells_ * cells_, std::numeric_limits<float>::max()),
      top_(std::numeric_limits<double>::lowest()) {
  const auto for_each_cell = [&](const Volume& volume, auto action) {
    const Eigen::Vector3d reach = volume.reach().array() + kMargin;
    for (std::size_t row = cell_of(volume.center.y() - reach.y());
         row <= cell_of(volume.center.y() + reach.y()); ++row) {
      for (std::size_t column = cell_of(volume.center.x() - reach.x());
           column <= cell_of(volume.center.x() + reach.x()); ++column) {
        action(row * cells_ + column);
      }
    }
  };
  for (const Volume& volume : volumes_) {
    const double top = volume.center.z() + volume.reach().z();
    const double bottom = volume.center.z() - volume.reach().z();
    top_ = std::max(top_, top + kMargin);
    const double radius = volume.reach().head<2>().norm() + kMargin;
    bounds_.push_back(
        {volume.center.x(), volume.center.y(), radius * radius, bottom - kMargin, top + kMargin});
    for_each_cell(volume, [&](std::size_t cell) {
      ++first_[cell + 1];
      highest_[cell] = std::max(highest_[cell], static_cast<float>(top));
      lowest_[cell] = std::min(lowest_[cell], static_cast<float>(bottom));
    });
  }
  for (std::size_t cell = 0; cell < cells_ * cells_; ++cell) first_[cell + 1] += first_[cell];
  members_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < volumes_.size(); ++i) {
    for_each_cell(volumes_[i], [&](std::size_t cell) {
      members_[next[cell]++] = static_cast<std::uint32_t>(i);
    });
  }
}

std::size_t Volumes::cell_of(double coordinate) const {
  const double last = static_cast<double>(cells_ - 1);
  return static_cast<std::size_t>(std::clamp((coordinate + half_) / kCell, 0.0, last));
}

std::optional<VolumeHit> Volumes::cast(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction, double max_range,
                                       Random& random) const {
  if (volumes_.empty()) return std::nullopt;
  constexpr double kNudge = 1e-9;  // over the border into the next cell
  VolumeHit nearest{max_range, nullptr};
  const double level = direction.head<2>().squaredNorm();
  double t = 0;
  if (direction.z() < 0) t = std::max((top_ - origin.z()) / direction.z(), 0.0);
  while (t < nearest.range) {
    const Eigen::Vector3d at = origin + t * direction;
    if (std::abs(at.x()) > half_ || std::abs(at.y()) > half_) break;
    if (at.z() > top_ && direction.z() >= 0) break;
    const std::size_t column = cell_of(at.x());
    const std::size_t row = cell_of(at.y());
    double leave = max_range;
    const auto meet_border = [&](double place, double way, std::size_t cell) {
      if (std::abs(way) < kNudge) return;
      const double border = static_cast<double>(cell + (way > 0 ? 1 : 0)) * kCell - half_;
      leave = std::min(leave, t + (border - place) / way);
    };
    meet_border(at.x(), direction.x(), column);
    meet_border(at.y(), direction.y(), row);
    leave = std::max(leave, t) + kNudge;
    const std::size_t cell = row * cells_ + column;
    const double end = origin.z() + leave * direction.z();
    const double lower = std::min(at.z(), end);
    const double upper = std::max(at.z(), end);
    if (lower < static_cast<double>(highest_[cell]) && upper > static_cast<double>(lowest_[cell])) {
      for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const Bounds& bounds = bounds_[members_[i]];
        if (lower >= bounds.top || upper <= bounds.bottom) continue;
        const double aside =
            (bounds.x - origin.x()) * direction.y() - (bounds.y - origin.y()) * direction.x();
        if (aside * aside > bounds.squared_radius * level) continue;
        const Volume& volume = volumes_[members_[i]];
        const auto inside = chord(volume, origin, direction);
        // A volume in several cells counts in that where the beam enters it.
        if (!inside || inside->from < t || inside->from >= leave) continue;
        const double depth = -std::log(1 - random.uniform()) / volume.density;
        if (depth < inside->to - inside->from && inside->from + depth < nearest.range) {
          nearest = {inside->from + depth, &volume};
        }
      }
    }
    t = leave;
  }
  if (nearest.volume == nullptr) return std::nullopt;
  return nearest;
}

const Volume* Volumes::at(double x, double y) const {
  if (volumes_.empty()) return nullptr;
  const std::size_t cell = cell_of(y) * cells_ + cell_of(x);
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const Volume& volume = volumes_[members_[i]];
    if (volume.form != Volume::Form::ellipsoid || volume.is_turned || volume.part != 0) continue;
    if (std::hypot(x - volume.center.x(), y - volume.center.y()) < volume.half.x()) return &volume;
  }
  return nullptr;
}

bool Volumes::is_near(double x, double y, double distance) const {
  if (volumes_.empty()) return false;
  for (std::size_t row = cell_of(y - distance); row <= cell_of(y + distance); ++row) {
    for (std::size_t column = cell_of(x - distance); column <= cell_of(x + distance); ++column) {
      const std::size_t cell = row * cells_ + column;
      for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const Volume& volume = volumes_[members_[i]];
        const Eigen::Vector3d reach = volume.reach();
        const double away = std::hypot(x - volume.center.x(), y - volume.center.y());
        if (away < std::max(reach.x(), reach.y()) + distance) return true;
      }
    }
  }
  return false;
}

}  // namespace scree
