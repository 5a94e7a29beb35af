// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What "good" means for a picture of noise, as numbers: alignment, coherence, anisotropy and motion.
 */
#ifndef PictureMetrics_h
#define PictureMetrics_h

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace steerable
{
namespace testing
{
struct Picture
{
  int Width = 0;
  int Height = 0;
  std::vector<float> Values;

  Picture(int width, int height)
    : Width(width)
    , Height(height)
    , Values(static_cast<std::size_t>(width) * height)
  {
  }
  Picture(int width, int height, std::vector<float> values)
    : Width(width)
    , Height(height)
    , Values(std::move(values))
  {
  }
};

/// Product or other combination of two pictures, sample by sample.
template <typename Function>
Picture Combine(const Picture& a, const Picture& b, Function&& function)
{
  Picture result(a.Width, a.Height);
  for (std::size_t i = 0; i < a.Values.size(); ++i)
  {
    result.Values[i] = static_cast<float>(function(a.Values[i], b.Values[i]));
  }
  return result;
}

/// Convolution along x, the picture mirrored at its borders; the result is transposed.
inline Picture ConvolveTransposed(const Picture& picture, const std::vector<float>& kernel)
{
  const int radius = static_cast<int>(kernel.size() / 2);
  Picture result(picture.Height, picture.Width);
  std::vector<float> row(picture.Width + 2 * radius);
  std::vector<float> out(picture.Width);
  for (int y = 0; y < picture.Height; ++y)
  {
    const float* values = picture.Values.data() + static_cast<std::size_t>(y) * picture.Width;
    for (int x = -radius; x < picture.Width + radius; ++x)
    {
      const int mirrored = x < 0 ? -1 - x : x >= picture.Width ? 2 * picture.Width - 1 - x : x;
      row[x + radius] = values[std::clamp(mirrored, 0, picture.Width - 1)];
    }
    std::fill(out.begin(), out.end(), 0.0f);
    for (int k = 0; k <= 2 * radius; ++k)
    {
      const float weight = kernel[2 * radius - k];
      for (int x = 0; x < picture.Width; ++x)
      {
        out[x] += weight * row[x + k];
      }
    }
    for (int x = 0; x < picture.Width; ++x)
    {
      result.Values[static_cast<std::size_t>(x) * picture.Height + y] = out[x];
    }
  }
  return result;
}

/// A Gaussian of this deviation in pixels, or its derivative, cut off at 4 deviations.
inline std::vector<float> GaussianKernel(double sigma, bool derivative)
{
  const int radius = static_cast<int>(std::ceil(4.0 * sigma));
  std::vector<float> kernel(2 * radius + 1);
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i)
  {
    sum += std::exp(-0.5 * i * i / (sigma * sigma));
  }
  for (int i = -radius; i <= radius; ++i)
  {
    const double value = std::exp(-0.5 * i * i / (sigma * sigma)) / sum;
    kernel[i + radius] = static_cast<float>(derivative ? -i / (sigma * sigma) * value : value);
  }
  return kernel;
}

inline Picture Smooth(const Picture& picture, double sigma)
{
  const std::vector<float> kernel = GaussianKernel(sigma, false);
  return ConvolveTransposed(ConvolveTransposed(picture, kernel), kernel);
}

/// Derivatives of the picture smoothed by a Gaussian of one pixel.
struct PictureGradient
{
  Picture X;
  Picture Y;

  explicit PictureGradient(const Picture& picture)
    : X(ConvolveTransposed(
        ConvolveTransposed(picture, GaussianKernel(1.0, true)), GaussianKernel(1.0, false)))
    , Y(ConvolveTransposed(
        ConvolveTransposed(picture, GaussianKernel(1.0, false)), GaussianKernel(1.0, true)))
  {
  }
};

/// Direction of the flow at a pixel, any length but 0.
using DirectionFunction = std::function<Eigen::Vector2d(int, int)>;

constexpr int PictureBorder = 20;

/// Calls function(index, unit direction) for every pixel off the border.
template <typename Function>
void ForInterior(const Picture& picture, const DirectionFunction& direction, Function&& function)
{
  for (int y = PictureBorder; y < picture.Height - PictureBorder; ++y)
  {
    for (int x = PictureBorder; x < picture.Width - PictureBorder; ++x)
    {
      function(static_cast<std::size_t>(y) * picture.Width + x, direction(x, y).normalized());
    }
  }
}

inline double Percentile(std::vector<double> values, double share)
{
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

struct Alignment
{
  /// Degrees between the structure tensor's minor eigenvector and the flow, modulo 180.
  double Median = 0.0;
  double Mean = 0.0;
  /// Mean of (l1 - l2) / (l1 + l2) of the structure tensor.
  double Coherence = 0.0;
  /// RMS gradient across the flow over that along it.
  double Ratio = 0.0;
};

inline Alignment MeasureAlignment(
  const Picture& picture, const DirectionFunction& direction, double smoothing)
{
  const PictureGradient gradient(picture);
  const auto product = [](float a, float b) { return a * b; };
  const Picture xx = Smooth(Combine(gradient.X, gradient.X, product), smoothing);
  const Picture xy = Smooth(Combine(gradient.X, gradient.Y, product), smoothing);
  const Picture yy = Smooth(Combine(gradient.Y, gradient.Y, product), smoothing);
  Alignment result;
  std::vector<double> angles;
  double along2 = 0.0;
  double across2 = 0.0;
  ForInterior(picture, direction,
    [&](std::size_t i, const Eigen::Vector2d& u)
    {
      const double difference = xx.Values[i] - yy.Values[i];
      const double sum = xx.Values[i] + yy.Values[i];
      const double spread = std::hypot(difference, 2.0 * xy.Values[i]);
      result.Coherence += sum > 0.0 ? spread / sum : 0.0;
      const double major = 0.5 * std::atan2(2.0 * xy.Values[i], difference);
      // The minor eigenvector is at right angles to the major one.
      const double sine = std::abs(-std::sin(major) * u[1] - std::cos(major) * u[0]);
      angles.push_back(std::asin(std::min(1.0, sine)) * 180.0 / 3.14159265358979323846);
      const double along = gradient.X.Values[i] * u[0] + gradient.Y.Values[i] * u[1];
      const double across = gradient.Y.Values[i] * u[0] - gradient.X.Values[i] * u[1];
      along2 += along * along;
      across2 += across * across;
    });
  const auto count = static_cast<double>(angles.size());
  for (double angle : angles)
  {
    result.Mean += angle / count;
  }
  result.Coherence /= count;
  result.Ratio = std::sqrt(across2 / along2);
  result.Median = Percentile(angles, 0.5);
  return result;
}

/// Pixels per frame along the flow and across it.
struct OpticalFlow
{
  double Along10 = 0.0;
  double AlongMedian = 0.0;
  double AcrossMedian = 0.0;
};

/// Least squares of n_t + v . grad n = 0 over a Gaussian window, in the axes of the flow.
inline OpticalFlow MeasureFlow(
  const Picture& first, const Picture& second, const DirectionFunction& direction, double smoothing)
{
  const Picture middle = Combine(first, second, [](float a, float b) { return 0.5f * (a + b); });
  const PictureGradient gradient(middle);
  const Picture change =
    Smooth(Combine(first, second, [](float a, float b) { return b - a; }), 1.0);
  const auto product = [](float a, float b) { return a * b; };
  const Picture xx = Smooth(Combine(gradient.X, gradient.X, product), smoothing);
  const Picture xy = Smooth(Combine(gradient.X, gradient.Y, product), smoothing);
  const Picture yy = Smooth(Combine(gradient.Y, gradient.Y, product), smoothing);
  const Picture xt = Smooth(Combine(gradient.X, change, product), smoothing);
  const Picture yt = Smooth(Combine(gradient.Y, change, product), smoothing);
  std::vector<double> along;
  std::vector<double> across;
  ForInterior(first, direction,
    [&](std::size_t i, const Eigen::Vector2d& u)
    {
      Eigen::Matrix2d tensor;
      tensor << xx.Values[i], xy.Values[i], xy.Values[i], yy.Values[i];
      const Eigen::Vector2d velocity =
        -tensor.inverse() * Eigen::Vector2d(xt.Values[i], yt.Values[i]);
      along.push_back(velocity.dot(u));
      across.push_back(velocity[1] * u[0] - velocity[0] * u[1]);
    });
  OpticalFlow flow;
  flow.Along10 = Percentile(along, 0.1);
  flow.AlongMedian = Percentile(along, 0.5);
  flow.AcrossMedian = Percentile(across, 0.5);
  return flow;
}

/// Mean, standard deviation and skewness of numbers.
struct Moments
{
  double Mean = 0.0;
  double Deviation = 0.0;
  double Skewness = 0.0;

  template <typename Values>
  explicit Moments(const Values& values)
  {
    const auto count = static_cast<double>(values.size());
    for (double value : values)
    {
      this->Mean += value / count;
    }
    double third = 0.0;
    for (double value : values)
    {
      const double d = value - this->Mean;
      this->Deviation += d * d / count;
      third += d * d * d / count;
    }
    this->Deviation = std::sqrt(this->Deviation);
    this->Skewness = third / std::pow(this->Deviation, 3);
  }
};
} // namespace testing
} // namespace steerable

#endif
