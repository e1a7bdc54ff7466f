#include "acquisition/texture/fit_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquisition/texture/fit_texture.h"
#include "core/decompose.h"
#include "core/error.h"

namespace patina {
namespace {

using HeightRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>; // y by x

std::vector<double> vectorOf(const Eigen::VectorXd& line) {
  return {line.begin(), line.end()};
}

// Applies `change` to each row; it may change the length.
template <class Change> HeightRows byRows(const HeightRows& rows, const Change& change) {
  HeightRows changed;
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    const std::vector<double> row = change(vectorOf(rows.row(r).transpose()));
    if (r == 0) changed.resize(rows.rows(), static_cast<Eigen::Index>(row.size()));
    changed.row(r) =
        Eigen::Map<const Eigen::RowVectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
  }
  return changed;
}

// Returns one period; the first line is not repeated.
HeightRows seamlessBothWays(HeightRows heights, double blend) {
  const auto count = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::lround(blend * static_cast<double>(heights.rows()))));
  for (int way = 0; way < 2; ++way) // along x, then along y
    heights =
        byRows(heights, [&](std::vector<double> row) { return seamless(std::move(row), count); })
            .transpose()
            .eval();
  return heights.topLeftCorner(heights.rows() - 1, heights.cols() - 1);
}

// Returns the coefficients of 1, cos, sin, cos 2, sin 2 ...
std::vector<double> termsOf(const FourierSeries& series) {
  std::vector<double> all{series.mean};
  for (std::size_t i = 0; i < series.a.size(); ++i) {
    all.push_back(series.a[i]);
    all.push_back(series.b[i]);
  }
  return all;
}
FourierSeries seriesOfTerms(const Eigen::VectorXd& all) {
  FourierSeries series;
  series.mean = all[0];
  for (Eigen::Index i = 1; i < all.size(); i += 2) {
    series.a.push_back(all[i]);
    series.b.push_back(all[i + 1]);
  }
  return series;
}

// Weights of the coefficients in a mean square along one axis: 1 for the constant, 1/2 for waves.
Eigen::VectorXd weightsOf(Eigen::Index side) {
  Eigen::VectorXd weights = Eigen::VectorXd::Constant(side, std::sqrt(0.5));
  weights[0] = 1;
  return weights;
}

} // namespace

FittedPlane fitPlane(const Picture& picture, const PlaneFitOptions& options, Progress& progress) {
  const Eigen::Index side = picture.width;
  if (picture.width != picture.height)
    throw Error("is " + std::to_string(picture.width) + " by " + std::to_string(picture.height) +
                " texels; a texture has one period along x and y: cut it square");
  if (side < 4) throw Error("has fewer than 4 texels a side");
  HeightRows heights(side, side);
  for (Eigen::Index y = 0; y < side; ++y)
    for (Eigen::Index x = 0; x < side; ++x)
      heights(y, x) =
          options.height *
          static_cast<double>(
              picture.texel[static_cast<std::size_t>((y * side + x) * picture.channels)]);
  if (!heights.allFinite()) throw Error("has a texel that is no number");
  FittedPlane fitted;
  const auto takeOffMean = [&] {
    heights.array() -= heights.mean();
    fitted.rms = std::sqrt(heights.array().square().mean());
  };
  takeOffMean();
  if (!(fitted.rms > 1e-9 * options.height)) throw Error("is as high everywhere");
  if (options.blend > 0) {
    heights = seamlessBothWays(std::move(heights), options.blend);
    takeOffMean();
  }
  fitted.samples = static_cast<std::size_t>(heights.cols());
  progress.report(0.2, "harmonics");

  const int harmonics = std::min(options.harmonics, static_cast<int>((heights.cols() - 1) / 2));
  if (harmonics < 1) throw Error("has too few texels for a harmonic");
  const auto toTerms = [&](const std::vector<double>& row) {
    progress.throwIfCancelled();
    return termsOf(seriesOf(row, harmonics));
  };
  const HeightRows along_x = byRows(heights, toTerms);
  const HeightRows columns = byRows(HeightRows(along_x.transpose()), toTerms);
  HeightRows plane = columns.transpose();
  plane(0, 0) = 0;

  FourierTexture& texture = fitted.texture;
  texture.omega = 2 * std::numbers::pi * static_cast<double>(side) /
                  (options.length * static_cast<double>(heights.cols()));
  const Eigen::VectorXd weights = weightsOf(plane.rows());
  const HeightRows weighted = weights.asDiagonal() * plane * weights.asDiagonal();
  const double whole = weighted.norm(),
               in_all = heights.squaredNorm() / static_cast<double>(heights.size());
  double kept = whole * whole;
  if (!options.rank) {
    texture.kind = TextureKind::plane;
    texture.plane.assign(plane.data(), plane.data() + plane.size());
  } else {
    texture.kind = TextureKind::products;
    progress.report(0.6, "products");
    const Svd svd(weighted);
    progress.throwIfCancelled();
    const VecX& values = svd.values;
    const auto lackingAfter = [&](Eigen::Index rank) {
      return values.tail(values.size() - rank).norm() / whole;
    };
    Eigen::Index rank = std::min<Eigen::Index>(*options.rank, values.size());
    if (rank == 0)
      for (rank = 1; rank < values.size() && lackingAfter(rank) > options.max_relative_error;)
        ++rank;
    for (Eigen::Index k = 0; k < rank; ++k) {
      const double root = std::sqrt(values[k]);
      texture.products.push_back({seriesOfTerms(root * svd.v.col(k).cwiseQuotient(weights)),
                                  seriesOfTerms(root * svd.u.col(k).cwiseQuotient(weights))});
    }
    fitted.rank = static_cast<int>(rank);
    fitted.relative_error = lackingAfter(rank);
    kept *= 1 - fitted.relative_error * fitted.relative_error;
  }
  fitted.residual = std::sqrt(std::max(0.0, in_all - kept));
  texture.low = minHeight(texture);
  progress.report(1, "low");
  return fitted;
}

} // namespace patina
