// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Metrics of a block of samples (a part of SteerableNoiseSimd-inl.h, which includes it).

/// 1/|u| less `inverse`, which is rounded, as a share of it: half of 1 - inverse² |u|², in double.
HWY_INLINE V CorrectionOf(V inverse, const V (&u)[2])
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN float rounded[Lanes];
  HWY_ALIGN float x[Lanes];
  HWY_ALIGN float y[Lanes];
  hn::Store(inverse, DF(), rounded);
  hn::Store(u[0], DF(), x);
  hn::Store(u[1], DF(), y);
  for (std::size_t lane = 0; lane < Lanes; lane += half)
  {
    const auto get = [lane](const float* from) HWY_ATTR
    { return hn::PromoteTo(DD(), hn::Load(DFH(), from + lane)); };
    const VD length2 = hn::MulAdd(get(x), get(x), hn::Mul(get(y), get(y)));
    const VD factor = get(rounded);
    const VD lack = hn::NegMulAdd(hn::Mul(factor, length2), factor, hn::Set(DD(), 1.0));
    hn::Store(hn::DemoteTo(DFH(), lack), DFH(), rounded + lane);
  }
  return hn::Mul(Const(0.5f), hn::Load(DF(), rounded));
}

/**
 * Unit vectors of `count` tuples of 3 floats, 0 where there is none. In 2D the third component is not
 * looked at. Not if `Bare`: also their lengths, and what stays behind the high parts. Returns whether
 * all of them have a direction beyond doubt.
 */
template <int N, bool Bare>
HWY_NOINLINE bool UnitVectors(const float* tuples, std::size_t count, float* const (&unit)[3],
  float* length = nullptr, float* const* low = nullptr)
{
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
    if constexpr (N == 3)
    {
      length2 = hn::MulAdd(u[2], u[2], length2);
    }
    // NaN fails both comparisons; what squares to too much or too little is looked at again.
    const auto good = hn::And(hn::Gt(length2, Const(1e-30f)), hn::Lt(length2, Const(1e30f)));
    const V norm = hn::Sqrt(length2);
    const V inverse = hn::Div(Const(1.0f), norm);
    const V correction = !Bare && N == 2 ? CorrectionOf(inverse, { u[0], u[1] }) : hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      V component = hn::Mul(u[axis], inverse);
      if (!Bare && N == 2)
      {
        const V rest = hn::MulAdd(component, correction, hn::MulSub(u[axis], inverse, component));
        const V product = component;
        component = hn::Add(product, rest);
        hn::StoreU(hn::Add(hn::Sub(product, HighPart(component)), rest), DF(), low[axis] + i);
      }
      hn::StoreU(component, DF(), unit[axis] + i);
    }
    if (!Bare)
    {
      hn::StoreU(norm, DF(), length + i);
    }
    if (!hn::AllTrue(DF(), good))
    {
      all = false;
      for (std::size_t lane = 0; lane < Lanes && i + lane < count; ++lane)
      {
        Vector<N> vector;
        for (int axis = 0; axis < N; ++axis)
        {
          vector[axis] = from[3 * lane + axis];
        }
        const double largest = vector.cwiseAbs().maxCoeff();
        const bool any = largest > 0.0 && vector.allFinite();
        const double norm2 = vector.squaredNorm();
        if (any && norm2 > 1e-30 && norm2 < 1e30)
        {
          continue;
        }
        vector = any ? Vector<N>(vector.normalized()) : Vector<N>::Zero(); // in double
        for (int axis = 0; axis < N; ++axis)
        {
          unit[axis][i + lane] = static_cast<float>(vector[axis]);
          if (!Bare && N == 2)
          {
            low[axis][i + lane] = LowPart(vector[axis]);
          }
        }
        if (!Bare)
        {
          length[i + lane] = any ? static_cast<float>(std::sqrt(norm2)) : 0.0f;
        }
      }
    }
  }
  return all;
}

/**
 * Unit vectors from `at` on projected on the tangent planes of its normals, in double since a steep
 * vector leaves little; a sample without a normal is not on a surface and keeps its vector.
 */
