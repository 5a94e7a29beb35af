// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Axes and eigenvalues of a block of samples, straight.
#if defined(STEERABLE_FAST_METRICS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_METRICS_INL_H
#undef STEERABLE_FAST_METRICS_INL_H
#else
#define STEERABLE_FAST_METRICS_INL_H
#endif

#include "Fast/Registers-inl.h"
#include "Fast/Stages.h"

#include <Eigen/Geometry>

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
HWY_INLINE VD ToDouble(const float* from)
{
  return hn::PromoteTo(DD(), hn::LoadU(DFH(), from));
}

/// An eigenvalue at full strength, at these strengths.
HWY_INLINE V AtStrength(double eigenvalue, V strength)
{
  return hn::MulAdd(strength, Const(static_cast<float>(eigenvalue) - 1.0f), Const(1.0f));
}

/**
 * v times 1/|v|, which is known up to rounding: the nearest floats, and what they lack. In double,
 * with one step of Newton: a length that is off shows as much as an eigenvalue that is.
 */
HWY_INLINE void SplitUnit(
  const V (&v)[3], V inverse, float* const (&unit)[2], float* const (&rest)[2])
{
  HWY_ALIGN float values[3][Lanes];
  hn::Store(v[0], DF(), values[0]);
  hn::Store(v[1], DF(), values[1]);
  hn::Store(inverse, DF(), values[2]);
  for (std::size_t lane = 0; lane < Lanes; lane += hn::MaxLanes(DD()))
  {
    const VD in[2] = { ToDouble(values[0] + lane), ToDouble(values[1] + lane) };
    const VD rounded = ToDouble(values[2] + lane);
    const VD length2 = hn::MulAdd(in[0], in[0], hn::Mul(in[1], in[1]));
    const VD lack = hn::NegMulAdd(hn::Mul(rounded, length2), rounded, hn::Set(DD(), 1.0));
    const VD factor = hn::MulAdd(hn::Mul(rounded, hn::Set(DD(), 0.5)), lack, rounded);
    for (int axis = 0; axis < 2; ++axis)
    {
      const VD exact = hn::Mul(in[axis], factor);
      const auto nearest = hn::DemoteTo(DFH(), exact);
      hn::StoreU(nearest, DFH(), unit[axis] + lane);
      hn::StoreU(hn::DemoteTo(DFH(), hn::Sub(exact, hn::PromoteTo(DD(), nearest))), DFH(),
        rest[axis] + lane);
    }
  }
}

/// What becomes of vectors.
enum class Wanted
{
  Units,
  /// With lengths, and in 2D, if there is room for it, what the units lack.
  Metrics,
  /// 2D: the vectors as they are, unless they are too long or too short to be squared, and
  /// 1/length.
  Inverses
};

/**
 * Directions of `count` tuples of 3 floats, 0 where there is none. In 2D they lie in the plane, and
 * the third component counts for the length alone. Returns whether all of them have a direction
 * beyond doubt.
 */
