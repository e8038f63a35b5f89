// SPDX-License-Identifier: Apache-2.0
//
// A small writer of SVG, and panels in which it draws in pixel coordinates of a target.
#ifndef SUREFILL_CERTIFY_SVG_HPP
#define SUREFILL_CERTIFY_SVG_HPP

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace surefill::certify {

struct SvgPoint {
  double x, y;
};

class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  // `style` is attributes, such as fill="#fff".
  void rect(SvgPoint a, SvgPoint b, std::string_view style) {
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" {}/>\n", number(a.x), number(a.y),
                         number(b.x - a.x), number(b.y - a.y), style);
  }
  void line(SvgPoint a, SvgPoint b, std::string_view style) {
    body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" {}/>\n", number(a.x), number(a.y), number(b.x),
                         number(b.y), style);
  }
  void circle(SvgPoint c, double radius, std::string_view style) {
    body_ +=
        fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", number(c.x), number(c.y), number(radius), style);
  }
  void path(const std::vector<SvgPoint>& points, bool closed, std::string_view style) {
    body_ += fmt::format("<{} points=\"", closed ? "polygon" : "polyline");
    for (const SvgPoint& p : points) body_ += fmt::format("{},{} ", number(p.x), number(p.y));
    body_ += fmt::format("\" {}/>\n", style);
  }
  // `anchor`: start, middle or end.
  void text(SvgPoint p, double size, std::string_view anchor, std::string_view words, std::string_view style = "") {
    std::string escaped;
    for (const char c : words) escaped += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
    body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" {}>{}</text>\n", number(p.x),
                         number(p.y), number(size), anchor, style, escaped);
  }

  // Half a billion characters would be no picture; callers keep targets small.
  std::string file() const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
        "font-family=\"DejaVu Sans, Verdana, sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"#ffffff\"/>\n{2}</svg>\n",
        number(width_), number(height_), body_);
  }

 private:
  // Two decimals are a fortieth of what a screen shows.
  static std::string number(double value) { return fmt::format("{}", std::round(value * 100) / 100 + 0.0); }

  double width_, height_;
  std::string body_;
};

// A rectangle of the screen, [x0, x1) x [y0, y1) in pixels, as a part of the picture.
struct Panel {
  Svg& svg;
  SvgPoint origin;  // of pixel (x0, y0), in the picture
  double scale;     // of a pixel
  int x0, y0, x1, y1;

  SvgPoint at(double x, double y) const { return {origin.x + (x - x0) * scale, origin.y + (y - y0) * scale}; }
  void pixels(double left, double top, double right, double bottom, std::string_view style) const {
    svg.rect(at(left, top), at(right, bottom), style);
  }
  void pixel(int x, int y, std::string_view style) const { pixels(x, y, x + 1, y + 1, style); }
  void grid() const {
    if (scale < 4) return pixels(x0, y0, x1, y1, "fill=\"none\" stroke=\"#b8bcc4\" stroke-width=\"1\"");
    for (int x = x0; x <= x1; ++x) svg.line(at(x, y0), at(x, y1), "stroke=\"#d4d7dd\" stroke-width=\"0.6\"");
    for (int y = y0; y <= y1; ++y) svg.line(at(x0, y), at(x1, y), "stroke=\"#d4d7dd\" stroke-width=\"0.6\"");
  }
};

// Panels of one size in rows, each with a title above and lines of text below.
class Sheet {
 public:
  static constexpr double kGap = 18, kTitle = 26, kLine = 15;

  Sheet(int panels, int columns, int x0, int y0, int x1, int y1, double scale, int caption_lines)
      : columns_(columns),
        scale_(scale),
        x0_(x0),
        y0_(y0),
        x1_(x1),
        y1_(y1),
        width_(std::max((x1 - x0) * scale, 150.0)),
        height_(kTitle + (y1 - y0) * scale + 6 + kLine * caption_lines),
        svg_(kGap + columns * (width_ + kGap), kGap + (panels + columns - 1) / columns * (height_ + kGap)) {}

  Panel panel(int n, std::string_view title) {
    const SvgPoint corner = corner_of(n);
    svg_.text({corner.x, corner.y + 16}, 14, "start", title, "font-weight=\"bold\" fill=\"#20242c\"");
    return {svg_, {corner.x, corner.y + kTitle}, scale_, x0_, y0_, x1_, y1_};
  }
  void caption(int n, int line, std::string_view words) {
    const SvgPoint corner = corner_of(n);
    svg_.text({corner.x, corner.y + kTitle + (y1_ - y0_) * scale_ + 4 + kLine * (line + 0.8)}, 11.5, "start", words,
              "fill=\"#40454f\"");
  }
  std::string file() const { return svg_.file(); }

 private:
  SvgPoint corner_of(int n) const {
    return {kGap + n % columns_ * (width_ + kGap), kGap + n / columns_ * (height_ + kGap)};
  }

  int columns_;
  double scale_;
  int x0_, y0_, x1_, y1_;
  double width_, height_;
  Svg svg_;
};

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_SVG_HPP
