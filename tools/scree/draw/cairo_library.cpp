// Cairo's functions as far as they are used here. The library is opened when the first is called:
// with it come fonts and all of X11, and a robot that draws no pictures need not have them.
#include <cairo.h>
#include <dlfcn.h>

#include "commands.hpp"
#include "draw/drawing.hpp"

namespace {

void* find(const char* name) {
  static void* const library = dlopen("libcairo.so.2", RTLD_NOW);
  void* const function = library == nullptr ? nullptr : dlsym(library, name);
  if (function == nullptr) {
    throw scree::cli::Failure("pictures need the library Cairo: apt install libcairo2");
  }
  return function;
}

/// @tparam Own tells the functions apart: each is looked up once
template <auto* Own, class... Arguments>
auto call(const char* name, Arguments... arguments) {
  static const auto function = reinterpret_cast<decltype(Own)>(find(name));
  return function(arguments...);
}

}  // namespace

namespace scree::cli {

void require_cairo() {
  find("cairo_create");
}

}  // namespace scree::cli

void cairo_arc(cairo_t* cr, double xc, double yc, double radius, double angle1, double angle2) {
  return call<&cairo_arc>("cairo_arc", cr, xc, yc, radius, angle1, angle2);
}
void cairo_clip(cairo_t* cr) {
  return call<&cairo_clip>("cairo_clip", cr);
}
void cairo_close_path(cairo_t* cr) {
  return call<&cairo_close_path>("cairo_close_path", cr);
}
cairo_t* cairo_create(cairo_surface_t* target) {
  return call<&cairo_create>("cairo_create", target);
}
void cairo_destroy(cairo_t* cr) {
  return call<&cairo_destroy>("cairo_destroy", cr);
}
void cairo_fill(cairo_t* cr) {
  return call<&cairo_fill>("cairo_fill", cr);
}
void cairo_fill_preserve(cairo_t* cr) {
  return call<&cairo_fill_preserve>("cairo_fill_preserve", cr);
}
cairo_surface_t* cairo_image_surface_create(cairo_format_t format, int width, int height) {
  return call<&cairo_image_surface_create>("cairo_image_surface_create", format, width, height);
}
void cairo_line_to(cairo_t* cr, double x, double y) {
  return call<&cairo_line_to>("cairo_line_to", cr, x, y);
}
void cairo_move_to(cairo_t* cr, double x, double y) {
  return call<&cairo_move_to>("cairo_move_to", cr, x, y);
}
void cairo_paint(cairo_t* cr) {
  return call<&cairo_paint>("cairo_paint", cr);
}
void cairo_path_extents(cairo_t* cr, double* x1, double* y1, double* x2, double* y2) {
  return call<&cairo_path_extents>("cairo_path_extents", cr, x1, y1, x2, y2);
}
void cairo_rectangle(cairo_t* cr, double x, double y, double width, double height) {
  return call<&cairo_rectangle>("cairo_rectangle", cr, x, y, width, height);
}
void cairo_restore(cairo_t* cr) {
  return call<&cairo_restore>("cairo_restore", cr);
}
void cairo_rotate(cairo_t* cr, double angle) {
  return call<&cairo_rotate>("cairo_rotate", cr, angle);
}
void cairo_save(cairo_t* cr) {
  return call<&cairo_save>("cairo_save", cr);
}
void cairo_select_font_face(cairo_t* cr, const char* family, cairo_font_slant_t slant,
                            cairo_font_weight_t weight) {
  return call<&cairo_select_font_face>("cairo_select_font_face", cr, family, slant, weight);
}
void cairo_set_dash(cairo_t* cr, const double* dashes, int num_dashes, double offset) {
  return call<&cairo_set_dash>("cairo_set_dash", cr, dashes, num_dashes, offset);
}
void cairo_set_font_size(cairo_t* cr, double size) {
  return call<&cairo_set_font_size>("cairo_set_font_size", cr, size);
}
void cairo_set_line_join(cairo_t* cr, cairo_line_join_t line_join) {
  return call<&cairo_set_line_join>("cairo_set_line_join", cr, line_join);
}
void cairo_set_line_width(cairo_t* cr, double width) {
  return call<&cairo_set_line_width>("cairo_set_line_width", cr, width);
}
void cairo_set_source_rgba(cairo_t* cr, double red, double green, double blue, double alpha) {
  return call<&cairo_set_source_rgba>("cairo_set_source_rgba", cr, red, green, blue, alpha);
}
void cairo_show_text(cairo_t* cr, const char* utf8) {
  return call<&cairo_show_text>("cairo_show_text", cr, utf8);
}
const char* cairo_status_to_string(cairo_status_t status) {
  return call<&cairo_status_to_string>("cairo_status_to_string", status);
}
void cairo_stroke(cairo_t* cr) {
  return call<&cairo_stroke>("cairo_stroke", cr);
}
void cairo_stroke_preserve(cairo_t* cr) {
  return call<&cairo_stroke_preserve>("cairo_stroke_preserve", cr);
}
void cairo_surface_destroy(cairo_surface_t* surface) {
  return call<&cairo_surface_destroy>("cairo_surface_destroy", surface);
}
cairo_status_t cairo_surface_write_to_png(cairo_surface_t* surface, const char* filename) {
  return call<&cairo_surface_write_to_png>("cairo_surface_write_to_png", surface, filename);
}
void cairo_text_extents(cairo_t* cr, const char* utf8, cairo_text_extents_t* extents) {
  return call<&cairo_text_extents>("cairo_text_extents", cr, utf8, extents);
}
void cairo_text_path(cairo_t* cr, const char* utf8) {
  return call<&cairo_text_path>("cairo_text_path", cr, utf8);
}
void cairo_translate(cairo_t* cr, double tx, double ty) {
  return call<&cairo_translate>("cairo_translate", cr, tx, ty);
}