void ProjectOnSurface(
  const float* vectors, const float* normals, std::size_t at, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t to = at + i;
    const Vector<3> normal = Eigen::Map<const Eigen::Vector3f>(normals + 3 * i).cast<double>();
    const double length = normal.norm();
    const bool onSurface = length > 0.0 && std::isfinite(length);
    const Vector<3> m = onSurface ? Vector<3>(normal / length) : Vector<3>::Zero();
    Vector<3> u(block.U[0][to], block.U[1][to], block.U[2][to]);
    if (onSurface && block.Length[to] > 1e-15f && block.Length[to] < 1e15f)
    {
      u = Eigen::Map<const Eigen::Vector3f>(vectors + 3 * i).cast<double>() / block.Length[to];
    }
    if (onSurface && !u.isZero(0.0))
    {
      u -= u.dot(m) * m;
      // A vector along the normal has no direction on the surface: what is left of it is rounding.
      const double inPlane = u.norm();
      u = inPlane > 1e-5 ? Vector<3>(u / inPlane) : Vector<3>::Zero();
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      block.U[axis][to] = static_cast<float>(u[axis]);
      block.M[axis][to] = static_cast<float>(m[axis]);
    }
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
    if (p.StrengthBy == StrengthMode::Magnitude)
    {
      const V share =
        hn::Div(Load(block.Length + i), Const(static_cast<float>(p.ReferenceMagnitude)));
      strength = hn::Mul(strength, hn::Min(share, one));
    }
    strength = hn::IfThenElseZero(there, strength);
    hn::StoreU(hn::IfThenElse(there, u0, one), DF(), block.U[0] + i);
    hn::StoreU(AtStrength(range.Along, strength), DF(), block.Along + i);
    hn::StoreU(hn::IfThenElseZero(there, one), DF(), block.Sense + i);
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
    // Without a surface, or a direction in it, any axis across u will do: u x x or u x y.
    const auto keeps = hn::And(there, onSurface);
    const auto byX = hn::Lt(hn::Abs(u[0]), Const(0.7f));
    const V other[3] = { hn::IfThenElse(byX, zero, hn::Neg(u[2])),
      hn::IfThenElseZero(byX, u[2]), hn::IfThenElse(byX, hn::Neg(u[1]), u[0]) };
    const V length = hn::Sqrt(Dot(other, other));
    for (int axis = 0; axis < 3; ++axis)
    {
      hn::StoreU(
        hn::IfThenElse(keeps, m[axis], hn::Div(other[axis], length)), DF(), block.M[axis] + i);
    }
  }
}

/// Adds u_axis ∂u/∂axis to the bend, the neighbours turned to the side of the middle one.
template <int N>
HWY_INLINE void AddDerivative(MetricBlock& block, std::size_t at, std::size_t count, int axis,
  const std::array<const float*, 3>& before, const std::array<const float*, 3>& after,
  const float* scale, bool perLane)
{
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    const std::size_t to = at + i;
    V u[N];
    V a[N];
    V c[N];
    for (int k = 0; k < N; ++k)
    {
      u[k] = Load(block.U[k] + to);
      a[k] = Load(before[k] + i);
      c[k] = Load(after[k] + i);
    }
    const V zero = Const(0.0f);
    const V factor = hn::Mul(u[axis], perLane ? Load(scale + i) : Const(*scale));
    const V signA = Dot(u, a);
    const V signC = Dot(u, c);
    // A neighbour without a direction stands for no change.
    const auto noneA = hn::Eq(Dot(a, a), zero);
    const auto noneC = hn::Eq(Dot(c, c), zero);
    const V mask = hn::BitCast(DF(), hn::Set(DU(), 0x80000000u));
    for (int k = 0; k < N; ++k)
    {
      const V fromA = hn::IfThenElse(noneA, u[k], hn::Xor(a[k], hn::And(signA, mask)));
      const V fromC = hn::IfThenElse(noneC, u[k], hn::Xor(c[k], hn::And(signC, mask)));
      const V sum = hn::MulAdd(factor, hn::Sub(fromC, fromA), Load(block.Bend[k] + to));
      hn::StoreU(sum, DF(), block.Bend[k] + to);
    }
  }
}