template <int N, Wanted What>
HWY_NOINLINE bool UnitVectors(const float* tuples, std::size_t count, float* const (&unit)[3],
  float* length = nullptr, float* const* rest = nullptr)
{
  constexpr bool metrics = What == Wanted::Metrics;
  const bool split = metrics && N == 2 && rest;
  bool all = true;
  HWY_ALIGN float tail[3 * Lanes];
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    const float* from = tuples + 3 * i;
    if (i + Lanes > count)
    {
      // The last tuple stands for those behind it.
      for (std::size_t value = 0; value < 3 * Lanes; ++value)
      {
        tail[value] = from[std::min(value, 3 * (count - i) - 3 + value % 3)];
      }
      from = tail;
    }
    V u[3];
    hn::LoadInterleaved3(DF(), from, u[0], u[1], u[2]);
    V length2 = hn::MulAdd(u[0], u[0], hn::Mul(u[1], u[1]));
    const V third = N == 3 ? u[2] : hn::IfThenElseZero(hn::IsFinite(u[2]), u[2]);
    const V whole2 = hn::MulAdd(third, third, length2);
    if constexpr (N == 3)
    {
      length2 = whole2;
    }
    // NaN fails the comparisons; what squares to too much or too little, or is next to nothing in
    // the plane, is looked at again.
    constexpr auto least = static_cast<float>(2.0 * SmallestInPlane * SmallestInPlane);
    const V smallest = hn::Max(Const(1e-30f), hn::Mul(whole2, Const(least)));
    const auto good = hn::And(hn::Gt(length2, smallest), hn::Lt(whole2, Const(1e30f)));
    const V norm = hn::Sqrt(length2);
    const V inverse = hn::Div(Const(1.0f), norm);
    if constexpr (What == Wanted::Inverses)
    {
      hn::StoreU(u[0], DF(), unit[0] + i);
      hn::StoreU(u[1], DF(), unit[1] + i);
      hn::StoreU(inverse, DF(), unit[2] + i);
    }
    else if (split)
    {
      SplitUnit(u, inverse, { unit[0] + i, unit[1] + i }, { rest[0] + i, rest[1] + i });
    }
    else
    {
      for (int axis = 0; axis < N; ++axis)
      {
        hn::StoreU(hn::Mul(u[axis], inverse), DF(), unit[axis] + i);
      }
    }
    if (metrics)
    {
      hn::StoreU(N == 2 ? hn::Sqrt(whole2) : norm, DF(), length + i);
    }
    if (!hn::AllTrue(DF(), good))
    {
      all = false;
      HWY_ALIGN float isGood[Lanes];
      hn::Store(hn::IfThenElseZero(good, Const(1.0f)), DF(), isGood);
      for (std::size_t lane = 0; lane < Lanes && i + lane < count; ++lane)
      {
        if (isGood[lane] != 0.0f)
        {
          continue;
        }
        Vector<N> vector;
        for (int axis = 0; axis < N; ++axis)
        {
          vector[axis] = from[3 * lane + axis];
        }
        const double largest = vector.cwiseAbs().maxCoeff();
        const double norm = vector.norm(); // in double: there is room for squares
        const double whole = N == 2 ? WholeLength(norm, from[3 * lane + 2]) : norm;
        const bool finite = vector.allFinite();
        const bool any = finite && largest > 0.0 && norm > SmallestInPlane * whole;
        vector = any ? Vector<N>(vector.normalized()) : Vector<N>::Zero(); // in double
        for (int axis = 0; axis < N; ++axis)
        {
          unit[axis][i + lane] = static_cast<float>(vector[axis]);
          if (split)
          {
            rest[axis][i + lane] = RestOf(vector[axis]);
          }
        }
        if (metrics)
        {
          length[i + lane] = finite ? static_cast<float>(whole) : 0.0f;
        }
        if (What == Wanted::Inverses)
        {
          unit[2][i + lane] = any ? 1.0f : 0.0f;
        }
      }
    }
  }
  return all;
}

/// Splits u of a sample with a second axis into floats and what they lack on the axes across.
inline void SetAxes(const Vector<3>& u, const Vector<3>& m, std::size_t to, MetricBlock& block)
{
  const Vector<3> rest = u - u.cast<float>().cast<double>();
  block.URest[0][to] = static_cast<float>(rest.dot(m));
  block.URest[1][to] = static_cast<float>(rest.dot(u.cross(m)));
  for (int axis = 0; axis < 3; ++axis)
  {
    block.U[axis][to] = static_cast<float>(u[axis]);
    block.M[axis][to] = static_cast<float>(m[axis]);
  }
}

/// a . b, added up as Eigen does.
HWY_INLINE VD DotInDouble(const VD (&a)[3], const VD (&b)[3])
{
  return hn::Add(hn::Mul(a[0], b[0]), hn::Add(hn::Mul(a[1], b[1]), hn::Mul(a[2], b[2])));
}

/**
 * Unit vectors from `at` on projected on the tangent planes of its normals, in double since a steep
 * vector leaves little; a sample without a normal is not on a surface and keeps its vector.
 */
