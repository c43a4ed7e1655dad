#include "calibrate/calibration_picture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scree/core/pose.hpp"

namespace scree::cli {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kMargin = 50, kPanelWidth = 640, kSectionHeight = 200, kWayHeight = 520;
constexpr double kHeading = 66, kTitle = 26;
constexpr Colour kDot{kText.red, kText.green, kText.blue, 0.35};

/// A part of the page with metres on it, as long upwards as to the right.
class Panel {
public:
  Panel(Drawing& drawing, const Rectangle& area, const Eigen::Vector2d& low,
        const Eigen::Vector2d& high, const std::string& title)
      : drawing_(drawing), area_(area), middle_((low + high) / 2) {
    const Eigen::Vector2d size = high - low;
    scale_ = std::min(area.width / size.x(), area.height / size.y());
    drawing.text(area.x, area.y - 8, title, 13, kText);
    drawing.outline(area, kFaint, 1);
    draw_grid();
  }

  void dots(const Points& points, Colour colour) {
    drawing_.clip(area_);
    for (const Eigen::Vector2d& each : points) {
      const Eigen::Vector2d at = on_page(each);
      drawing_.fill({at.x(), at.y(), 1.5, 1.5}, colour);
    }
    drawing_.unclip();
  }
  void path(const Points& points, Colour colour, double width) {
    drawing_.clip(area_);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Eigen::Vector2d a = on_page(points[i - 1]), b = on_page(points[i]);
      drawing_.line(a.x(), a.y(), b.x(), b.y(), colour, width);
    }
    drawing_.unclip();
  }

private:
  Eigen::Vector2d on_page(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d off = scale_ * (point - middle_);
    return {area_.x + area_.width / 2 + off.x(), area_.y + area_.height / 2 - off.y()};
  }
  void draw_grid() {
    const double across = area_.width / scale_, up = area_.height / scale_;
    double step = 1;
    while (across / step > 12) step *= step < 2 || step >= 5 ? 2 : 2.5;  // 1, 2, 5, 10, 20
    const auto lines = [&](double middle, double size, const auto& draw) {
      for (double at = std::ceil((middle - size / 2) / step) * step; at <= middle + size / 2;
           at += step) {
        draw(at);
      }
    };
    lines(middle_.x(), across, [&](double x) {
      const double at = on_page({x, 0}).x();
      drawing_.line(at, area_.y, at, area_.y + area_.height, kGridOnGround, 1);
      drawing_.text(at + 2, area_.y + area_.height + 13, fmt::format("{:g}", x), 10, kFaint);
    });
    lines(middle_.y(), up, [&](double y) {
      const double at = on_page({0, y}).y();
      drawing_.line(area_.x, at, area_.x + area_.width, at, kGridOnGround, y == 0 ? 3 : 1);
      const std::string text = fmt::format("{:g}", y);
      drawing_.text(area_.x - 5 - drawing_.text_width(text, 10), at + 4, text, 10, kFaint);
    });
  }

  Drawing& drawing_;
  Rectangle area_;
  Eigen::Vector2d middle_;
  double scale_ = 1;
};

/// What lies near the vertical plane through the middle.
/// @param along the axis to the right, 0: x, 1: y
Points section(const std::vector<Eigen::Vector3d>& near, const Pose& mount, int along) {
  constexpr double kHalfWidth = 0.5, kFarAhead = 4;  // metres
  Points points;
  for (const Eigen::Vector3d& each : near) {
    const Eigen::Vector3d at = mount * each;
    const bool is_shown =
        along == 0 ? std::abs(at.y()) < kHalfWidth : at.x() > 0 && at.x() < kFarAhead;
    if (is_shown) points.emplace_back(along == 0 ? at.x() : -at.y(), at.z());
  }
  return points;
}

/// The way of `base` by the lidar alone, from where it began, x ahead.
Points way_by_lidar(const DriveRecord& record, const Pose& mount) {
  Points points = {{0, 0}};
  Pose base;
  for (const LidarStep& step : record.steps) {
    base = base * mount * step.step * mount.inverse();
    points.emplace_back(base.translation.head<2>());
  }
  return points;
}

