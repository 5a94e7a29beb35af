// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandPoints.h"

#include "Subband/SurfaceMetric.h"
#include "SubbandSeams.h"

#include "vtkDataArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace noise
{
namespace
{
// A projection with less of the blend's power than this does not show.
constexpr double VisibleBlend = 0.1;

/// Value of one component, length of more.
double ValueOf(vtkDataArray* array, vtkIdType i)
{
  const int components = array->GetNumberOfComponents();
  double squares = 0.0;
  for (int c = 0; c < components; ++c)
  {
    const double value = array->GetComponent(i, c);
    if (components == 1)
    {
      return value;
    }
    squares += value * value;
  }
  return std::sqrt(squares);
}

Eigen::Matrix2d Symmetric(const Eigen::Array3d& entries)
{
  return (Eigen::Matrix2d() << entries[0], entries[1], entries[1], entries[2]).finished();
}
} // namespace

double WavelengthAt(vtkDataArray* array, vtkIdType point, double usual)
{
  const double value = array ? ValueOf(array, point) : usual;
  return value > 0.0 && std::isfinite(value) ? value : usual;
}

double AnisotropyAt(vtkDataArray* array, vtkIdType point, double usual)
{
  const double value = array ? ValueOf(array, point) : usual;
  return std::isfinite(value) ? std::clamp(value, 1.0, 8.0) : usual;
}

//------------------------------------------------------------------------------
std::array<double, 7> KeyOf(const steerable::SubbandWeightParameters& parameters)
{
  const steerable::SubbandParameters& pyramid = parameters.Pyramid;
  return { double(pyramid.Orientations), double(pyramid.Scales), double(pyramid.TileSize),
    pyramid.BandCenter, double(parameters.Method), double(parameters.RadialTriple),
    parameters.FixedScale };
}

//------------------------------------------------------------------------------
SubbandPointCounts& SubbandPointCounts::operator+=(const SubbandPointCounts& other)
{
  this->Points += other.Points;
  this->Unmapped += other.Unmapped;
  this->Undirected += other.Undirected;
  this->Clamped += other.Clamped;
  this->Finer = std::max(this->Finer, other.Finer);
  this->Coarser = std::max(this->Coarser, other.Coarser);
  return *this;
}

//------------------------------------------------------------------------------
double SubbandPointWeights::GetWavelength(vtkIdType point) const
{
  return WavelengthAt(this->WavelengthArray, point, this->Wavelength);
}

//------------------------------------------------------------------------------
double SubbandPointWeights::GetSteering(vtkIdType point) const
{
  if (!this->AnisotropyArray)
  {
    return this->Anisotropy;
  }
  const double wanted = AnisotropyAt(this->AnisotropyArray, point, this->Wanted);
  return this->Scale ? this->Scale->GetSteering(wanted) : wanted;
}

//------------------------------------------------------------------------------
int SubbandPointWeights::GetFirstComponent(std::size_t lookup) const
{
  int first = 0;
  for (std::size_t l = 0; l < lookup; ++l)
  {
    first += this->Lookups[l].Tiles->Components();
  }
  return first;
}

//------------------------------------------------------------------------------
std::size_t SubbandPointWeights::GetWeightedOctaves() const
{
  return this->AntiAlias || this->Factors ? static_cast<std::size_t>(this->Octaves) : 1;
}

//------------------------------------------------------------------------------
SubbandPointCounts SubbandPointWeights::FindPoints(const SubbandSurface& surface,
  const SteeringVectors& vectors, vtkUnsignedCharArray* ghosts, vtkIdType first, vtkIdType last,
  SubbandChunk& chunk) const
{
  SubbandPointCounts counts;
  chunk.Planes.assign(this->Lookups.size(), SubbandPlanePoints());
  chunk.Distortion.assign(this->NeedsDistortion ? last - first : 0, 0.0f);
  for (vtkIdType point = first; point < last; ++point)
  {
    SubbandPointCounts here;
    here.Points = 1;
    if (surface.IsTextured())
    {
      this->AddTextured(surface, vectors, point, first, chunk, here);
    }
    else
    {
      this->AddProjected(surface, vectors, point, first, chunk, 1.0, here);
    }
    if (!ghosts || !ghosts->GetValue(point))
    {
      counts += here;
    }
  }
  for (SubbandPlanePoints& plane : chunk.Planes)
  {
    plane.Points.shrink_to_fit();
    plane.Texture.shrink_to_fit();
    plane.Shapes.shrink_to_fit();
  }
  return counts;
}

//------------------------------------------------------------------------------
void SubbandPointWeights::AddTextured(const SubbandSurface& surface,
  const SteeringVectors& vectors, vtkIdType point, vtkIdType first, SubbandChunk& chunk,
  SubbandPointCounts& counts) const
{
  SubbandSurface::PointMetrics metrics;
  const bool mapped = surface.ComputeTextured(point, vectors, this->GetSteering(point), metrics);
  if (this->NeedsDistortion)
  {
    const double ratio = mapped ? steerable::DistortionRatio(metrics.Isotropic) : 0.0;
    chunk.Distortion[point - first] = static_cast<float>(ratio);
  }
  double share = mapped ? 1.0 : 0.0;
  if (this->Seams)
  {
    if (mapped)
    {
      const int orientations = this->Lookups[0].Layout->Pyramid.Orientations;
      const double wavelength = this->GetWavelength(point);
      share = steerable::TextureBlend(steerable::DistortionRatio(metrics.Isotropic),
        steerable::FollowedStretch(orientations),
        this->Seams->GetDistance(surface.GetPoint(point), wavelength) / wavelength);
    }
    if (share < 1.0)
    {
      this->AddProjected(
        surface, vectors, point, first, chunk, std::sqrt(1.0 - share * share), counts);
    }
  }
  else if (!mapped)
  {
    counts.Unmapped = 1;
  }
  if (!(share > 0.0))
  {
    return;
  }
  counts.Undirected = vectors.Values && !metrics.Directed;
  const double repeats = this->Lookups[0].Layout->Repeats;
  const double scale = repeats * this->GetWavelength(point);
  const bool clamped = this->AddPoint(chunk.Planes[0], 0, point - first,
    repeats * surface.GetTexture(point), metrics.Metric * (scale * scale),
    metrics.Footprint * (repeats * repeats), share, counts);
  counts.Clamped = counts.Clamped || clamped;
}

//------------------------------------------------------------------------------
// `share`: of the projections beside the texture, squares summing to one.
void SubbandPointWeights::AddProjected(const SubbandSurface& surface,
  const SteeringVectors& vectors, vtkIdType point, vtkIdType first, SubbandChunk& chunk,
  double share, SubbandPointCounts& counts) const
{
  SubbandSurface::PointFeatures features;
  const bool mapped = surface.ComputeProjected(point, vectors, this->GetSteering(point), features);
  if (this->NeedsDistortion && !surface.IsTextured())
  {
    chunk.Distortion[point - first] =
      mapped ? static_cast<float>(1.0 / features.Normal.cwiseAbs().maxCoeff()) : 0.0f;
  }
  if (!mapped)
  {
    counts.Unmapped = 1;
    return;
  }
  counts.Undirected = vectors.Values && !features.Directed;
  const Eigen::Vector3d blend = share * steerable::TriplanarBlend(features.Normal);
  const std::size_t firstPlane = surface.IsTextured() ? 1 : 0;
  const double repeats = this->Lookups[firstPlane].Layout->Repeats;
  const Eigen::Vector3d place = surface.GetPoint(point) * repeats;
  const double wavelength = this->GetWavelength(point);
  const Eigen::Matrix3d feature = features.Feature * (wavelength * wavelength);
  for (int axis = 0; axis < 3; ++axis)
  {
    if (blend[axis] > 0.0)
    {
      const steerable::TextureGradients gradients =
        steerable::PlanarGradients(features.Normal, axis, 1.0 / repeats);
      const Eigen::Vector2d texture(place[axis == 0 ? 1 : 0], place[axis == 2 ? 1 : 2]);
      const std::size_t which = firstPlane + axis;
      const bool clamped = this->AddPoint(chunk.Planes[which], which, point - first, texture,
        steerable::SurfaceMetric(gradients, feature),
        gradients.transpose() * features.Spacing * gradients, blend[axis], counts);
      counts.Clamped = counts.Clamped || clamped;
    }
  }
}

//------------------------------------------------------------------------------
// Adds a point with this metric, in squared repeats of the tile; tells whether it was clamped.
bool SubbandPointWeights::AddPoint(SubbandPlanePoints& plane, std::size_t which, vtkIdType point,
  const Eigen::Vector2d& texture, const Eigen::Matrix2d& metric, const Eigen::Matrix2d& footprint,
  double blend, SubbandPointCounts& counts) const
{
  if (!texture.allFinite() || !metric.allFinite())
  {
    return false;
  }
  plane.Points.push_back(static_cast<unsigned char>(point));
  plane.Texture.push_back(texture);
  plane.Shapes.push_back({ { metric(0, 0), metric(0, 1), metric(1, 1) },
    { footprint(0, 0), footprint(0, 1), footprint(1, 1) }, blend });
  const SubbandLookup& lookup = this->Lookups[which];
  Eigen::Matrix2d clamped = metric;
  if (lookup.Weights->GetParameters().Method == steerable::WeightMethod::None ||
    this->WholeImage || blend * blend < VisibleBlend || !lookup.Weights->ClampMetric(clamped))
  {
    return false;
  }
  // The range of the factors, from the range of eigenvalues.
  const double mean = 0.5 * metric.trace();
  const double radius = std::hypot(0.5 * (metric(0, 0) - metric(1, 1)), metric(0, 1));
  const double low = std::max(mean - radius, 1e-12 * mean);
  const double coarser = std::sqrt(lookup.Weights->GetSmallestMetric() / low);
  const double finer = std::sqrt((mean + radius) / lookup.Weights->GetLargestMetric());
  counts.Coarser = std::max(counts.Coarser, coarser);
  counts.Finer = std::max(counts.Finer, finer);
  return std::max(coarser, finer) > std::exp2(ClampedOctaves);
}

//------------------------------------------------------------------------------
void SubbandPointWeights::Weigh(
  SubbandPlanePoints& plane, std::size_t which, vtkIdType first) const
{
  const int components = this->Lookups[which].Tiles->Components();
  const std::size_t points = plane.Points.size();
  const std::size_t known = plane.Weights.size();
  const std::size_t octaves = this->GetWeightedOctaves();
  if (octaves <= known)
  {
    return;
  }
  plane.Weights.resize(octaves);
  for (std::size_t octave = known; octave < octaves; ++octave)
  {
    plane.Weights[octave].resize(components * points);
  }
  double gamma[steerable::MostSubbandComponents];
  for (std::size_t n = 0; n < points; ++n)
  {
    const vtkIdType point = first + plane.Points[n];
    this->ComputeGamma(plane.Shapes[n], which, point, gamma);
    for (std::size_t octave = known; octave < octaves; ++octave)
    {
      this->FilterOctave(plane.Shapes[n], which, point, static_cast<int>(octave), gamma,
        plane.Weights[octave].data() + n * components);
    }
  }
}

//------------------------------------------------------------------------------
// Weights of a plane as if it were the only one, before what each octave adds.
void SubbandPointWeights::ComputeGamma(const SubbandPlanePoints::Shape& shape, std::size_t which,
  vtkIdType point, double* gamma) const
{
  const SubbandLookup& lookup = this->Lookups[which];
  const int components = lookup.Tiles->Components();
  std::fill(gamma + lookup.Layout->Pyramid.Components(), gamma + components, 0.0);
  if (this->WholeImage)
  {
    std::fill_n(gamma, components, 1.0);
  }
  else
  {
    lookup.Weights->Compute(Symmetric(shape.Metric), gamma);
  }
  if (this->OwnWeights)
  {
    const int offset = this->GetFirstComponent(which);
    for (int c = 0; c < components; ++c)
    {
      const double own = this->OwnWeights->GetComponent(point, offset + c);
      gamma[c] = std::isfinite(own) ? own / shape.Blend : 0.0;
    }
  }
}

//------------------------------------------------------------------------------
// Weights of an octave: those before, faded where points are too far apart for its bands, times
// factors and the plane's share.
void SubbandPointWeights::FilterOctave(const SubbandPlanePoints::Shape& shape, std::size_t which,
  vtkIdType point, int octave, const double* gamma, float* weights) const
{
  const SubbandLookup& lookup = this->Lookups[which];
  const int bands = lookup.Layout->Pyramid.Components();
  const int components = lookup.Tiles->Components();
  double beta[steerable::MostSubbandComponents];
  if (this->AntiAlias)
  {
    const Eigen::Matrix2d footprint = Symmetric(shape.Footprint) * std::ldexp(1.0, 2 * octave);
    lookup.Weights->Antialias(footprint, beta);
    if (components > bands)
    {
      lookup.Weights->AntialiasHigh(footprint, beta + bands);
      beta[components - 1] = 1.0;
    }
    for (int c = 0; c < components; ++c)
    {
      beta[c] *= gamma[c];
    }
    if (this->Limited)
    {
      lookup.Weights->LimitVariance(1.0, beta);
    }
  }
  else
  {
    std::copy(gamma, gamma + components, beta);
  }
  if (this->Factors)
  {
    const int orientations = lookup.Layout->Pyramid.Orientations;
    // The low residual of an image has no orientation.
    for (int c = 0; c < (components > bands ? components - 1 : components); ++c)
    {
      beta[c] *= this->Factors->GetComponent(point, octave * orientations + c % orientations);
    }
  }
  for (int c = 0; c < components; ++c)
  {
    weights[c] = static_cast<float>(shape.Blend * beta[c]);
  }
}

//------------------------------------------------------------------------------
std::vector<double> SubbandPointWeights::GetKey() const
{
  std::vector<double> key = { this->Wavelength, this->Anisotropy, this->Wanted,
    double(this->AntiAlias), double(this->WholeImage), double(this->Limited),
    double(this->NeedsDistortion), double(this->Seams != nullptr) };
  for (const SubbandLookup& lookup : this->Lookups)
  {
    const std::array<double, 7> weights = KeyOf(lookup.Weights->GetParameters());
    key.insert(key.end(), weights.begin(), weights.end());
    key.insert(key.end(), { lookup.Layout->Repeats, double(lookup.Tiles->Residuals) });
  }
  if (this->Factors)
  {
    key.push_back(this->Octaves); // of the array's components
  }
  return key;
}
} // namespace noise
