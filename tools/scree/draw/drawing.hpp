#pragma once

#include <cairo.h>

#include <filesystem>
#include <memory>
#include <string>

namespace scree::cli {

struct Colour {
  double red, green, blue, alpha = 1;
};
inline constexpr Colour kWhite{1, 1, 1}, kText{0.13, 0.13, 0.16}, kFaint{0.45, 0.45, 0.5};
// Two that nobody takes for one another who sees red and green alike.
inline constexpr Colour kBlue{0.0, 0.447, 0.698};    ///< positive obstacles
inline constexpr Colour kOrange{0.835, 0.369, 0.0};  ///< negative ones
inline constexpr Colour kGridOnGround{0.30, 0.45, 0.60, 0.20};

struct Rectangle {
  double x = 0, y = 0, width = 0, height = 0;

  bool overlaps(const Rectangle& other) const {
    return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
           other.y < y + height;
  }
  bool holds(const Rectangle& other) const {
    return other.x >= x && other.y >= y && other.x + other.width <= x + width &&
           other.y + other.height <= y + height;
  }
};

/// Throws Failure where there is no Cairo, before any work.
void require_cairo();

/// A page of pixels to draw on, x to the right and y down. A thin layer over Cairo.
class Drawing {
public:
  Drawing(int width, int height, Colour background);

  void line(double x0, double y0, double x1, double y1, Colour colour, double width);
  void fill(const Rectangle& area, Colour colour);
  void outline(const Rectangle& area, Colour colour, double width);
  /// Text with its left end, its baseline at y.
  void text(double x, double y, const std::string& text, double size, Colour colour,
            bool is_bold = false);
  /// The same on a rim of the background's colour, so that it can be read on anything.
  void text_with_rim(double x, double y, const std::string& text, double size, Colour colour);
  double text_width(const std::string& text, double size, bool is_bold = false);

  /// For what is not covered above.
  cairo_t* cairo() { return cairo_.get(); }
  void set(Colour colour);
  /// Limits drawing to an area until unclip().
  void clip(const Rectangle& area);
  void unclip();

  /// Throws Failure when the file cannot be written.
  void write_png(const std::filesystem::path& file);

private:
  struct Destroy {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  };
  void choose_font(double size, bool is_bold);

  std::unique_ptr<cairo_surface_t, Destroy> surface_;
  std::unique_ptr<cairo_t, Destroy> cairo_;
  Colour background_;
};

}  // namespace scree::cli