HWY_NOINLINE void ProjectOnSurface(
  const float* vectors, const float* normals, std::size_t at, std::size_t count, MetricBlock& block)
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN float tail[2][3 * half] = {};
  const VD zero = hn::Zero(DD());
  for (std::size_t i = 0; i < count; i += half)
  {
    const float* from[2] = { GetTuples(vectors + 3 * i, count - i, tail[0]),
      GetTuples(normals + 3 * i, count - i, tail[1]) };
    VD v[2][3];
    for (int k = 0; k < 2; ++k)
    {
      hn::Vec<DFH> tuple[3];
      hn::LoadInterleaved3(DFH(), from[k], tuple[0], tuple[1], tuple[2]);
      for (int axis = 0; axis < 3; ++axis)
      {
        v[k][axis] = hn::PromoteTo(DD(), tuple[axis]);
      }
    }
    VD(&u)[3] = v[0];
    VD(&m)[3] = v[1];
    const VD length = hn::Sqrt(DotInDouble(m, m));
    const auto onSurface = hn::And(hn::Gt(length, zero), hn::IsFinite(length));
    const std::size_t to = at + i;
    VD unit[3];
    auto any = hn::Lt(zero, zero);
    for (int axis = 0; axis < 3; ++axis)
    {
      m[axis] = hn::IfThenElseZero(onSurface, hn::Div(m[axis], length));
      unit[axis] = hn::PromoteTo(DD(), hn::LoadU(DFH(), block.U[axis] + to));
      any = hn::Or(any, hn::Ne(unit[axis], zero));
    }
    const VD norm = hn::Sqrt(DotInDouble(u, u));
    for (VD& component : u)
    {
      component = hn::Div(component, norm);
    }
    const VD along = DotInDouble(u, m);
    for (int axis = 0; axis < 3; ++axis)
    {
      u[axis] = hn::Sub(u[axis], hn::Mul(along, m[axis]));
    }
    // A vector along the normal has no direction on the surface: what is left of it is rounding.
    const VD inPlane = hn::Sqrt(DotInDouble(u, u));
    const auto steep = hn::Not(hn::Gt(inPlane, hn::Set(DD(), SmallestInPlane)));
    VD rest[3];
    VD third[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const VD projected = hn::IfThenZeroElse(steep, hn::Div(u[axis], inPlane));
      u[axis] = hn::IfThenElse(hn::And(onSurface, any), projected, unit[axis]);
      const auto rounded = hn::DemoteTo(DFH(), u[axis]);
      hn::StoreU(rounded, DFH(), block.U[axis] + to);
      hn::StoreU(hn::DemoteTo(DFH(), m[axis]), DFH(), block.M[axis] + to);
      rest[axis] = hn::Sub(u[axis], hn::PromoteTo(DD(), rounded));
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const int j = (axis + 1) % 3;
      const int k = (axis + 2) % 3;
      third[axis] = hn::Sub(hn::Mul(u[j], m[k]), hn::Mul(u[k], m[j]));
    }
    hn::StoreU(hn::DemoteTo(DFH(), DotInDouble(rest, m)), DFH(), block.URest[0] + to);
    hn::StoreU(hn::DemoteTo(DFH(), DotInDouble(rest, third)), DFH(), block.URest[1] + to);
  }
}

/// Eigenvalues of the metrics of the unit vectors from `at` on, and what stands for missing ones.
template <int N>
HWY_NOINLINE void MetricsOfDirections(
  const NoiseSetup& setup, MetricBlock& block, std::size_t at, std::size_t count)
{
  const NoiseParameters& p = setup.Parameters;
  const EigenvalueRange range = VectorEigenvalues(p, N);
  const double surfaceAcross = SurfaceEigenvalues(p).Across;
  const V zero = Const(0.0f);
  const V one = Const(1.0f);
  for (std::size_t i = at; i < at + count; i += Lanes)
  {
    const V u0 = Load(block.U[0] + i);
    V some = hn::Or(u0, Load(block.U[1] + i));
    if constexpr (N == 3)
    {
      some = hn::Or(some, Load(block.U[2] + i));
    }
    const auto there = hn::Ne(hn::Abs(some), zero);
    V strength = Const(static_cast<float>(p.Strength));
    if (p.StrengthMode == StrengthMode::Magnitude)
    {
      const V share =
        hn::Div(Load(block.Length + i), Const(static_cast<float>(p.ReferenceMagnitude)));
      strength = hn::Mul(strength, hn::Min(share, one));
    }
    strength = hn::IfThenElseZero(there, strength);
    hn::StoreU(hn::IfThenElse(there, u0, one), DF(), block.U[0] + i);
    hn::StoreU(AtStrength(range.Along, strength), DF(), block.Along + i);
    hn::StoreU(hn::IfThenElseZero(there, one), DF(), block.Directed + i);
    if (!setup.Biaxial)
    {
      hn::StoreU(AtStrength(range.Across, strength), DF(), block.Across + i);
      continue;
    }
    V u[3];
    V m[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      u[axis] = Load(block.U[axis] + i);
      m[axis] = Load(block.M[axis] + i);
    }
    const V m2 = Dot(m, m);
    const auto onSurface = hn::Gt(m2, Const(0.5f));
    const V across = AtStrength(range.Across, strength);
    hn::StoreU(hn::IfThenElse(onSurface, AtStrength(surfaceAcross, strength), across), DF(),
      block.Across + i);
    hn::StoreU(hn::IfThenElse(onSurface, AtStrength(SurfaceNormalEigenvalue, strength), across),
      DF(), block.Second + i);
    // Without a surface, or a direction in it, any axis across u will do.
    const auto keeps = hn::And(there, onSurface);
    V other[3];
    AnyAcross(u, other);
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::StoreU(hn::IfThenElse(keeps, m[axis], other[axis]), DF(), block.M[axis] + i);
    }
  }
}

