#include "visualization/view/vector_figure.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <vtkBase64Utilities.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkZLibDataCompressor.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_kind.h"
#include "visualization/view/figure_picture.h"
#include "visualization/view/figure_stage.h"
#include "visualization/view/overlay_drawing.h"

namespace patina {
namespace {

constexpr double kScreenDpi = 96; // resolution without a size on paper

struct VectorFigure {
  FigurePicture picture; // without texts and lines
  OverlayDrawing overlay;
};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5g", value);
  return text.data();
}

std::string xmlText(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  return safe;
}

std::string hexColor(const palette::Color& color) {
  std::array<char, 8> text{};
  const auto part = [](double c) { return static_cast<int>(std::lround(255 * c)) & 255; };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", part(color[0]), part(color[1]),
                part(color[2]));
  return text.data();
}

std::string svgOf(const VectorFigure& figure) {
  const FigurePicture& picture = figure.picture;
  const double high = picture.height;
  const auto side = [&](int pixels) {
    return picture.dpi ? number(25.4 * pixels / *picture.dpi) + "mm" : std::to_string(pixels);
  };
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" "
                    "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" +
                    side(picture.width) + "\" height=\"" + side(picture.height) +
                    "\" viewBox=\"0 0 " + std::to_string(picture.width) + " " +
                    std::to_string(picture.height) + "\">\n";
  const std::string png = figurePng(picture);
  std::string base64(2 * png.size() + 4, '\0');
  base64.resize(vtkBase64Utilities::Encode(reinterpret_cast<const unsigned char*>(png.data()),
                                           static_cast<unsigned long>(png.size()),
                                           reinterpret_cast<unsigned char*>(base64.data())));
  svg += "<image width=\"" + std::to_string(picture.width) + "\" height=\"" +
         std::to_string(picture.height) + "\" xlink:href=\"data:image/png;base64," + base64 +
         "\"/>\n";
  for (const DrawnLine& line : figure.overlay.lines) {
    svg += "<polyline fill=\"none\" stroke=\"" + hexColor(line.color) + "\" stroke-width=\"" +
           number(line.width) + "\" points=\"";
    for (const Vec2& point : line.points)
      svg += number(point.x()) + "," + number(high - point.y()) + " ";
    svg += "\"/>\n";
  }
  for (const DrawnText& text : figure.overlay.texts)
    svg += "<text x=\"" + number(text.start.x()) + "\" y=\"" + number(high - text.start.y()) +
           "\" font-size=\"" + number(text.size) + "\" textLength=\"" + number(text.width) +
           "\" lengthAdjust=\"spacingAndGlyphs\" font-family=\"Arial, Helvetica, sans-serif\"" +
           (text.bold ? " font-weight=\"bold\"" : "") + " fill=\"" + hexColor(text.color) + "\">" +
           xmlText(text.text) + "</text>\n";
  return svg + "</svg>\n";
}

