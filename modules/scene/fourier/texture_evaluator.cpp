#include "scene/fourier/texture_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "scene/fourier/exact_phase.h"
#include "scene/fourier/plane_cells.h"
#include "scene/fourier/plane_window.h"
#include "scene/fourier/series_cells.h"
#include "scene/fourier/series_sum.h"

namespace patina {

struct TextureEvaluator::Form {
  virtual ~Form() = default;
  virtual PlaneValue at(double x, double y) const noexcept = 0; // x, y [m]
  virtual std::size_t bytes() const = 0;
};

namespace {

// Of the tolerance, what a table may leave out; the rest is for rounding.
constexpr double kOfTable = 0.5;

// A series at places [m].
struct RotatedLine {
  RotatedSeries series;
  double omega;

  RotatedLine(const FourierSeries& of, double fundamental) : series(of), omega(fundamental) {}
  SeriesValue at(double x) const noexcept { return series.at(exactPhase(x, omega)); }
  std::size_t bytes() const { return series.bytes(); }
};

template <class Line> struct LineForm final : TextureEvaluator::Form {
  Line line;
  double mean;

  LineForm(Line of, double without) : line(std::move(of)), mean(without) {}
  PlaneValue at(double x, double) const noexcept override {
    const SeriesValue sum = line.at(x);
    return {sum.value - mean, sum.slope, 0};
  }
  std::size_t bytes() const override { return line.bytes(); }
};

template <class Line> struct ProductsForm final : TextureEvaluator::Form {
  struct Factors {
    Line along_x, along_y;
  };
  std::vector<Factors> factors;
  double mean = 0;

  PlaneValue at(double x, double y) const noexcept override {
    PlaneValue sum{-mean, 0, 0};
    for (const Factors& f : factors) {
      const SeriesValue q = f.along_x.at(x), p = f.along_y.at(y);
      sum.value += p.value * q.value;
      sum.slope_x += p.value * q.slope;
      sum.slope_y += p.slope * q.value;
    }
    return sum;
  }
  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const Factors& f : factors) sum += f.along_x.bytes() + f.along_y.bytes();
    return sum;
  }
};

template <class Table> struct TableForm final : TextureEvaluator::Form {
  Table table;

  explicit TableForm(Table of) : table(std::move(of)) {}
  PlaneValue at(double x, double y) const noexcept override { return table.at(x, y); }
  std::size_t bytes() const override { return table.bytes(); }
};

// A plane as a series along x for each of its terms along y.
struct RowsForm final : TextureEvaluator::Form {
  std::vector<RotatedSeries> rows;
  double omega;

  explicit RowsForm(const FourierTexture& texture) : omega(texture.omega) {
    const auto side = static_cast<std::size_t>(2 * harmonics(texture) + 1);
    for (std::size_t r = 0; r < side; ++r) {
      FourierSeries series;
      const double* row = texture.plane.data() + r * side;
      series.mean = r == 0 ? 0 : row[0];
      for (std::size_t c = 1; c < side; c += 2) {
        series.a.push_back(row[c]);
        series.b.push_back(row[c + 1]);
      }
      rows.emplace_back(series);
    }
  }
  PlaneValue at(double x_place, double y_place) const noexcept override {
    const double x = exactPhase(x_place, omega), y = exactPhase(y_place, omega);
    const SeriesValue first = rows[0].at(x);
    PlaneValue sum{first.value, first.slope, 0};
    for (std::size_t r = 1; r < rows.size(); r += 2) {
      const double k = static_cast<double>((r + 1) / 2), c = std::cos(k * y), s = std::sin(k * y);
      const SeriesValue of_cos = rows[r].at(x), of_sin = rows[r + 1].at(x);
      sum.value += c * of_cos.value + s * of_sin.value;
      sum.slope_x += c * of_cos.slope + s * of_sin.slope;
      sum.slope_y += k * (c * of_sin.value - s * of_cos.value);
    }
    return sum;
  }
  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const RotatedSeries& row : rows) sum += row.bytes();
    return sum;
  }
};

// What a table may be wrong by.
struct Errors {
  double height = 0, slope = 0; // slope by the phase
};