/// Eigenvalues of samples that have a shape of their own, in place of those that
/// MetricsOfDirections gave them.
template <int N>
void ReshapeMetrics(const NoiseSetup& setup, const float* shapes, const float* normals,
  std::size_t at, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t to = at + i;
    if (block.Directed[to] == 0.0f)
    {
      continue;
    }
    const NoiseParameters own = WithShape(setup.Parameters, shapes + 3 * i);
    bool onSurface = false; // as ProjectOnSurface has it
    if (normals)
    {
      const double length =
        Eigen::Map<const Eigen::Vector3f>(normals + 3 * i).template cast<double>().norm();
      onSurface = length > 0.0 && std::isfinite(length);
    }
    const EigenvalueRange range =
      onSurface ? SurfaceEigenvalues(own) : VectorEigenvalues(own, N);
    const double strength = StrengthOf(own, block.Length[to]);
    const auto blend = [=](double eigenvalue)
    { return static_cast<float>(1.0 + strength * (eigenvalue - 1.0)); };
    block.Along[to] = blend(range.Along);
    block.Across[to] = blend(range.Across);
    block.Second[to] = blend(onSurface ? SurfaceNormalEigenvalue : range.Across);
  }
}

/// Repeats the sample before `end` behind it, so that the lanes there are like their neighbours.
void PadTail(MetricBlock& block, std::size_t end)
{
  const auto pad = [end](auto* array) { std::fill_n(array + end, Lanes, array[end - 1]); };
  for (float* array : { block.U[0], block.U[1], block.U[2], block.M[0], block.M[1], block.M[2],
         block.URest[0], block.URest[1], block.Bend[0], block.Bend[1], block.Bend[2], block.Along,
         block.Across, block.Second, block.Directed })
  {
    pad(array);
  }
}

/// Tensors and metrics go one by one through Eigen's solver: `toMetric(parameters, tensor, norm)`
/// gives what becomes of one.
template <int N, typename Value, class ToMetric>
void MetricsOfTensors(const NoiseSetup& setup, const Value* tuples, const float* shapes,
  std::size_t at, std::size_t count, MetricBlock& block, ToMetric&& toMetric)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t to = at + i;
    const Matrix<N> tensor = TensorOf<N>(tuples + 6 * i);
    const double norm = NormOf<N>(tensor, tuples + 6 * i);
    const AxialMetric<N> metric = shapes
      ? toMetric(WithShape(setup.Parameters, shapes + 3 * i), tensor, norm)
      : toMetric(setup.Parameters, tensor, norm);
    if constexpr (N == 3)
    {
      SetAxes(metric.Direction, metric.SecondAxis, to, block);
    }
    else
    {
      for (int axis = 0; axis < N; ++axis)
      {
        block.U[axis][to] = static_cast<float>(metric.Direction[axis]);
        block.URest[axis][to] = RestOf(metric.Direction[axis]);
      }
    }
    block.Along[to] = static_cast<float>(metric.Along);
    block.Across[to] = static_cast<float>(metric.Across);
    block.Second[to] = static_cast<float>(metric.Second);
    block.Directed[to] = metric.Degenerate ? 0.0f : 1.0f;
    for (int axis = 0; axis < N && setup.Curved; ++axis)
    {
      block.Bend[axis][to] *= static_cast<float>(metric.Clarity);
    }
    block.Length[to] = std::isfinite(norm) ? static_cast<float>(norm) : 0.0f;
  }
}

