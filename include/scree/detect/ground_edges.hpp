#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/ground_surface.hpp"
#include "scree/detect/hole_evidence.hpp"
#include "scree/detect/oriented_box.hpp"

namespace scree {

/// A stretch along which the ground ends or steps.
struct GroundEdge {
  OrientedBox box;                     ///< along it, beyond the edge
  float ground = 0;                    ///< z of the ground before it, metres
  float step = 0;                      ///< down (below zero) or up, as far as known, metres
  Evidence evidence = Evidence::edge;  ///< shadow: what lies beyond was not seen
  std::uint32_t begin = 0, end = 0;    ///< its places in GroundEdges::places()
};

/// Finds where the ground ends or steps by 0.15 m or more, up or down: cliffs, kerbs, the edges of
/// wide pits and of ditches that cross the view. From every cell of the ground that has something
/// else beside it, the ground is continued outwards as it runs there. It ends where what was seen
/// next lies far below or above this, or where beams passed below it.
class GroundEdges {
public:
  static constexpr float kFarthest = 3;  ///< metres beyond the ground that are looked at

  explicit GroundEdges(std::size_t max_cells);

  void find(const GroundSurface& surface, const HoleEvidence& beams);

  std::span<const GroundEdge> all() const { return {edges_.data(), edges_.size()}; }
  /// Cells that lie beyond the edges, as points; z is that of the ground before them.
  const PointCloud& places() const { return places_; }

private:
  static constexpr float kStrip = 0.4F;  // metres beyond an edge that belong to it

  /// What lies beyond a cell of the ground in one direction.
  struct Beyond {
    float step = 0;           ///< metres, 0: no edge
    bool is_seen = false;     ///< what lies there
    bool is_gentle = false;   ///< the ground goes on, lower and not steep
    bool is_water = false;    ///< the ground goes on where nothing came back before
    bool has_return = false;  ///< a beam that passed where nothing is seen ended somewhere
    int cells = 0;            ///< to the first beam that passed below, where nothing is seen
  };
  struct Plane {
    float height = 0, rise_x = 0, rise_y = 0;  ///< metres, metres a cell
    float cells = 0;                           ///< that it was laid through
  };

  /// Sums over the ground in a row, up to a column: of cells, of their columns and of their
  /// heights.
  struct RowSums {
    double cells = 0, x = 0, xx = 0, z = 0, xz = 0;
    RowSums operator-(const RowSums& other) const {
      return {cells - other.cells, x - other.x, xx - other.xx, z - other.z, xz - other.xz};
    }
  };

  void sum_rows();
  void look_around(std::size_t cell);
  bool fit(std::size_t cell, Plane& plane) const;
  int steps_inside(std::size_t cell, int along_x, int along_y) const;
  Beyond look(std::size_t cell, int along_x, int along_y, const Plane& plane) const;
  bool ends_water(std::size_t cell, std::ptrdiff_t offset, float level, float stride, int begin,
                  int end) const;
  bool is_level_next(std::size_t cell, std::ptrdiff_t offset, float level, float rise) const;
  bool goes_on_level(std::size_t cell, std::ptrdiff_t offset, float rise, int steps) const;
  void mark(std::size_t cell, int along_x, int along_y, const Beyond& beyond, float ground);
  void collect(std::size_t start, std::int8_t sign);
  void add_edge(std::uint32_t begin, std::uint32_t end, int depth);
  void add_places(std::uint32_t begin, std::uint32_t end);
  OrientedBox box_around(std::uint32_t begin, std::uint32_t end);
  std::uint32_t cut(std::uint32_t begin, std::uint32_t end, const OrientedBox& box);
  float ground_share(const OrientedBox& box) const;

  const GroundSurface* surface_ = nullptr;
  const HoleEvidence* beams_ = nullptr;
  FixedVector<float> step_, ground_;   // by cell beyond an edge: metres
  FixedVector<std::uint8_t> is_seen_;  // for each of them
  FixedVector<std::uint32_t> cells_;   // of all edges, one edge's after the other's
  FixedVector<std::uint8_t> is_taken_;
  FixedVector<std::uint32_t> order_;  // scratch
  FixedVector<float> values_;         // scratch
  PointCloud places_;
  FixedVector<GroundEdge> edges_;
  FixedVector<RowSums> row_sums_;  // one more a row than it has cells
};

}  // namespace scree