/// Splits tuples of 3 into the bend; what is not finite or beyond sense becomes 0.
template <int N>
HWY_NOINLINE void CopyCurvature(
  const NoiseSetup& setup, const float* tuples, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    double bend[N];
    double length2 = 0.0;
    for (int axis = 0; axis < N; ++axis)
    {
      bend[axis] = tuples[3 * i + axis] * setup.Parameters.FeatureSize;
      length2 += bend[axis] * bend[axis];
    }
    const bool good = length2 < 1e30;
    for (int axis = 0; axis < N; ++axis)
    {
      block.Bend[axis][i] = good ? static_cast<float>(bend[axis]) : 0.0f;
    }
  }
}

/// Repeats the sample before `end` behind it, so that the lanes there are like their neighbours.
void PadTail(MetricBlock& block, std::size_t end)
{
  const auto pad = [end](auto* array) { std::fill_n(array + end, Lanes, array[end - 1]); };
  for (float* array : { block.U[0], block.U[1], block.U[2], block.M[0], block.M[1], block.M[2],
         block.ULow[0], block.ULow[1], block.Bend[0], block.Bend[1], block.Bend[2], block.Along,
         block.Across, block.Second, block.Sense })
  {
    pad(array);
  }
}

/// Tensors go one by one through Eigen's solver.
template <int N>
void MetricsOfTensors(const NoiseSetup& setup, const float* tuples, std::size_t at,
  std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::size_t to = at + i;
    const Matrix<N> tensor = TensorOf<N>(tuples + 6 * i);
    const AxialMetric<N> metric = MetricFromTensor<N>(setup.Parameters, tensor);
    for (int axis = 0; axis < N; ++axis)
    {
      block.U[axis][to] = static_cast<float>(metric.Direction[axis]);
      block.M[axis][to] = static_cast<float>(metric.SecondAxis[axis]);
      if constexpr (N == 2)
      {
        block.ULow[axis][to] = LowPart(metric.Direction[axis]);
      }
    }
    block.Along[to] = static_cast<float>(metric.Along);
    block.Across[to] = static_cast<float>(metric.Across);
    block.Second[to] = static_cast<float>(metric.Second);
    block.Sense[to] = metric.Degenerate ? 0.0f : 1.0f;
    for (int axis = 0; axis < N && setup.Curved; ++axis)
    {
      block.Bend[axis][to] *= static_cast<float>(metric.Clarity);
    }
    const double norm = tensor.norm();
    block.Length[to] = std::isfinite(norm) ? static_cast<float>(norm) : 0.0f;
  }
}

/// Unit vectors along the flow for samples [first, first + count): 0 where there is none.
template <int N>
void Directions(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t count,
  MetricBlock& block, float* const (&unit)[3])
{
  if (field.Vectors)
  {
    UnitVectors<N, true>(field.Vectors->Read(first, count, block.Tuples), count, unit);
    return;
  }
  const float* tuples = field.Tensors->Read(first, count, block.Tuples);
  for (std::size_t i = 0; i < count; ++i)
  {
    const AxialMetric<N> metric =
      MetricFromTensor<N>(setup.Parameters, TensorOf<N>(tuples + 6 * i));
    for (int axis = 0; axis < N; ++axis)
    {
      unit[axis][i] = metric.Degenerate ? 0.0f : static_cast<float>(metric.Direction[axis]);
    }
  }
}

/// Axes and eigenvalues from `at` on, once the bend is known. True: all have a direction and the same
/// strength, and none of their eigenvalues are written.
template <int N>
bool Metrics(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t at,
  std::size_t count, MetricBlock& block)
{
  if (field.Tensors)
  {
    MetricsOfTensors<N>(setup, field.Tensors->Read(first, count, block.Tuples), at, count, block);
    PadTail(block, at + count);
    return false;
  }
  float* const unit[3] = { block.U[0] + at, block.U[1] + at, block.U[2] + at };
  const float* vectors = field.Vectors->Read(first, count, block.Tuples);
  if (setup.Uniform && UnitVectors<N, true>(vectors, count, unit))
  {
    return true;
  }
  float* const low[2] = { block.ULow[0] + at, block.ULow[1] + at };
  UnitVectors<N, false>(vectors, count, unit, block.Length + at, low);
  if (field.Normals)
  {
    const float* normals = field.Normals->Read(first, count, block.Tuples + 3 * BlockRoom);
    ProjectOnSurface(vectors, normals, at, count, block);
  }
  MetricsOfDirections<N>(setup, block, at, count);
  PadTail(block, at + count);
  return false;
}
