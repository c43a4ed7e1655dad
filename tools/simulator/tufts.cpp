#include "simulator/tufts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr double kCell = 0.5;

struct Chord {
  double from, to;
};

/// The part of a beam inside a tuft's whole ellipsoid; its lower half lies in the ground.
std::optional<Chord> chord(const Tuft& tuft, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction) {
  const Eigen::Vector3d scale(1 / tuft.radius, 1 / tuft.radius, 1 / tuft.height);
  const Eigen::Vector3d o = (origin - tuft.base).cwiseProduct(scale);
  const Eigen::Vector3d d = direction.cwiseProduct(scale);
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - 1);
  if (discriminant <= 0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return Chord{(-b - root) / a, (-b + root) / a};
}

}  // namespace

Tufts::Tufts(std::vector<Tuft> tufts, double size)
    : half_(size / 2),
      cells_(static_cast<std::size_t>(std::ceil(size / kCell)) + 1),
      tufts_(std::move(tufts)),
      first_(cells_ * cells_ + 1),
      highest_(cells_ * cells_, std::numeric_limits<float>::lowest()),
      top_(std::numeric_limits<double>::lowest()) {
  const auto for_each_cell = [&](const Tuft& tuft, auto action) {
    for (std::size_t row = cell_of(tuft.base.y() - tuft.radius);
         row <= cell_of(tuft.base.y() + tuft.radius); ++row) {
      for (std::size_t column = cell_of(tuft.base.x() - tuft.radius);
           column <= cell_of(tuft.base.x() + tuft.radius); ++column) {
        action(row * cells_ + column);
      }
    }
  };
  for (const Tuft& tuft : tufts_) {
    const double top = tuft.base.z() + tuft.height;
    top_ = std::max(top_, top);
    for_each_cell(tuft, [&](std::size_t cell) {
      ++first_[cell + 1];
      highest_[cell] = std::max(highest_[cell], static_cast<float>(top));
    });
  }
  for (std::size_t cell = 0; cell < cells_ * cells_; ++cell) first_[cell + 1] += first_[cell];
  members_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < tufts_.size(); ++i) {
    for_each_cell(tufts_[i], [&](std::size_t cell) {
      members_[next[cell]++] = static_cast<std::uint32_t>(i);
    });
  }
}

std::size_t Tufts::cell_of(double coordinate) const {
  const double last = static_cast<double>(cells_ - 1);
  return static_cast<std::size_t>(std::clamp((coordinate + half_) / kCell, 0.0, last));
}

std::optional<double> Tufts::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double max_range, Random& random) const {
  if (tufts_.empty()) return std::nullopt;
  constexpr double kNudge = 1e-9;  // over the border into the next cell
  double nearest = max_range;
  double t = 0;
  if (direction.z() < 0) t = std::max((top_ - origin.z()) / direction.z(), 0.0);
  while (t < nearest) {
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
    if (std::min(at.z(), origin.z() + leave * direction.z()) <
        static_cast<double>(highest_[cell])) {
      for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const Tuft& tuft = tufts_[members_[i]];
        const auto inside = chord(tuft, origin, direction);
        // A tuft in several cells counts in that where the beam enters it.
        if (!inside || inside->from < t || inside->from >= leave) continue;
        const double depth = -std::log(1 - random.uniform()) / tuft.density;
        if (depth < inside->to - inside->from) nearest = std::min(nearest, inside->from + depth);
      }
    }
    t = leave;
  }
  if (nearest < max_range) return nearest;
  return std::nullopt;
}

const Tuft* Tufts::at(double x, double y) const {
  if (tufts_.empty()) return nullptr;
  const std::size_t cell = cell_of(y) * cells_ + cell_of(x);
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const Tuft& tuft = tufts_[members_[i]];
    if (std::hypot(x - tuft.base.x(), y - tuft.base.y()) < tuft.radius) return &tuft;
  }
  return nullptr;
}

}  // namespace scree
