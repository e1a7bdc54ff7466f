#include "app/studies/field/field_layouts.h"

#include <cmath>
#include <cstdint>

#include "app/studies/field/node_gather.h"
#include "field/sampling/field_sampler.h"
#include "field/store/node_reader.h"

namespace patina {
namespace {

constexpr int kApronSide = kBlockSide + 3; // nodes -1 .. 9
constexpr float kStep = 8.0F / 32767;      // of a 16-bit distance over +-8 voxels
constexpr float kSlopeStep = 2.0F / 32767; // of a 16-bit gradient

struct Cell {
  int i, j, k;
  float fx, fy, fz;
};

Cell cellOf(const Vec3& q) {
  const int i = static_cast<int>(q[0]), j = static_cast<int>(q[1]), k = static_cast<int>(q[2]);
  return {i,
          j,
          k,
          static_cast<float>(q[0] - i),
          static_cast<float>(q[1] - j),
          static_cast<float>(q[2] - k)};
}

std::int16_t rounded(float value, float step) {
  return static_cast<std::int16_t>(std::lround(std::fmin(std::fmax(value / step, -32767), 32767)));
}

std::vector<std::int16_t> rounded(const std::vector<float>& values) {
  std::vector<std::int16_t> result;
  for (const float value : values) result.push_back(rounded(value, kStep));
  return result;
}

// Trilinear phi and blend of central differences from the 32 nodes around a cell; node(x, y, z) is
// relative to its lowest.
template <class Node> CandidateSample differencesAt(const Cell& cell, const Node& node) {
  const float w[3][2] = {{1 - cell.fx, cell.fx}, {1 - cell.fy, cell.fy}, {1 - cell.fz, cell.fz}};
  float phi = 0, gx = 0, gy = 0, gz = 0;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const float x0 = node(0, a, b), x1 = node(1, a, b);
      const float yz = w[1][a] * w[2][b], xz = w[0][a] * w[2][b], xy = w[0][a] * w[1][b];
      phi += yz * (w[0][0] * x0 + w[0][1] * x1);
      gx += yz * (w[0][0] * (x1 - node(-1, a, b)) + w[0][1] * (node(2, a, b) - x0));
      gy += xz * (w[1][0] * (node(a, 1, b) - node(a, -1, b)) +
                  w[1][1] * (node(a, 2, b) - node(a, 0, b)));
      gz += xy * (w[2][0] * (node(a, b, 1) - node(a, b, -1)) +
                  w[2][1] * (node(a, b, 2) - node(a, b, 0)));
    }
  return {static_cast<double>(phi), Vec3(gx, gy, gz) * 0.5};
}

std::size_t topBytes(const SurfaceField& field) {
  return field.top.size() * sizeof(field.top[0]);
}

std::size_t blockIndex(const SurfaceField& field, const Cell& cell) {
  return static_cast<std::size_t>(
      field.slotOf(cell.i / kBlockSide, cell.j / kBlockSide, cell.k / kBlockSide));
}

class Dense : public FieldLayout {
 public:
  explicit Dense(const SurfaceField& field) : nodes_(denseNodes(field)) {}
  std::string name() const override { return "dense, gradient on the fly"; }
  std::size_t bytes() const override { return nodes_.phi.size() * sizeof(float); }
  CandidateSample atGrid(const Vec3& q) const noexcept override {
    const Cell cell = cellOf(q);
    const float* base = nodes_.phi.data() + nodes_.index(cell.i, cell.j, cell.k);
    const std::ptrdiff_t row = nodes_.size[0], layer = row * nodes_.size[1];
    return differencesAt(cell, [=](int x, int y, int z) { return base[z * layer + y * row + x]; });
  }

 private:
  DenseNodes nodes_;
};

class PlainBlocks : public FieldLayout {
 public:
  explicit PlainBlocks(const SurfaceField& field) : nodes_(field) {
    for (std::size_t slot = 0; slot < field.blockCount(); ++slot) nodes_.block(slot); // unpacked
  }
  std::string name() const override { return "8^3 blocks, gradient on the fly"; }
  std::size_t bytes() const override {
    return nodes_.field().blockCount() * sizeof(DistanceNodes) + topBytes(nodes_.field());
  }
  CandidateSample atGrid(const Vec3& q) const noexcept override {
    const Cell cell = cellOf(q);
    return differencesAt(cell, [&](int x, int y, int z) {
      return nodes_.phiAt(cell.i + x, cell.j + y, cell.k + z);
    });
  }