/// Directions along the flow of samples [first, first + count), as AddDerivative takes them; 0
/// where there is none.
template <int N>
void Directions(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t count,
  MetricBlock& block, float* const (&row)[3])
{
  if (field.Vectors)
  {
    constexpr Wanted wanted = N == 2 ? Wanted::Inverses : Wanted::Units;
    UnitVectors<N, wanted>(field.Vectors->Read(first, count, block.Tuples), count, row);
    return;
  }
  const float* tensors =
    field.Tensors ? field.Tensors->Read(first, count, block.Tuples) : nullptr;
  const double* metrics =
    field.Metrics ? field.Metrics->Read(first, count, block.MetricTuples) : nullptr;
  for (std::size_t i = 0; i < count; ++i)
  {
    const AxialMetric<N> metric = tensors
      ? MetricFromTensor<N>(setup.Parameters, TensorOf<N>(tensors + 6 * i))
      : MetricFromMetric<N>(setup.Parameters, TensorOf<N>(metrics + 6 * i), 0.0);
    const bool any = !metric.Degenerate && (tensors || metric.Clarity > 0.0);
    const Vector<N> direction = any ? metric.Direction : Vector<N>::Zero();
    row[2][i] = any ? 1.0f : 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      row[axis][i] = static_cast<float>(direction[axis]);
    }
  }
}

/// The metric I from `at` on, which has any axes.
inline void MetricsOfNothing(std::size_t at, std::size_t count, MetricBlock& block)
{
  const auto fill = [=](float* array, float value)
  { std::fill_n(array + at, count + Lanes, value); };
  for (int axis = 0; axis < 3; ++axis)
  {
    fill(block.U[axis], axis == 0 ? 1.0f : 0.0f);
    fill(block.M[axis], axis == 1 ? 1.0f : 0.0f);
  }
  for (float* array : { block.URest[0], block.URest[1], block.Length, block.Directed })
  {
    fill(array, 0.0f);
  }
  for (float* array : { block.Along, block.Across, block.Second })
  {
    fill(array, 1.0f);
  }
}

/// Axes and eigenvalues from `at` on, once the bend is known. True: all have a direction and the
/// same strength, and none of their eigenvalues are written.
template <int N>
bool Metrics(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t at,
  std::size_t count, MetricBlock& block, std::uint64_t& bounded)
{
  if (field.Isotropic)
  {
    MetricsOfNothing(at, count, block);
    return setup.Uniform;
  }
  const float* shapes = field.Shapes ? field.Shapes->Read(first, count, block.Shapes) : nullptr;
  if (field.Tensors)
  {
    MetricsOfTensors<N>(setup, field.Tensors->Read(first, count, block.Tuples), shapes, at, count,
      block,
      [](const NoiseParameters& parameters, const Matrix<N>& tensor, double norm)
      { return MetricFromTensor<N>(parameters, tensor, norm); });
    PadTail(block, at + count);
    return false;
  }
  if (field.Metrics)
  {
    MetricsOfTensors<N>(setup, field.Metrics->Read(first, count, block.MetricTuples), shapes, at,
      count, block,
      [&](const NoiseParameters& parameters, const Matrix<N>& tensor, double norm)
      {
        bool isBounded = false;
        const AxialMetric<N> metric = MetricFromMetric<N>(parameters, tensor, norm, &isBounded);
        bounded += isBounded;
        return metric;
      });
    PadTail(block, at + count);
    return false;
  }
  float* const unit[3] = { block.U[0] + at, block.U[1] + at, block.U[2] + at };
  const float* vectors = field.Vectors->Read(first, count, block.Tuples);
  if (setup.Uniform && UnitVectors<N, Wanted::Units>(vectors, count, unit))
  {
    return true;
  }
  float* const rest[2] = { block.URest[0] + at, block.URest[1] + at };
  UnitVectors<N, Wanted::Metrics>(
    vectors, count, unit, block.Length + at, setup.SingleCell ? nullptr : rest);
  const float* normals = nullptr;
  if (field.Normals)
  {
    normals = field.Normals->Read(first, count, block.Tuples + 3 * BlockRoom);
    ProjectOnSurface(vectors, normals, at, count, block);
  }
  MetricsOfDirections<N>(setup, block, at, count);
  if (shapes)
  {
    ReshapeMetrics<N>(setup, shapes, normals, at, count, block);
  }
  PadTail(block, at + count);
  return false;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