std::string deflated(const std::string& bytes) {
  const vtkNew<vtkZLibDataCompressor> zlib;
  const vtkSmartPointer<vtkUnsignedCharArray> packed = vtk::TakeSmartPointer(
      zlib->Compress(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
  if (packed == nullptr) throw Error("the figure cannot be encoded as PDF");
  return {reinterpret_cast<const char*>(packed->GetPointer(0)),
          static_cast<std::size_t>(packed->GetNumberOfValues())};
}

// Latin 1, of which the fonts' WinAnsiEncoding is an extension, with escapes.
std::string pdfText(std::string_view utf8) {
  std::string text;
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    const auto c = static_cast<unsigned char>(utf8[i]);
    if ((c == 0xc2 || c == 0xc3) && i + 1 < utf8.size()) {
      text += static_cast<char>((c & 3) << 6 | (static_cast<unsigned char>(utf8[++i]) & 63));
    } else if (c >= 0x80) {
      if (c >= 0xc0) text += '?';
    } else {
      if (c == '(' || c == ')' || c == '\\') text += '\\';
      text += utf8[i];
    }
  }
  return text;
}

std::string pdfColor(const palette::Color& color, const char* command) {
  return number(color[0]) + " " + number(color[1]) + " " + number(color[2]) + " " + command + "\n";
}

// Objects of a PDF file, whose numbers are their order from 1 (ISO 32000-1).
class PdfFile {
 public:
  void add(const std::string& dictionary) { begin(dictionary + "\n"); }
  void addStream(const std::string& entries, const std::string& bytes) {
    begin("<< " + entries + " /Length " + std::to_string(bytes.size()) + " >>\nstream\n" + bytes +
          "\nendstream\n");
  }
  std::string finished() const {
    std::string end = "xref\n0 " + std::to_string(places_.size() + 1) + "\n0000000000 65535 f \n";
    for (const std::size_t place : places_) {
      std::array<char, 24> row{};
      std::snprintf(row.data(), row.size(), "%010zu 00000 n \n", place);
      end += row.data();
    }
    return file_ + end + "trailer\n<< /Size " + std::to_string(places_.size() + 1) +
           " /Root 1 0 R >>\nstartxref\n" + std::to_string(file_.size()) + "\n%%EOF\n";
  }

 private:
  void begin(const std::string& body) {
    places_.push_back(file_.size());
    file_ += std::to_string(places_.size()) + " 0 obj\n" + body + "endobj\n";
  }
  std::string file_ = "%PDF-1.4\n%\xb5\xb6\n";
  std::vector<std::size_t> places_;
};

std::string pdfOf(const VectorFigure& figure) {
  const FigurePicture& picture = figure.picture;
  const std::string wide = std::to_string(picture.width), high = std::to_string(picture.height);
  const double point = 72 / picture.dpi.value_or(kScreenDpi); // size of a pixel
  std::string page = number(point) + " 0 0 " + number(point) + " 0 0 cm\nq " + wide + " 0 0 " +
                     high + " 0 0 cm /Picture Do Q\n";
  for (const DrawnLine& line : figure.overlay.lines) {
    page += pdfColor(line.color, "RG") + number(line.width) + " w\n";
    for (const Vec2& p : line.points)
      page += number(p.x()) + " " + number(p.y()) + (&p == &line.points.front() ? " m\n" : " l\n");
    page += "S\n";
  }
  for (const DrawnText& text : figure.overlay.texts)
    page += pdfColor(text.color, "rg") + "BT /" + (text.bold ? "Bold " : "Plain ") +
            number(text.size) + " Tf " + number(text.start.x()) + " " + number(text.start.y()) +
            " Td (" + pdfText(text.text) + ") Tj ET\n";
  std::string rgb, alpha;
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    rgb.append(reinterpret_cast<const char*>(&picture.rgba[i]), 3);
    alpha += static_cast<char>(picture.rgba[i + 3]);
  }
  const std::string image = "/Type /XObject /Subtype /Image /Width " + wide + " /Height " + high +
                            " /BitsPerComponent 8 /Filter /FlateDecode";
  const auto font = [](const char* name) {
    return std::string("<< /Type /Font /Subtype /Type1 /BaseFont /") + name +
           " /Encoding /WinAnsiEncoding >>";
  };
  PdfFile pdf;
  pdf.add("<< /Type /Catalog /Pages 2 0 R >>");
  pdf.add("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
  pdf.add("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + number(point * picture.width) + " " +
          number(point * picture.height) +
          "] /Contents 4 0 R /Resources << /XObject << /Picture 5 0 R >> /Font << /Plain 7 0 R "
          "/Bold 8 0 R >> >> >>");
  pdf.addStream("", page);
  pdf.addStream(image + " /ColorSpace /DeviceRGB /SMask 6 0 R", deflated(rgb));
  pdf.addStream(image + " /ColorSpace /DeviceGray", deflated(alpha));
  pdf.add(font("Helvetica"));
  pdf.add(font("Helvetica-Bold"));
  return pdf.finished();
}

} // namespace

bool isVectorFigureFile(const std::filesystem::path& path) {
  const auto kind = kindOfName(path);
  return kind == FileKind::svg || kind == FileKind::pdf;
}

void writeVectorFigure(SceneView& view, const Figure& figure, const std::filesystem::path& path) {
  VectorFigure drawn;
  {
    FigureStage stage(view, figure);
    stage.draw(); // lays texts out
    const TakenOverlay taken(stage.window());
    drawn.overlay = taken.drawing();
    drawn.picture = drawFigure(stage, figure);
  }
  writeFileAtomically(path, kindOfName(path) == FileKind::pdf ? pdfOf(drawn) : svgOf(drawn));
}

} // namespace patina
