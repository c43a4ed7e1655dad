// Says "drive", or "stop" and why. g++ -std=c++17 planner.cpp -o planner $(pkg-config --cflags
// --libs scree)
#include <chrono>
#include <cmath>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>

constexpr double kAhead = 3, kHalfWidth = 0.6;  // metres of the way that must be clear
using Clock = std::chrono::steady_clock;

/// A place of odom in base, seen from above: x forward, y left.
template <class Message>
std::pair<double, double> in_base(const Message& it, double x, double y) {
  const double yaw = std::atan2(2 * (it.q[0] * it.q[3] + it.q[1] * it.q[2]),
                                1 - 2 * (it.q[2] * it.q[2] + it.q[3] * it.q[3]));
  x -= it.p[0], y -= it.p[1];
  return {std::cos(yaw) * x + std::sin(yaw) * y, std::cos(yaw) * y - std::sin(yaw) * x};
}

bool is_in_the_way(std::pair<double, double> place) {
  return place.first > 0 && place.first < kAhead && std::abs(place.second) < kHalfWidth;
}

struct Planner {
  std::string obstacle = "no list yet", blind = "no health yet";  // why to stop; empty: not
  int unknown = 0;  // cells in the way that nobody has seen
  Clock::time_point heard;

  void list(const lcm::ReceiveBuffer*, const std::string&, const scree::obstacle_list_t* list) {
    heard = Clock::now();
    obstacle.clear();
    for (const scree::obstacle_t& it : list->obstacles)
      for (const double t : {0.0, 0.5, 1.0}) look(*list, it, t);
  }
  /// Looks all over the box of an obstacle as it will be in t seconds, at most 0.2 m apart.
  void look(const scree::obstacle_list_t& list, const scree::obstacle_t& it, double t) {
    const double c = std::cos(it.yaw), s = std::sin(it.yaw);
    const double along = std::ceil(it.extent[0] / 0.2) + 1,
                 across = std::ceil(it.extent[1] / 0.2) + 1;
    for (double i = 0; i <= along; ++i)
      for (double k = 0; k <= across; ++k) {
        const double u = (i / along - 0.5) * it.extent[0], v = (k / across - 0.5) * it.extent[1];
        const auto place = in_base(list, it.center[0] + c * u - s * v + t * it.velocity[0],
                                   it.center[1] + s * u + c * v + t * it.velocity[1]);
        if (!is_in_the_way(place)) continue;
        char text[80];
        std::snprintf(text, sizeof text, "a %s at %.1f %.1f",
                      it.kind == it.POSITIVE ? "rock" : "hole", place.first, place.second);
        obstacle = text;
      }
  }
  void grid(const lcm::ReceiveBuffer*, const std::string&, const scree::grid_t* grid) {
    unknown = 0;
    for (int i = 0; i < grid->cells; ++i)
      unknown += grid->state[i] == grid->UNKNOWN &&
                 is_in_the_way(
                     in_base(*grid, grid->origin[0] + (i % grid->columns + 0.5) * grid->cell_size,
                             grid->origin[1] + (i / grid->columns + 0.5) * grid->cell_size));
  }
  void health(const lcm::ReceiveBuffer*, const std::string&, const scree::health_t* health) {
    blind = health->state == health->OK ? "" : "blind: " + health->reason;
  }
  std::string decision() const {
    if (!blind.empty()) return "stop: " + blind;
    if (Clock::now() - heard > std::chrono::milliseconds(500)) return "stop: the lists are stale";
    if (!obstacle.empty()) return "stop: " + obstacle;
    return unknown > 10 ? "drive slowly, not all of the way was seen" : "drive";
  }
};

int main(int argc, char** argv) {
  lcm::LCM lcm(argc > 1 ? argv[1] : "udpm://239.255.76.67:7667?ttl=0");  // as lcm.url
  Planner planner;
  lcm.subscribe("SCREE_OBSTACLES", &Planner::list, &planner);
  lcm.subscribe("SCREE_GRID", &Planner::grid, &planner);
  lcm.subscribe("SCREE_HEALTH", &Planner::health, &planner);
  for (std::string said; lcm.good();) {
    lcm.handleTimeout(100);  // milliseconds
    const std::string now = planner.decision();
    if (now != said) std::puts((said = now).c_str()), std::fflush(stdout);
  }
}
