// Pages as PDF and SVG files, where lines and words stay vectors.
#include "acquisition/loaded/printer.h"

#include <memory>

#include <cairo-pdf.h>
#include <cairo-svg.h>

namespace patina {
namespace {

constexpr double kPoints = 72 / 0.0254; // a metre in points

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Pen = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void draw(const PrintedPage& page, cairo_t* pen) {
  cairo_scale(pen, kPoints, kPoints);
  for (const PrintedPage::Area& area : page.areas) {
    cairo_set_source_rgb(pen, area.grey, area.grey, area.grey);
    for (const Eigen::AlignedBox2d& part : area.parts)
      cairo_rectangle(pen, part.min().x(), part.min().y(), part.sizes().x(), part.sizes().y());
    cairo_fill(pen);
  }
  cairo_set_source_rgb(pen, 0, 0, 0);
  for (const PrintedPage::Outline& outline : page.outlines) {
    for (const Vec2& point : outline.points) cairo_line_to(pen, point.x(), point.y());
    cairo_close_path(pen);
    cairo_set_line_width(pen, outline.width);
    cairo_stroke(pen);
  }
  cairo_select_font_face(pen, "sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  for (const PrintedPage::Words& words : page.words) {
    cairo_set_font_size(pen, words.height);
    cairo_move_to(pen, words.at.x(), words.at.y());
    cairo_show_text(pen, words.text.c_str());
  }
}

std::string written(Surface surface, const std::vector<PrintedPage>& pages,
                    void (*resize)(cairo_surface_t*, double, double)) {
  for (const PrintedPage& page : pages) {
    if (resize) resize(surface.get(), page.size.x() * kPoints, page.size.y() * kPoints);
    const Pen pen(cairo_create(surface.get()), cairo_destroy);
    draw(page, pen.get());
    cairo_show_page(pen.get());
    if (const cairo_status_t status = cairo_status(pen.get()); status != CAIRO_STATUS_SUCCESS)
      return cairo_status_to_string(status);
  }
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  return status == CAIRO_STATUS_SUCCESS ? "" : cairo_status_to_string(status);
}

std::string pdf(const std::vector<PrintedPage>& pages, std::string& bytes) {
  Surface surface(cairo_pdf_surface_create_for_stream(append, &bytes, 1, 1), cairo_surface_destroy);
  return written(std::move(surface), pages, cairo_pdf_surface_set_size);
}

std::string svg(const PrintedPage& page, std::string& bytes) {
  Surface surface(cairo_svg_surface_create_for_stream(append, &bytes, page.size.x() * kPoints,
                                                      page.size.y() * kPoints),
                  cairo_surface_destroy);
  return written(std::move(surface), {page}, nullptr);
}

} // namespace

extern "C" __attribute__((visibility("default"))) const PrinterLibrary* patinaPrinterLibrary() {
  static constexpr PrinterLibrary kLibrary{pdf, svg};
  return &kLibrary;
}

} // namespace patina