/// The same by IMU and wheel; empty where either is missing.
Points way_by_imu_and_wheel(const DriveRecord& record, const Settings& settings,
                            const EncoderSettings& recorded) {
  Points points;
  const Eigen::Quaterniond to_imu = settings.imu.mount().rotation.conjugate();
  const double scale = settings.encoder.scale / recorded.scale;
  const Eigen::Vector3d wheel = settings.encoder.translation;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  const WheelWay* before = nullptr;
  Eigen::Quaterniond first = Eigen::Quaterniond::Identity(), attitude_before = first;
  std::size_t next = 0;
  for (const WheelWay& each : record.wheel) {
    while (next < record.imu.size() && record.imu[next].t_ns < each.t_ns) ++next;
    if (next == record.imu.size()) break;
    if (record.imu[next].t_ns != each.t_ns) continue;
    const Eigen::Quaterniond attitude = record.imu[next].rotation * to_imu;
    if (before == nullptr) {
      first = attitude;
    } else {
      const Eigen::Vector3d rolled(scale * (each.distance - before->distance), 0, 0);
      const double turned =
          2 * (attitude_before.conjugate() * attitude).vec().z();  // small: rad to the left
      at += attitude * (rolled + Eigen::Vector3d(turned * wheel.y(), 0, 0));
    }
    before = &each;
    attitude_before = attitude;
    points.emplace_back((first.conjugate() * at).head<2>());
  }
  return points;
}

void widen(const Points& points, Eigen::Vector2d& low, Eigen::Vector2d& high) {
  for (const Eigen::Vector2d& each : points) {
    low = low.cwiseMin(each);
    high = high.cwiseMax(each);
  }
}

}  // namespace

Drawing draw_calibration(const DriveCapture& drive, const Settings& before, const Settings& after) {
  const double width = 2 * kPanelWidth + 3 * kMargin;
  const double height = kHeading + 2 * (kSectionHeight + kMargin) + kWayHeight + kMargin + kTitle;
  Drawing drawing(static_cast<int>(width), static_cast<int>(height), kWhite);
  const std::array settings = {&before, &after};
  std::array<Points, 2> by_lidar, by_wheel;
  Eigen::Vector2d low(-1, -1), high(1, 1);
  for (std::size_t i = 0; i < 2; ++i) {
    by_lidar[i] = way_by_lidar(drive.record, settings[i]->lidar.mount());
    by_wheel[i] = way_by_imu_and_wheel(drive.record, *settings[i], before.encoder);
    widen(by_lidar[i], low, high);
    widen(by_wheel[i], low, high);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = kMargin + static_cast<double>(i) * (kPanelWidth + kMargin);
    drawing.text(x, 28, i == 0 ? "Before" : "After", 19, kText, true);
    const Pose mount = settings[i]->lidar.mount();
    const Eigen::Vector2d lowest(-6, -1.2), highest(6, 1.8);
    double y = kHeading;
    const Rectangle side{x, y, kPanelWidth, kSectionHeight};
    Panel(drawing, side, lowest, highest, "the ground from the right: x, z [m]")
        .dots(section(drive.near, mount, 0), kDot);
    y += kSectionHeight + kMargin;
    const Rectangle ahead{x, y, kPanelWidth, kSectionHeight};
    Panel(drawing, ahead, lowest, highest, "the ground up to 4 m ahead, from behind: -y, z [m]")
        .dots(section(drive.near, mount, 1), kDot);
    y += kSectionHeight + kMargin;
    Panel way(drawing, {x, y, kPanelWidth, kWayHeight}, low, high,
              "the way from above: x, y [m]; blue by the lidar alone, orange by IMU and wheel");
    way.path(by_wheel[i], kOrange, 3);
    way.path(by_lidar[i], kBlue, 1.5);
  }
  return drawing;
}

}  // namespace scree::cli