 private:
  NodeReader nodes_;
};

template <class Number> class ApronBlocks : public FieldLayout {
 public:
  ApronBlocks(const SurfaceField& field, std::string name, std::vector<Number> phi, float step)
      : field_(&field), name_(std::move(name)), phi_(std::move(phi)), step_(step) {}
  std::string name() const override { return name_; }
  std::size_t bytes() const override { return phi_.size() * sizeof(Number) + topBytes(*field_); }
  CandidateSample atGrid(const Vec3& q) const noexcept override {
    const Cell cell = cellOf(q);
    constexpr std::ptrdiff_t kRow = kApronSide, kLayer = kApronSide * kApronSide;
    const Number* base = phi_.data() + blockIndex(*field_, cell) * kLayer * kRow +
                         (cell.k % kBlockSide + 1) * kLayer + (cell.j % kBlockSide + 1) * kRow +
                         cell.i % kBlockSide + 1;
    CandidateSample sample = differencesAt(cell, [=](int x, int y, int z) {
      return static_cast<float>(base[z * kLayer + y * kRow + x]);
    });
    sample.phi *= static_cast<double>(step_);
    sample.gradient *= static_cast<double>(step_);
    return sample;
  }

 private:
  const SurfaceField* field_;
  std::string name_;
  std::vector<Number> phi_;
  float step_;
};

class StoredSamples : public FieldLayout {
 public:
  explicit StoredSamples(const SurfaceField& field)
      : field_(&field), sampler_(field, Sampler::kim) {}
  std::string name() const override { return "9^3 blocks, gradient stored"; }
  std::size_t bytes() const override {
    return field_->blockCount() * sizeof(SampleBlock) + topBytes(*field_);
  }
  CandidateSample atGrid(const Vec3& q) const noexcept override {
    const GridSample sample = sampler_.atGrid(q);
    return {sample.phi, sample.gradient};
  }

 private:
  const SurfaceField* field_;
  FieldSampler sampler_;
};

class StoredSamples16 : public FieldLayout {
 public:
  explicit StoredSamples16(const SurfaceField& field) : field_(&field) {
    nodes_.reserve(field.blockCount() * SampleBlock{}.node.size());
    for (const auto& block : field.sample)
      for (const SampleNode& n : block->node)
        nodes_.push_back({rounded(n.phi, kStep), rounded(n.gx, kSlopeStep),
                          rounded(n.gy, kSlopeStep), rounded(n.gz, kSlopeStep)});
  }
  std::string name() const override { return "9^3 blocks, gradient stored, 16-bit"; }
  std::size_t bytes() const override { return nodes_.size() * sizeof(Node) + topBytes(*field_); }
  CandidateSample atGrid(const Vec3& q) const noexcept override {
    using Float4 = float __attribute__((vector_size(16)));
    const Cell cell = cellOf(q);
    constexpr std::ptrdiff_t kRow = kSampleSide, kLayer = kSampleSide * kSampleSide;
    const Node* base = nodes_.data() + blockIndex(*field_, cell) * kLayer * kRow +
                       (cell.k % kBlockSide) * kLayer + (cell.j % kBlockSide) * kRow +
                       cell.i % kBlockSide;
    const float wx[2] = {1 - cell.fx, cell.fx}, wy[2] = {1 - cell.fy, cell.fy},
                wz[2] = {1 - cell.fz, cell.fz};
    Float4 sum{};
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
          const Node& n = base[z * kLayer + y * kRow + x];
          const Float4 value = __builtin_convertvector((Int4{n.phi, n.gx, n.gy, n.gz}), Float4);
          sum += value * (wx[x] * wy[y] * wz[z]);
        }
    return {static_cast<double>(sum[0] * kStep),
            Vec3(sum[1], sum[2], sum[3]) * static_cast<double>(kSlopeStep)};
  }

 private:
  struct Node {
    std::int16_t phi, gx, gy, gz;
  };
  using Int4 = std::int32_t __attribute__((vector_size(16)));
  const SurfaceField* field_;
  std::vector<Node> nodes_;
};

} // namespace

std::vector<std::unique_ptr<FieldLayout>> fieldLayouts(const SurfaceField& field) {
  const std::vector<float> apron = gatherBlocks(field, denseNodes(field), -1, kApronSide);
  std::vector<std::unique_ptr<FieldLayout>> layouts;
  layouts.push_back(std::make_unique<Dense>(field));
  layouts.push_back(std::make_unique<PlainBlocks>(field));
  layouts.push_back(
      std::make_unique<ApronBlocks<float>>(field, "11^3 blocks, gradient on the fly", apron, 1.0F));
  layouts.push_back(std::make_unique<ApronBlocks<std::int16_t>>(
      field, "11^3 blocks, gradient on the fly, 16-bit", rounded(apron), kStep));
  layouts.push_back(std::make_unique<StoredSamples>(field));
  layouts.push_back(std::make_unique<StoredSamples16>(field));
  return layouts;
}

} // namespace patina
