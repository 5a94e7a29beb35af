// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Metrics of surfaces with texture coordinates: what subband noise needs to know about a mapping.
 * MetricTensor.h holds the metrics made of vectors and tensors for surflet noise.
 *
 * Everything is one formula. The gradients of the texture coordinates on the surface, repeats per
 * object unit, and a feature metric B, the squared size of a noise feature along each direction of
 * space, give
 *
 *     M_kl = grad u_k^T B grad u_l,    k, l in {u, v},
 *
 * in repeats squared (Goldberg, Zwicker, Durand, "Anisotropic Noise", SIGGRAPH 2008, section 3.1:
 * its T has the rows grad u and grad v, and M = lambda^2 T T^T where B = lambda^2 I).
 */
#ifndef SurfaceMetric_h
#define SurfaceMetric_h

#include <Eigen/Core>

#include <array>

namespace steerable
{
/// Columns grad u, grad v: tangent vectors in object space, repeats per object unit.
using TextureGradients = Eigen::Matrix<double, 3, 2>;

/// What a triangle's mapping to the texture is like.
enum class TriangleMapping
{
  Regular,
  Flipped,   ///< Mirrored by the mapping; its metric is as good as that of a regular one.
  Singular,  ///< No area in the texture: no metric.
  Degenerate ///< No area on the surface, or a coordinate is not finite: no metric.
};

/// A step in texture coordinates across a seam, shortened to [-1/2, 1/2] by whole repeats.
Eigen::Vector2d WrapSeam(const Eigen::Vector2d& step);

/**
 * Gradients of the texture coordinates (in repeats) over a triangle, dP E^-1 dU with E the Gram
 * matrix of the edges dP. With `wrapSeams` steps between corners are shortened by WrapSeam; leave it
 * off where a triangle may truly span half a repeat. Singular and Degenerate triangles get zeros.
 */
TriangleMapping TriangleGradients(const std::array<Eigen::Vector3d, 3>& points,
  const std::array<Eigen::Vector2d, 3>& texture, bool wrapSeams, TextureGradients& gradients);

/**
 * Gradients of a planar projection along `axis` (0, 1 or 2) on a surface with this unit normal. The
 * texture coordinates are the other two coordinates, in the order x, y, z, divided by
 * `repeatLength`, which must be positive.
 */
TextureGradients PlanarGradients(const Eigen::Vector3d& normal, int axis, double repeatLength);

/**
 * Weights of the three planar projections for this unit normal, with squares summing to one, so that
 * independent tiles blend without changing the variance. |n|^4, ramped down to zero where a
 * projection distorts by 4:1 (|n| <= 1/4).
 */
Eigen::Vector3d TriplanarBlend(const Eigen::Vector3d& normal);

/**
 * Weight w of noise at texture coordinates beside noise of planar projections, whose weight is
 * sqrt(1 - w^2) and which takes over where a texture cannot carry noise. w falls smoothly from 1 to
 * 0 between `distance` 1 and 0 from a seam, in wavelengths, and between a `stretch` of the texture
 * that weights follow (`followed`) and 1.5 times that.
 */
double TextureBlend(double stretch, double followed, double distance);

/**
 * Spacing of the points of a triangle as a form E in space: along a unit vector t they are sqrt(t^T
 * E t) apart. Sides a and b of half a rectangle give a a^T + b b^T, an equilateral triangle 3/4 of
 * its squared side in every direction; of a triangle between, the longest side counts by the cosine
 * of the angle that it is opposite to. The trace is always half of the sum of the squared sides.
 */
Eigen::Matrix3d SpacingForm(const std::array<Eigen::Vector3d, 3>& corners);

/// B = lambda^2 I: noise of this wavelength in every direction.
Eigen::Matrix3d IsotropicFeature(double wavelength);

/**
 * B = lambda^2 (a t t^T + (I - t t^T) / a): features `anisotropy` a times longer along t, and a
 * times thinner across, than they are wide; their area stays. `direction` should be tangent to
 * the surface; its length and sign do not matter; where it is zero or not finite the feature is isotropic. Anisotropy must be positive.
 */
Eigen::Matrix3d SteeredFeature(
  double wavelength, const Eigen::Vector3d& direction, double anisotropy);

/// M = gradients^T B gradients.
Eigen::Matrix2d SurfaceMetric(const TextureGradients& gradients, const Eigen::Matrix3d& feature);
} // namespace steerable

#endif
