#include "draw/drawing.hpp"

#include "commands.hpp"
#include "common/fresh_file.hpp"

namespace scree::cli {

Drawing::Drawing(int width, int height, Colour background)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)),
      cairo_(cairo_create(surface_.get())),
      background_(background) {
  set(background);
  cairo_paint(cairo_.get());
}

void Drawing::set(Colour colour) {
  cairo_set_source_rgba(cairo_.get(), colour.red, colour.green, colour.blue, colour.alpha);
}

void Drawing::line(double x0, double y0, double x1, double y1, Colour colour, double width) {
  set(colour);
  cairo_set_line_width(cairo_.get(), width);
  cairo_move_to(cairo_.get(), x0, y0);
  cairo_line_to(cairo_.get(), x1, y1);
  cairo_stroke(cairo_.get());
}

void Drawing::fill(const Rectangle& area, Colour colour) {
  set(colour);
  cairo_rectangle(cairo_.get(), area.x, area.y, area.width, area.height);
  cairo_fill(cairo_.get());
}

void Drawing::outline(const Rectangle& area, Colour colour, double width) {
  set(colour);
  cairo_set_line_width(cairo_.get(), width);
  cairo_rectangle(cairo_.get(), area.x, area.y, area.width, area.height);
  cairo_stroke(cairo_.get());
}

void Drawing::choose_font(double size, bool is_bold) {
  cairo_select_font_face(cairo_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_.get(), size);
}

void Drawing::text(double x, double y, const std::string& text, double size, Colour colour,
                   bool is_bold) {
  choose_font(size, is_bold);
  set(colour);
  cairo_move_to(cairo_.get(), x, y);
  cairo_show_text(cairo_.get(), text.c_str());
}

void Drawing::text_with_rim(double x, double y, const std::string& text, double size,
                            Colour colour) {
  choose_font(size, true);
  cairo_move_to(cairo_.get(), x, y);
  cairo_text_path(cairo_.get(), text.c_str());
  set(background_);
  cairo_set_line_width(cairo_.get(), 3.5);
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_stroke_preserve(cairo_.get());
  set(colour);
  cairo_fill(cairo_.get());
}

double Drawing::text_width(const std::string& text, double size, bool is_bold) {
  choose_font(size, is_bold);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Drawing::clip(const Rectangle& area) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), area.x, area.y, area.width, area.height);
  cairo_clip(cairo_.get());
}

void Drawing::unclip() {
  cairo_restore(cairo_.get());
}

void Drawing::write_png(const std::filesystem::path& file) {
  FreshFile fresh(file);
  const cairo_status_t status = cairo_surface_write_to_png(surface_.get(), fresh.path().c_str());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Failure("cannot write " + file.string() + ": " + cairo_status_to_string(status));
  }
  fresh.take_place();
}

}  // namespace scree::cli