double amplitudes(const FourierSeries& series, bool of_slope) {
  double sum = of_slope ? 0 : std::abs(series.mean);
  for (std::size_t i = 0; i < series.a.size(); ++i)
    sum += std::hypot(series.a[i], series.b[i]) * (of_slope ? static_cast<double>(i + 1) : 1);
  return sum;
}

template <class Line, class Make>
std::shared_ptr<const TextureEvaluator::Form> productsForm(const FourierTexture& texture,
                                                           const Make& make) {
  auto form = std::make_shared<ProductsForm<Line>>();
  for (const FourierProduct& product : texture.products) {
    form->mean += product.along_x.mean * product.along_y.mean;
    form->factors.push_back(
        {make(product.along_x, product.along_y), make(product.along_y, product.along_x)});
  }
  return form;
}

std::shared_ptr<const TextureEvaluator::Form> exactForm(const FourierTexture& texture) {
  if (texture.kind == TextureKind::plane) return std::make_shared<RowsForm>(texture);
  if (texture.kind == TextureKind::products)
    return productsForm<RotatedLine>(texture, [&](const FourierSeries& own, const FourierSeries&) {
      return RotatedLine(own, texture.omega);
    });
  const FourierSeries series = seriesOf(texture);
  return std::make_shared<LineForm<RotatedLine>>(RotatedLine(series, texture.omega), series.mean);
}

std::shared_ptr<const TextureEvaluator::Form> tableForm(const FourierTexture& texture,
                                                        const Errors& errors) {
  if (texture.kind == TextureKind::products) {
    const double share = 1 / static_cast<double>(2 * texture.products.size());
    return productsForm<SeriesCells>(
        texture, [&](const FourierSeries& own, const FourierSeries& other) {
          // What this factor is wrong by is multiplied by the other one and by its slope; where
          // that is nothing, it asks for nothing.
          const auto over = [&](double error, double factor) {
            return factor > 0 ? share * error / factor : std::numeric_limits<double>::infinity();
          };
          const double most = amplitudes(other, false), steepest = amplitudes(other, true);
          return SeriesCells(own, std::min(over(errors.height, most), over(errors.slope, steepest)),
                             over(errors.slope, most), texture.omega);
        });
  }
  FourierSeries series = seriesOf(texture);
  series.mean = 0;
  return std::make_shared<LineForm<SeriesCells>>(
      SeriesCells(series, errors.height, errors.slope, texture.omega), 0.0);
}

std::shared_ptr<const TextureEvaluator::Form> planeForm(const FourierTexture& texture,
                                                        const Errors& errors, double tolerance) {
  if (tolerance >= PlaneCells::kFinest)
    if (auto cells = PlaneCells::of(texture.plane, harmonics(texture), texture.omega, errors.height,
                                    errors.slope))
      return std::make_shared<TableForm<PlaneCells>>(std::move(*cells));
  return std::make_shared<TableForm<PlaneWindow>>(
      PlaneWindow(texture.plane, harmonics(texture), texture.omega, kOfTable * tolerance));
}

} // namespace

TextureEvaluator::TextureEvaluator(const FourierTexture& texture, double tolerance)
    : omega_(texture.omega), low_(texture.low) {
  if (const std::string problem = problemOf(texture); !problem.empty())
    throw Error("texture '" + texture.name + "': " + problem);
  if (!(tolerance >= 0 && tolerance < 1))
    throw Error("a texture's tolerance is from 0 to 1, not " + std::to_string(tolerance));
  const Errors errors{kOfTable * tolerance * rmsHeight(texture),
                      kOfTable * tolerance * rmsSlope(texture) / omega_};
  if (!(errors.height > 0 && errors.slope > 0)) // all terms wanted, or nothing but zeros there
    form_ = exactForm(texture);
  else if (texture.kind == TextureKind::plane)
    form_ = planeForm(texture, errors, tolerance);
  else
    form_ = tableForm(texture, errors);
  if (const auto* tabled = dynamic_cast<const LineForm<SeriesCells>*>(form_.get()))
    line_ = &tabled->line;
}

TextureValue TextureEvaluator::ofForm(double x, double y) const noexcept {
  const PlaneValue value = form_->at(x, y);
  return {value.value, omega_ * Vec2(value.slope_x, value.slope_y)};
}

std::size_t TextureEvaluator::bytes() const {
  return form_->bytes();
}

} // namespace patina
