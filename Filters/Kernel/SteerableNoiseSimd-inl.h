// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of the fast path, compiled once for each SIMD level (private to SteerableNoise.cxx, which
 * includes this inside Highway's per-target pass; hence no include guard of the usual kind).
 *
 * A register holds one number of several samples. Every lane follows the same arithmetic whatever
 * its neighbours are: corners that only another lane needs add exactly 0.
 */
namespace steerable
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::ScalableTag<std::int32_t>;
using DU = hn::ScalableTag<std::uint32_t>;
using DD = hn::ScalableTag<double>;
using DFH = hn::Rebind<float, DD>;
using V = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using VD = hn::Vec<DD>;

constexpr std::size_t Lanes = hn::MaxLanes(DF());

HWY_INLINE V Const(float value)
{
  return hn::Set(DF(), value);
}

HWY_INLINE V Load(const float* p)
{
  return hn::LoadU(DF(), p);
}

template <int N>
HWY_INLINE V Dot(const V (&a)[N], const V (&b)[N])
{
  V sum = hn::Mul(a[0], b[0]);
  for (int i = 1; i < N; ++i)
  {
    sum = hn::MulAdd(a[i], b[i], sum);
  }
  return sum;
}

/// The 16 leading bits of a float: a product with a number of 8 bits is exact.
HWY_INLINE V HighPart(V v)
{
  return hn::And(v, hn::BitCast(DF(), hn::Set(DU(), HighPartMask)));
}

/// Bounds of loops over corners, whatever the number is.
HWY_INLINE int ToCorner(float place)
{
  return static_cast<int>(std::min(1000.0f, std::max(-1000.0f, place)));
}

HWY_INLINE float LeastLane(V v)
{
  return hn::GetLane(hn::MinOfLanes(DF(), v));
}

HWY_INLINE float GreatestLane(V v)
{
  return hn::GetLane(hn::MaxOfLanes(DF(), v));
}

// ---- parts of a surflet -------------------------------------------------------------------------

/**
 * Kensler's quintic for t >= 0, exactly 0 from t = 1 on. With r = 1 - t it is r³ (6t² + 3t + 1), which
 * keeps its relative precision where it is small: normalisation would show what is lost there.
 */
HWY_INLINE V QuinticFade(V t)
{
  t = hn::Min(t, Const(1.0f));
  const V r = hn::Sub(Const(1.0f), t);
  const V inner = hn::MulAdd(hn::MulAdd(Const(6.0f), t, Const(3.0f)), t, Const(1.0f));
  return hn::Mul(hn::Mul(hn::Mul(r, r), r), inner);
}

/// The same with its absolute precision only, two operations less: enough for a sum that nothing divides.
HWY_INLINE V PlainQuinticFade(V t)
{
  t = hn::Min(t, Const(1.0f));
  const V inner = hn::MulAdd(hn::MulAdd(Const(6.0f), t, Const(-15.0f)), t, Const(10.0f));
  return hn::NegMulAdd(inner, hn::Mul(hn::Mul(t, t), t), Const(1.0f));
}

HWY_INLINE V FadeOf(Fade fade, V t)
{
  t = hn::Abs(t);
  switch (fade)
  {
    case Fade::Cubic:
    {
      t = hn::Min(t, Const(1.0f));
      return hn::NegMulAdd(hn::NegMulAdd(Const(2.0f), t, Const(3.0f)), hn::Mul(t, t), Const(1.0f));
    }
    case Fade::Wide:
    {
      const V s = hn::Max(hn::NegMulAdd(Const(0.25f), hn::Mul(t, t), Const(1.0f)), Const(0.0f));
      const V s2 = hn::Mul(s, s);
      return hn::Mul(hn::MulAdd(Const(4.0f), s, Const(-3.0f)), hn::Mul(s2, s2));
    }
    case Fade::Quintic:
    default:
      return QuinticFade(t);
  }
}

/// sin(πx) and cos(πx) for x in [-1/2, 1/2]: minimax polynomials, errors 4e-9 and 5e-8.
HWY_INLINE V SinPi(V x)
{
  const V y = hn::Mul(x, x);
  V p = hn::MulAdd(Const(0.0772201289f), y, Const(-0.598045174f));
  p = hn::MulAdd(p, y, Const(2.55003138f));
  p = hn::MulAdd(p, y, Const(-5.16770688f));
  p = hn::MulAdd(p, y, Const(3.14159258f));
  return hn::Mul(p, x);
}

HWY_INLINE V CosPi(V x)
{
  const V y = hn::Mul(x, x);
  V p = hn::MulAdd(Const(0.219696798f), y, Const(-1.33188016f));
  p = hn::MulAdd(p, y, Const(4.05841191f));
  p = hn::MulAdd(p, y, Const(-4.93479286f));
  return hn::MulAdd(p, y, Const(0.999999953f));
}

HWY_INLINE VU HashOneAxis(VU coordinate, int axis)
{
  VU h = hn::Mul(coordinate, hn::Set(DU(), HashAxis[axis]));
  h = hn::Xor(h, hn::ShiftRight<HashAxisShift>(h));
  return hn::Mul(h, hn::Set(DU(), HashAxisFinal[axis]));
}

HWY_INLINE VU HashJoinAxes(VU h)
{
  h = hn::Xor(h, hn::ShiftRight<HashJoinShift>(h));
  h = hn::Mul(h, hn::Set(DU(), HashJoin));
  return hn::Xor(h, hn::ShiftRight<HashJoinShift>(h));
}

HWY_INLINE VU HashStream(VU hash, std::uint32_t stream)
{
  return HashJoinAxes(hn::Add(hash, hn::Set(DU(), stream * HashSeed)));
}

HWY_INLINE V HashToUnit(VU hash)
{
  return hn::Mul(
    hn::ConvertTo(DF(), hn::BitCast(DI(), hn::ShiftRight<8>(hash))), Const(1.0f / 16777216.0f));
}

/// The bits as a signed number in steps of 2^-32: [-1/2, 1/2).
HWY_INLINE V HashToSigned(VU hash)
{
  return hn::Mul(hn::ConvertTo(DF(), hn::BitCast(DI(), hash)), Const(1.0f / 4294967296.0f));
}

HWY_INLINE void UniformGradient(VU hash, V (&g)[2])
{
  const V sign = hn::BitCast(DF(), hn::And(hash, hn::Set(DU(), 0x80000000u)));
  const V turn = HashToSigned(hn::ShiftLeft<1>(hash));
  g[0] = hn::Xor(CosPi(turn), sign);
  g[1] = hn::Xor(SinPi(turn), sign);
}

HWY_INLINE void UniformGradient(VU hash, V (&g)[3])
{
  const V sign = hn::BitCast(DF(), hn::And(hash, hn::Set(DU(), 0x80000000u)));
  const VU heightBits = hn::And(hn::ShiftLeft<1>(hash), hn::Set(DU(), 0xFFFE0000u));
  const V height = hn::MulAdd(hn::ConvertTo(DF(), hn::BitCast(DI(), heightBits)),
    Const(1.0f / 2147483648.0f), Const(1.0f / 32768.0f));
  const V turn = hn::Add(HashToSigned(hn::ShiftLeft<16>(hash)), Const(1.0f / 131072.0f));
  const V radius = hn::Xor(hn::Sqrt(hn::NegMulAdd(height, height, Const(1.0f))), sign);
  g[0] = hn::Mul(radius, CosPi(turn));
  g[1] = hn::Mul(radius, SinPi(turn));
  g[2] = hn::Xor(height, sign);
}

template <int N>
HWY_INLINE void PerlinGradient(VU hash, V (&g)[N])
{
  const VU edge = hn::ShiftRight<16>(hn::Mul(hn::ShiftRight<16>(hash), hn::Set(DU(), 12u)));
  const auto signOf = [](VU bit) HWY_ATTR { return hn::BitCast(DF(), hn::ShiftLeft<31>(bit)); };
  const V one = Const(1.0f);
  const V zero = Const(0.0f);
  const V first = hn::Xor(one, signOf(edge));
  const V second = hn::Xor(one, signOf(hn::ShiftRight<1>(edge)));
  const VI signedEdge = hn::BitCast(DI(), edge);
  const auto flatZ = hn::RebindMask(DF(), hn::Lt(signedEdge, hn::Set(DI(), 4)));
  const auto flatX = hn::RebindMask(DF(), hn::Gt(signedEdge, hn::Set(DI(), 7)));
  g[0] = hn::IfThenElse(flatX, zero, first);
  g[1] = hn::IfThenElse(flatZ, second, hn::IfThenElse(flatX, first, zero));
  if constexpr (N == 3)
  {
    g[2] = hn::IfThenElse(flatZ, zero, second);
  }
}

/// A ramp that ends sharply downstream; exactly 0 outside (-1, 1).
HWY_INLINE V StreakProfile(V sigma)
{
  const V ramp = hn::MulAdd(sigma, Const(0.5f), Const(0.5f));
  const V end = hn::Min(hn::Mul(hn::Sub(Const(1.0f), sigma), Const(1.0f / 0.15f)), Const(1.0f));
  return hn::Max(hn::Mul(ramp, hn::Max(end, Const(0.0f))), Const(0.0f));
}

// ---- corners ------------------------------------------------------------------------------------

/// Gradients of the lattice rows on both sides of a row of pixels, hashed once and kept while they serve.
template <int N>
class GradientRows
{
public:
  /// Columns [firstColumn, firstColumn + columns).
  GradientRows(const OctaveSetup& octave, std::int64_t firstColumn, std::size_t columns)
    : Octave(octave)
    , FirstColumn(firstColumn)
    , Stride((columns + Lanes - 1) / Lanes * Lanes + Lanes)
    , Gradients(static_cast<std::size_t>(Slots) * N * Stride)
    , Tags(Slots, { INT64_MIN, INT64_MIN })
  {
  }

  /// Makes the rows of the cell (y, z) ready.
  void MoveTo(std::int64_t y, std::int64_t z)
  {
    for (int slot = 0; slot < Slots; ++slot)
    {
      const std::int64_t row = y + slot % 2;
      const std::int64_t slice = N == 3 ? z + slot / 2 : 0;
      const auto home = static_cast<std::size_t>((row & 1) + 2 * (slice & 1));
      float* gradients = this->Gradients.data() + home * N * this->Stride;
      if (this->Tags[home][0] != row || this->Tags[home][1] != slice)
      {
        this->Tags[home] = { row, slice };
        this->HashRow(row, slice, gradients);
      }
      this->Rows[slot] = gradients;
    }
  }

  /// The row at this offset, 0 or 1, from the cell; each of its N components is GetStride() long.
  const float* GetRow(int oy, int oz) const { return this->Rows[oy + 2 * oz]; }

  std::size_t GetStride() const { return this->Stride; }

private:
  void HashRow(std::int64_t row, std::int64_t slice, float* gradients) const
  {
    const auto& period = this->Octave.Period;
    VU rowHash = hn::Set(DU(),
      steerable::HashOneAxis(WrapToPeriod(row, period[1]), 1) ^
        steerable::HashOneAxis(N == 3 ? WrapToPeriod(slice, period[2]) : 0, 2) ^ this->Octave.Seed);
    HWY_ALIGN std::uint32_t column[Lanes];
    for (std::size_t i = 0; i < this->Stride; i += Lanes)
    {
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        column[lane] =
          WrapToPeriod(this->FirstColumn + static_cast<std::int64_t>(i + lane), period[0]);
      }
      V g[N];
      UniformGradient(HashJoinAxes(hn::Xor(HashOneAxis(hn::Load(DU(), column), 0), rowHash)), g);
      for (int axis = 0; axis < N; ++axis)
      {
        hn::StoreU(g[axis], DF(), gradients + axis * this->Stride + i);
      }
    }
  }

  OctaveSetup Octave;
  std::int64_t FirstColumn;
  static constexpr int Slots = 1 << (N - 1);
  std::size_t Stride;
  std::vector<float> Gradients;
  std::vector<std::array<std::int64_t, 2>> Tags;
  std::array<const float*, Slots> Rows;
};

/// Corners of neighbouring pixels: gradients come from rows, permuted to the lanes.
template <int N>
class RowCorners
{
public:
  HWY_INLINE explicit RowCorners(const GradientRows<N>& rows)
    : Stride(rows.GetStride())
    , Lane(hn::Zero(DU()))
  {
    for (int slot = 0; slot < Slots; ++slot)
    {
      this->Rows[slot] = rows.GetRow(slot % 2, slot / 2);
    }
  }

  /// The lanes' cells; those along x are counted from the first column of the rows.
  HWY_INLINE void SetCells(const VU (&cells)[N])
  {
    const std::uint32_t first = hn::GetLane(cells[0]);
    this->First = first;
    this->Lane = hn::Sub(cells[0], hn::Set(DU(), first));
  }
  HWY_INLINE void SelectRow(int oy, int oz) { this->Row = this->Rows[oy + 2 * oz] + this->First; }
  HWY_INLINE void GetGradient(int ox, V (&g)[N]) const
  {
    const auto lane = hn::IndicesFromVec(DF(), this->Lane);
    for (int axis = 0; axis < N; ++axis)
    {
      g[axis] = hn::TableLookupLanes(Load(this->Row + axis * this->Stride + ox), lane);
    }
  }

private:
  static constexpr int Slots = 1 << (N - 1);
  // Copies, which the compiler can keep in registers.
  const float* Rows[Slots];
  std::size_t Stride;
  const float* Row = nullptr;
  std::size_t First = 0;
  VU Lane;
};

/// Cells come wrapped, so few steps bring an index near them back into [0, period).
HWY_NOINLINE VU WrapIndex(VU index, std::int64_t period)
{
  const VI cells = hn::Set(DI(), static_cast<std::int32_t>(period));
  VI i = hn::BitCast(DI(), index);
  for (;;)
  {
    const auto below = hn::Lt(i, hn::Zero(DI()));
    const auto above = hn::Not(hn::Lt(i, cells));
    if (hn::AllFalse(DI(), below) && hn::AllFalse(DI(), above))
    {
      return hn::BitCast(DU(), i);
    }
    i = hn::IfThenElse(below, hn::Add(i, cells), hn::IfThenElse(above, hn::Sub(i, cells), i));
  }
}

/// Corners of the cells of samples anywhere: hashed lane by lane.
template <int N>
class LaneCorners
{
public:
  HWY_INLINE explicit LaneCorners(const OctaveSetup& octave)
    : Octave(octave)
    , Row(hn::Zero(DU()))
  {
  }

  HWY_INLINE void SetCells(const VU (&cells)[N])
  {
    for (int axis = 0; axis < N; ++axis)
    {
      VU next = hn::Add(cells[axis], hn::Set(DU(), 1u));
      if (this->Octave.Period[axis] > 0)
      {
        next = WrapIndex(next, this->Octave.Period[axis]);
      }
      this->Hash[axis][0] = HashOneAxis(cells[axis], axis);
      this->Hash[axis][1] = HashOneAxis(next, axis);
    }
    for (VU& hash : this->Hash[0])
    {
      hash = hn::Xor(hash, hn::Set(DU(), this->Octave.Seed));
    }
  }
  HWY_INLINE void SelectRow(int oy, int oz)
  {
    this->Row = N == 3 ? hn::Xor(this->Hash[1][oy], this->Hash[N - 1][oz]) : this->Hash[1][oy];
  }
  HWY_INLINE void GetGradient(int ox, V (&g)[N]) const
  {
    UniformGradient(HashJoinAxes(hn::Xor(this->Hash[0][ox], this->Row)), g);
  }

private:
  const OctaveSetup& Octave;
  /// Of the corners below and above.
  VU Hash[N][2];
  VU Row;
};

// The walk lives in registers only if it is one function; instrumented builds take too long over that.
#undef WALK_INLINE
#ifdef STEERABLENOISE_INSTRUMENTED
#define WALK_INLINE inline
#else
#define WALK_INLINE HWY_INLINE
#endif

// ---- the sum over corners -----------------------------------------------------------------------

struct Sums
{
  // Written out, since the compiler's own constructor would not be of this SIMD level.
  WALK_INLINE Sums()
    : Noise(hn::Zero(DF()))
    , Weight(hn::Zero(DF()))
    , Variance(hn::Zero(DF()))
  {
  }
  V Noise;
  V Weight;
  V Variance;
};

WALK_INLINE V Normalized(const NoiseSetup& setup, const Sums& sums)
{
  switch (setup.Parameters.Normalize)
  {
    case Normalization::WeightSum:
      return hn::IfThenElseZero(
        hn::Gt(sums.Weight, Const(0.0f)), hn::Div(sums.Noise, hn::Max(sums.Weight, Const(1e-30f))));
    case Normalization::UnitVariance:
      return hn::Div(sums.Noise, hn::Sqrt(hn::Add(sums.Variance, Const(1e-3f))));
    case Normalization::None:
    default:
      return sums.Noise;
  }
}

/// The metric of the lanes, in registers.
template <int N>
struct Frame
{
  V U[N];
  /// u in two parts, see Walk::SetRow (2D).
  V UHigh[2];
  V ULow[2];
  V M[N];
  V Along;
  V Across;
  V Second;
  V Bend[N];
  /// The bend along the normal n = (-u_y, u_x), all there is of it in 2D.
  V BendAcross;
  V Sense;

  WALK_INLINE Frame() {}
  WALK_INLINE Frame(
    const NoiseSetup& setup, const MetricBlock& block, std::size_t i, float cellSize)
    : Along(Load(block.Along + i))
    , Across(Load(block.Across + i))
    , Second(Across)
    , BendAcross(hn::Zero(DF()))
    , Sense(Load(block.Sense + i))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->U[axis] = Load(block.U[axis] + i);
      this->M[axis] = hn::Zero(DF());
      this->Bend[axis] = hn::Zero(DF());
    }
    if constexpr (N == 2)
    {
      for (int axis = 0; axis < 2; ++axis)
      {
        this->UHigh[axis] = HighPart(this->U[axis]);
        this->ULow[axis] = Load(block.ULow[axis] + i);
      }
    }
    if (setup.Biaxial)
    {
      this->Second = Load(block.Second + i);
      for (int axis = 0; axis < N; ++axis)
      {
        this->M[axis] = Load(block.M[axis] + i);
      }
    }
    if (setup.Curved)
    {
      this->ApplyCurvature(block, i, cellSize);
    }
  }

  /// As steerable::ApplyCurvature.
  WALK_INLINE void ApplyCurvature(const MetricBlock& block, std::size_t i, float cellSize)
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::Mul(hn::Mul(Load(block.Bend[axis] + i), Const(cellSize)), this->Sense);
    }
    const V parallel = Dot(this->Bend, this->U);
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::NegMulAdd(parallel, this->U[axis], this->Bend[axis]);
    }
    const V one = Const(1.0f);
    const V length2 = Dot(this->Bend, this->Bend);
    const V clamp = hn::Div(one, hn::Sqrt(hn::Max(length2, one)));
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::Mul(this->Bend[axis], clamp);
    }
    if constexpr (N == 2)
    {
      this->BendAcross = hn::MulSub(this->U[0], this->Bend[1], hn::Mul(this->U[1], this->Bend[0]));
    }
    const V squared = hn::Min(length2, one);
    const V keeps = hn::Sub(one, squared); // CurvatureKeeps
    this->Along = hn::Max(this->Along, squared);
    this->Across = hn::MulAdd(keeps, hn::Sub(this->Across, one), one);
    this->Second = hn::MulAdd(keeps, hn::Sub(this->Second, one), one);
  }
};

/**
 * Quality 0, straight, unnormalised: the 2^N corners of the cell, with the metric as a matrix. `near` is
 * the window of the corner below on each axis; that of the one above is 1 less it.
 */
template <int N, class Corners>
WALK_INLINE V SumOverCell(
  const V (&u)[N], V along, V across, const V (&f)[N], const V (&near)[N], Corners& corners)
{
  // G = b I + (k - b) u uT
  const V c = hn::Sub(along, across);
  V G[N][N];
  for (int i = 0; i < N; ++i)
  {
    const V cu = hn::Mul(c, u[i]);
    for (int j = i; j < N; ++j)
    {
      G[i][j] = i == j ? hn::MulAdd(cu, u[j], across) : hn::Mul(cu, u[j]);
      G[j][i] = G[i][j];
    }
  }
  // G v and q = v G v at the first corner. A step along an axis adds a column of G to the one, and the
  // sum of that component before and after to the other.
  V Gv[N];
  for (int i = 0; i < N; ++i)
  {
    Gv[i] = hn::Neg(Dot(G[i], f));
  }
  V q = hn::Neg(Dot(f, Gv));
  const auto step = [&G](int axis, V(&at)[N], V& distance) HWY_ATTR
  {
    distance = hn::Add(distance, at[axis]);
    for (int i = 0; i < N; ++i)
    {
      at[i] = hn::Add(at[i], G[i][axis]);
    }
    distance = hn::Add(distance, at[axis]);
  };
  // s(1 - t) = 1 - s(t): the sum over two neighbours is far + near (lower - upper).
  const auto addRow = [&](int oy, int oz) HWY_ATTR
  {
    corners.SelectRow(oy, oz);
    V at[N];
    V g[N];
    V distance = q;
    std::copy(Gv, Gv + N, at);
    corners.GetGradient(0, g);
    const V lower = hn::Mul(PlainQuinticFade(distance), Dot(g, at));
    step(0, at, distance);
    corners.GetGradient(1, g);
    const V upper = hn::Mul(PlainQuinticFade(distance), Dot(g, at));
    return hn::MulAdd(near[0], hn::Sub(lower, upper), upper);
  };
  const auto addSlice = [&](int oz) HWY_ATTR
  {
    const V lower = addRow(0, oz);
    step(1, Gv, q);
    const V upper = addRow(1, oz);
    return hn::MulAdd(near[1], hn::Sub(lower, upper), upper);
  };
  if constexpr (N == 2)
  {
    return addSlice(0);
  }
  else
  {
    V next[N];
    V nextQ = q;
    std::copy(Gv, Gv + N, next);
    step(2, next, nextQ);
    const V lower = addSlice(0);
    std::copy(next, next + N, Gv);
    q = nextQ;
    const V upper = addSlice(1);
    return hn::MulAdd(near[2], hn::Sub(lower, upper), upper);
  }
}

#include "SteerableNoiseWalk-inl.h"

/// An eigenvalue at full strength, at these strengths.
HWY_INLINE V AtStrength(double eigenvalue, V strength)
{
  return hn::MulAdd(strength, Const(static_cast<float>(eigenvalue) - 1.0f), Const(1.0f));
}

/// Puts the noise of an octave into the block, or adds it to that of the octaves before.
WALK_INLINE void AddOctave(
  const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block, std::size_t i, V noise)
{
  if (setup.Parameters.Turbulence)
  {
    noise = hn::Abs(noise);
  }
  if (setup.Octaves.size() > 1)
  {
    noise = hn::MulAdd(noise, Const(octave.Amplitude * setup.OctaveScale), Load(block.Noise + i));
  }
  hn::StoreU(noise, DF(), block.Noise + i);
}

/// One octave of a block; `getPlaces(i, places)` tells where the register from sample i is.
template <int N, bool Variant, bool Aligned, class GetPlaces>
WALK_INLINE void AddWalk(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  Walk<N, Variant, Aligned> walk(setup, octave);
  for (std::size_t begin = 0; begin < count; begin += TileSamples)
  {
    const std::size_t end = std::min(count, begin + TileSamples);
    for (std::size_t i = begin; i < end; i += Lanes)
    {
      Places<N> places;
      getPlaces(i, places);
      walk.SetRegister((i - begin) / Lanes, block, i, places);
    }
    visited += walk.Evaluate(end - begin);
    for (std::size_t i = begin; i < end; i += Lanes)
    {
      AddOctave(setup, octave, block, i, walk.GetNoise((i - begin) / Lanes));
    }
  }
}

template <int N, bool Aligned, class GetPlaces>
WALK_INLINE void AddWalks(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  if (setup.Variant)
  {
    AddWalk<N, true, Aligned>(setup, octave, block, count, visited, getPlaces);
  }
  else
  {
    AddWalk<N, false, Aligned>(setup, octave, block, count, visited, getPlaces);
  }
}

/**
 * The same for Quality 0 without extensions; `getPlaces` also gives the windows of the lower corners.
 * `uniform`: the metrics have the same strength.
 */
template <int N, class Corners, class GetPlaces>
WALK_INLINE void AddCells(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, bool uniform, Corners& corners, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  const EigenvalueRange range = VectorEigenvalues(setup.Parameters, N);
  const V strength = Const(static_cast<float>(setup.Parameters.Strength));
  const V along = AtStrength(range.Along, strength);
  const V across = AtStrength(range.Across, strength);
  const bool alone = setup.Octaves.size() == 1 && !setup.Parameters.Turbulence;
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    Places<N> places;
    V near[N];
    getPlaces(i, places, near);
    corners.SetCells(places.Cell);
    V u[N];
    for (int axis = 0; axis < N; ++axis)
    {
      u[axis] = Load(block.U[axis] + i);
    }
    const V k = uniform ? along : Load(block.Along + i);
    const V b = uniform ? across : Load(block.Across + i);
    const V noise = SumOverCell<N>(u, k, b, places.Fraction, near, corners);
    if (alone)
    {
      hn::StoreU(noise, DF(), block.Noise + i);
    }
    else
    {
      AddOctave(setup, octave, block, i, noise);
    }
  }
  visited += count << N;
}

// ---- metrics ------------------------------------------------------------------------------------

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
    for (int axis = 0; axis < N; ++axis)
    {
      const V component = hn::Mul(u[axis], inverse);
      hn::StoreU(component, DF(), unit[axis] + i);
      if (!Bare && N == 2)
      {
        hn::StoreU(hn::MulSub(u[axis], inverse, HighPart(component)), DF(), low[axis] + i);
      }
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
 * Unit vectors of a block projected on the tangent planes of its normals, in double since a steep
 * vector leaves little; a sample without a normal is not on a surface and keeps its vector.
 */
void ProjectOnSurface(
  const float* vectors, const float* normals, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const Vector<3> normal = Eigen::Map<const Eigen::Vector3f>(normals + 3 * i).cast<double>();
    const double length = normal.norm();
    const bool onSurface = length > 0.0 && std::isfinite(length);
    const Vector<3> m = onSurface ? Vector<3>(normal / length) : Vector<3>::Zero();
    Vector<3> u(block.U[0][i], block.U[1][i], block.U[2][i]);
    if (onSurface && block.Length[i] > 1e-15f && block.Length[i] < 1e15f)
    {
      u = Eigen::Map<const Eigen::Vector3f>(vectors + 3 * i).cast<double>() / block.Length[i];
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
      block.U[axis][i] = static_cast<float>(u[axis]);
      block.M[axis][i] = static_cast<float>(m[axis]);
    }
  }
}

/// Eigenvalues of the metrics of the unit vectors in a block, and what stands for missing ones.
template <int N>
HWY_NOINLINE void MetricsOfDirections(
  const NoiseSetup& setup, MetricBlock& block, std::size_t count)
{
  const NoiseParameters& p = setup.Parameters;
  const EigenvalueRange range = VectorEigenvalues(p, N);
  const double surfaceAcross = SurfaceEigenvalues(p).Across;
  const V zero = Const(0.0f);
  const V one = Const(1.0f);
  for (std::size_t i = 0; i < count; i += Lanes)
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
    const V m2 = hn::MulAdd(Load(block.M[0] + i), Load(block.M[0] + i),
      hn::MulAdd(Load(block.M[1] + i), Load(block.M[1] + i),
        hn::Mul(Load(block.M[2] + i), Load(block.M[2] + i))));
    const auto onSurface = hn::Gt(m2, Const(0.5f));
    const V across = AtStrength(range.Across, strength);
    hn::StoreU(hn::IfThenElse(onSurface, AtStrength(surfaceAcross, strength), across), DF(),
      block.Across + i);
    hn::StoreU(hn::IfThenElse(onSurface, AtStrength(SurfaceNormalEigenvalue, strength), across),
      DF(), block.Second + i);
  }
}

/// Adds u_axis ∂u/∂axis to the bend, the neighbours turned to the side of the middle one.
template <int N>
HWY_INLINE void AddDerivative(MetricBlock& block, std::size_t count, int axis,
  const float* const (&before)[3], const float* const (&after)[3], const float* scale, bool perLane)
{
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    V u[N];
    V a[N];
    V c[N];
    for (int k = 0; k < N; ++k)
    {
      u[k] = Load(block.U[k] + i);
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
      const V sum = hn::MulAdd(factor, hn::Sub(fromC, fromA), Load(block.Bend[k] + i));
      hn::StoreU(sum, DF(), block.Bend[k] + i);
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

/// Repeats the last sample behind the end, so that the lanes there are like their neighbours.
void PadTail(MetricBlock& block, std::size_t count)
{
  const auto pad = [count](auto* array) { std::fill_n(array + count, Lanes, array[count - 1]); };
  for (float* array : { block.U[0], block.U[1], block.U[2], block.M[0], block.M[1], block.M[2],
         block.ULow[0], block.ULow[1], block.Bend[0], block.Bend[1], block.Bend[2], block.Along,
         block.Across, block.Second, block.Sense })
  {
    pad(array);
  }
}

/// Tensors go one by one through Eigen's solver.
template <int N>
void MetricsOfTensors(
  const NoiseSetup& setup, const float* tuples, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const Matrix<N> tensor = TensorOf<N>(tuples + 6 * i);
    const AxialMetric<N> metric = MetricFromTensor<N>(setup.Parameters, tensor);
    for (int axis = 0; axis < N; ++axis)
    {
      block.U[axis][i] = static_cast<float>(metric.Direction[axis]);
      block.M[axis][i] = static_cast<float>(metric.SecondAxis[axis]);
      if constexpr (N == 2)
      {
        block.ULow[axis][i] = LowPart(metric.Direction[axis]);
      }
    }
    block.Along[i] = static_cast<float>(metric.Along);
    block.Across[i] = static_cast<float>(metric.Across);
    block.Second[i] = static_cast<float>(metric.Second);
    block.Sense[i] = metric.Degenerate ? 0.0f : 1.0f;
    for (int axis = 0; axis < N && setup.Curved; ++axis)
    {
      block.Bend[axis][i] *= static_cast<float>(metric.Clarity);
    }
    const double norm = tensor.norm();
    block.Length[i] = std::isfinite(norm) ? static_cast<float>(norm) : 0.0f;
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

/// Axes and eigenvalues of a block, once its bend is known. True: all have a direction and the same
/// strength, and none of their eigenvalues are written.
template <int N>
bool Metrics(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t count,
  MetricBlock& block)
{
  if (field.Tensors)
  {
    MetricsOfTensors<N>(setup, field.Tensors->Read(first, count, block.Tuples), count, block);
    PadTail(block, count);
    return false;
  }
  float* const unit[3] = { block.U[0], block.U[1], block.U[2] };
  const float* vectors = field.Vectors->Read(first, count, block.Tuples);
  if (setup.Uniform && UnitVectors<N, true>(vectors, count, unit))
  {
    return true;
  }
  float* const low[2] = { block.ULow[0], block.ULow[1] };
  UnitVectors<N, false>(vectors, count, unit, block.Length, low);
  if (field.Normals)
  {
    const float* normals = field.Normals->Read(first, count, block.Tuples + 3 * BlockRoom);
    ProjectOnSurface(vectors, normals, count, block);
  }
  MetricsOfDirections<N>(setup, block, count);
  PadTail(block, count);
  return false;
}

/// Scales, masks, counts and hands out the noise of a block.
void Finish(const NoiseSetup& setup, MetricBlock& block, std::size_t count, bool uniform,
  float* noise, EvaluationCounts& counts)
{
  if (uniform)
  {
    std::copy(block.Noise, block.Noise + count, noise);
    return;
  }
  const auto threshold = static_cast<float>(setup.Parameters.MaskThreshold);
  V senses = hn::Zero(DF());
  HWY_ALIGN float sense[Lanes];
  if (threshold > 0.0f)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      if (block.Length[i] <= threshold)
      {
        block.Noise[i] = 0.0f;
        ++counts.Stagnant;
        block.Sense[i] = 1.0f; // counted once, as stagnant
      }
    }
  }
  std::size_t i = 0;
  for (; i + Lanes <= count; i += Lanes)
  {
    senses = hn::Add(senses, Load(block.Sense + i));
    hn::StoreU(Load(block.Noise + i), DF(), noise + i);
  }
  hn::Store(senses, DF(), sense);
  float directed = 0.0f;
  for (float lane : sense)
  {
    directed += lane;
  }
  for (; i < count; ++i)
  {
    directed += block.Sense[i];
    noise[i] = block.Noise[i];
  }
  counts.Degenerate += count - static_cast<std::size_t>(directed);
}

/// Cells and fractions of a block of positions: floor and difference in double, the rest in float.
template <int N>
HWY_NOINLINE void LocatePoints(const NoiseSetup& setup, const OctaveSetup& octave,
  const double* positions, std::size_t count, MetricBlock& block)
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN double tail[3 * half] = {};
  const bool oblique = setup.Parameters.Grid == Lattice::Simplicial;
  const VD scale = hn::Set(DD(), octave.CellsPerUnit);
  // Adding this leaves the integer, modulo 2^32, in the low bits.
  const VD toInteger = hn::Set(DD(), 6755399441055744.0);
  const VD rounding = hn::Set(DD(), setup.CellRounding);
  for (std::size_t i = 0; i < count; i += half)
  {
    const double* from = positions + 3 * i;
    if (i + half > count)
    {
      std::copy(from, positions + 3 * count, tail);
      from = tail;
    }
    VD p[3];
    hn::LoadInterleaved3(DD(), from, p[0], p[1], p[2]);
    for (int axis = 0; axis < N; ++axis)
    {
      p[axis] = hn::Mul(p[axis], scale);
    }
    if (oblique)
    {
      const VD q[3] = { p[0], p[1], p[2] };
      for (int axis = 0; axis < N; ++axis)
      {
        p[axis] = hn::Mul(q[0], hn::Set(DD(), setup.LatticeIndices[axis][0]));
        for (int j = 1; j < N; ++j)
        {
          p[axis] = hn::MulAdd(q[j], hn::Set(DD(), setup.LatticeIndices[axis][j]), p[axis]);
        }
      }
    }
    for (int axis = 0; axis < N; ++axis)
    {
      // A place that is not finite is cell 0: it must not spoil its neighbours' walk.
      p[axis] = hn::IfThenElseZero(hn::Lt(hn::Abs(p[axis]), hn::Set(DD(), FarthestCell)), p[axis]);
      VD cell = hn::Floor(hn::Add(p[axis], rounding));
      hn::StoreU(hn::DemoteTo(DFH(), hn::Sub(p[axis], cell)), DFH(), block.Fraction[axis] + i);
      if (octave.Period[axis] > 0)
      {
        const VD period = hn::Set(DD(), static_cast<double>(octave.Period[axis]));
        cell = hn::NegMulAdd(hn::Floor(hn::Div(cell, period)), period, cell);
      }
      const hn::Rebind<std::uint64_t, DD> d64;
      const hn::Rebind<std::uint32_t, DD> d32;
      hn::StoreU(hn::TruncateTo(d32, hn::BitCast(d64, hn::Add(cell, toInteger))), d32,
        block.Cell[axis] + i);
    }
  }
  for (int axis = 0; axis < N; ++axis)
  {
    std::fill_n(block.Cell[axis] + count, Lanes, block.Cell[axis][count - 1]);
    std::fill_n(block.Fraction[axis] + count, Lanes, block.Fraction[axis][count - 1]);
  }
}

/// Adds one octave to samples at these positions.
template <int N>
void AddPoints(const NoiseSetup& setup, const OctaveSetup& octave, const double* positions,
  std::size_t count, bool uniform, MetricBlock& block, std::uint64_t& visited)
{
  LocatePoints<N>(setup, octave, positions, count, block);
  const auto anywhere = [&](std::size_t i, Places<N>& places) HWY_ATTR
  {
    for (int axis = 0; axis < N; ++axis)
    {
      places.Cell[axis] = hn::LoadU(DU(), block.Cell[axis] + i);
      places.Fraction[axis] = Load(block.Fraction[axis] + i);
    }
  };
  if (setup.SingleCell)
  {
    LaneCorners<N> corners(octave);
    AddCells<N>(setup, octave, block, count, uniform, corners, visited,
      [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
      {
        anywhere(i, places);
        for (int axis = 0; axis < N; ++axis)
        {
          near[axis] = PlainQuinticFade(places.Fraction[axis]);
        }
      });
  }
  else
  {
    AddWalks<N, false>(setup, octave, block, count, visited, anywhere);
  }
}

// ---- images -------------------------------------------------------------------------------------

/**
 * Place of sample `index` of a grid axis, in cells of an octave; 0 where a double no longer tells one
 * cell from the next.
 */
inline double CellPlace(const ImageGrid& grid, int axis, std::int64_t index, double cellsPerUnit)
{
  const double place =
    (grid.Origin[axis] + static_cast<double>(grid.FirstIndex[axis] + index) * grid.Spacing[axis]) *
    cellsPerUnit;
  return std::abs(place) < FarthestCell ? place : 0.0;
}

/// One octave of an image: places along x, and the gradient rows if they serve.
template <int N>
struct ImageOctave
{
  std::vector<std::uint32_t> Column; // wrapped cell, or its distance from the first of the rows
  std::vector<float> Fraction;
  std::vector<float> Window; // of the corner below
  std::unique_ptr<GradientRows<N>> Rows;

  ImageOctave(const NoiseSetup& setup, const OctaveSetup& octave, const ImageGrid& grid)
    : Column(grid.Dimensions[0] + Lanes)
    , Fraction(grid.Dimensions[0] + Lanes)
    , Window(grid.Dimensions[0] + Lanes)
  {
    const std::int64_t samples = grid.Dimensions[0];
    std::vector<std::int64_t> cells(samples);
    for (std::int64_t i = 0; i < samples; ++i)
    {
      const double place = CellPlace(grid, 0, i, octave.CellsPerUnit);
      const double cell = std::floor(place + setup.CellRounding);
      cells[i] = static_cast<std::int64_t>(cell);
      this->Fraction[i] = static_cast<float>(place - cell);
    }
    // Lanes pick gradients out of one register, so neighbours must be within one cell.
    const double step = grid.Spacing[0] * octave.CellsPerUnit;
    const bool serve = setup.SingleCell && step >= 0.0 && step <= 1.0;
    const std::int64_t firstColumn = cells.front();
    for (std::int64_t i = 0; i < samples; ++i)
    {
      this->Column[i] = serve ? static_cast<std::uint32_t>(cells[i] - firstColumn)
                              : WrapToPeriod(cells[i], octave.Period[0]);
    }
    for (std::size_t i = samples; i < this->Column.size(); ++i)
    {
      this->Column[i] = this->Column[samples - 1];
      this->Fraction[i] = this->Fraction[samples - 1];
    }
    for (std::size_t i = 0; i + Lanes <= this->Window.size(); i += Lanes)
    {
      hn::StoreU(PlainQuinticFade(Load(this->Fraction.data() + i)), DF(), this->Window.data() + i);
    }
    if (serve)
    {
      const auto columns = static_cast<std::size_t>(cells.back() - firstColumn + 2);
      this->Rows = std::make_unique<GradientRows<N>>(octave, firstColumn, columns);
    }
  }
};

/// A curvature per world unit in cells of the first octave, no larger than floats can square.
inline float InCells(double curvature, const NoiseSetup& setup)
{
  const double inCells = curvature * setup.Parameters.FeatureSize;
  return static_cast<float>(std::min(1e15, std::max(-1e15, inCells)));
}

template <int N>
void ImageCurvature(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  const std::vector<float>& scaleX, std::int64_t i0, std::size_t count, std::int64_t j,
  std::int64_t k, MetricBlock& block)
{
  const std::int64_t nx = grid.Dimensions[0];
  const std::int64_t ny = grid.Dimensions[1];
  const auto flat = [&](std::int64_t i, std::int64_t jj, std::int64_t kk)
  { return static_cast<std::size_t>((kk * ny + jj) * nx + i); };
  // The row itself with `stride` samples to either side; beyond the ends the last one again.
  const std::int64_t stride = grid.CurvatureStride;
  const auto samples = static_cast<std::int64_t>(count);
  const std::int64_t left = std::min(stride, i0);
  const std::int64_t right = std::min(stride, nx - i0 - samples);
  float* own[3];
  float* from[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    own[axis] = block.Neighbor[0][axis] + stride;
    from[axis] = own[axis] - left;
  }
  Directions<N>(setup, field, flat(i0 - left, j, k),
    static_cast<std::size_t>(samples + left + right), block, { from[0], from[1], from[2] });
  for (int axis = 0; axis < N; ++axis)
  {
    std::fill(own[axis] - stride, own[axis] - left, own[axis][-left]);
    std::fill(
      own[axis] + samples + right, own[axis] + samples + stride, own[axis][samples + right - 1]);
    std::copy(own[axis], own[axis] + samples, block.U[axis]);
    std::fill(block.Bend[axis], block.Bend[axis] + count + Lanes, 0.0f);
  }
  if (nx > 1)
  {
    AddDerivative<N>(block, count, 0, { own[0] - stride, own[1] - stride, own[2] - stride },
      { own[0] + stride, own[1] + stride, own[2] + stride }, scaleX.data() + i0, true);
  }
  const std::int64_t place[3] = { i0, j, k };
  for (int axis = 1; axis < N; ++axis)
  {
    const std::int64_t low = std::max<std::int64_t>(place[axis] - stride, 0);
    const std::int64_t high =
      std::min<std::int64_t>(place[axis] + stride, grid.Dimensions[axis] - 1);
    if (low == high)
    {
      continue;
    }
    float* const before[3] = { block.Neighbor[0][0], block.Neighbor[0][1], block.Neighbor[0][2] };
    float* const after[3] = { block.Neighbor[1][0], block.Neighbor[1][1], block.Neighbor[1][2] };
    Directions<N>(
      setup, field, flat(i0, axis == 1 ? low : j, axis == 2 ? low : k), count, block, before);
    Directions<N>(
      setup, field, flat(i0, axis == 1 ? high : j, axis == 2 ? high : k), count, block, after);
    const float scale =
      InCells(1.0 / (static_cast<double>(high - low) * grid.Spacing[axis]), setup);
    AddDerivative<N>(block, count, axis, { before[0], before[1], before[2] },
      { after[0], after[1], after[2] }, &scale, false);
  }
}

template <int N>
EvaluationCounts EvaluateImage(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  EvaluationCounts counts;
  const std::int64_t nx = grid.Dimensions[0];
  if (nx == 0 || rowBegin >= rowEnd)
  {
    return counts;
  }
  auto block = std::make_unique<MetricBlock>();
  std::vector<ImageOctave<N>> octaves;
  for (const OctaveSetup& octave : setup.Octaves)
  {
    octaves.emplace_back(setup, octave, grid);
  }
  // One-sided differences at the ends of a row.
  std::vector<float> scaleX;
  if (setup.Curved)
  {
    scaleX.assign(nx + Lanes, 0.0f);
    const std::int64_t stride = grid.CurvatureStride;
    for (std::int64_t i = 0; i < nx && nx > 1; ++i)
    {
      const std::int64_t span =
        std::min(i + stride, nx - 1) - std::max<std::int64_t>(i - stride, 0);
      scaleX[i] = InCells(1.0 / (static_cast<double>(span) * grid.Spacing[0]), setup);
    }
  }

  for (std::size_t row = rowBegin; row < rowEnd; ++row)
  {
    const auto j = static_cast<std::int64_t>(row) % grid.Dimensions[1];
    const auto k = static_cast<std::int64_t>(row) / grid.Dimensions[1];
    for (std::int64_t i0 = 0; i0 < nx; i0 += BlockSize)
    {
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(BlockSize, nx - i0));
      const std::size_t first = row * nx + i0;
      if (setup.Curved)
      {
        ImageCurvature<N>(setup, grid, field, scaleX, i0, count, j, k, *block);
      }
      const bool uniform = Metrics<N>(setup, field, first, count, *block);
      if (setup.Octaves.size() > 1)
      {
        std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
      }
      for (std::size_t o = 0; o < octaves.size(); ++o)
      {
        const OctaveSetup& octave = setup.Octaves[o];
        ImageOctave<N>& image = octaves[o];
        const double places[3] = { 0.0, CellPlace(grid, 1, j, octave.CellsPerUnit),
          N == 3 ? CellPlace(grid, 2, k, octave.CellsPerUnit) : 0.0 };
        std::int64_t cell[3];
        V fraction[N];
        for (int axis = 1; axis < N; ++axis)
        {
          const double floored = std::floor(places[axis] + setup.CellRounding);
          cell[axis] = static_cast<std::int64_t>(floored);
          fraction[axis] = Const(static_cast<float>(places[axis] - floored));
        }
        cell[2] = N == 3 ? cell[N - 1] : 0;
        const auto alongRow = [&](std::size_t i, Places<N>& places) HWY_ATTR
        {
          places.Cell[0] = hn::LoadU(DU(), image.Column.data() + i0 + i);
          places.Fraction[0] = Load(image.Fraction.data() + i0 + i);
          for (int axis = 1; axis < N; ++axis)
          {
            places.Cell[axis] = hn::Set(DU(), WrapToPeriod(cell[axis], octave.Period[axis]));
            places.Fraction[axis] = fraction[axis];
          }
        };
        V window[N];
        for (int axis = 1; axis < N; ++axis)
        {
          window[axis] = PlainQuinticFade(fraction[axis]);
        }
        const auto withWindow = [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
        {
          alongRow(i, places);
          near[0] = Load(image.Window.data() + i0 + i);
          for (int axis = 1; axis < N; ++axis)
          {
            near[axis] = window[axis];
          }
        };
        if (setup.Parameters.Grid == Lattice::Simplicial)
        {
          for (std::size_t i = 0; i < count; ++i)
          {
            for (int axis = 0; axis < 3; ++axis)
            {
              const std::int64_t index = axis == 0 ? i0 + static_cast<std::int64_t>(i)
                : axis == 1                        ? j
                                                   : k;
              block->Positions[3 * i + axis] = CellPlace(grid, axis, index, 1.0);
            }
          }
          AddPoints<N>(
            setup, octave, block->Positions, count, uniform, *block, counts.VisitedCorners);
        }
        else if (image.Rows)
        {
          image.Rows->MoveTo(cell[1], cell[2]);
          RowCorners<N> corners(*image.Rows);
          AddCells<N>(
            setup, octave, *block, count, uniform, corners, counts.VisitedCorners, withWindow);
        }
        else if (setup.SingleCell)
        {
          LaneCorners<N> corners(octave);
          AddCells<N>(
            setup, octave, *block, count, uniform, corners, counts.VisitedCorners, withWindow);
        }
        else
        {
          AddWalks<N, true>(setup, octave, *block, count, counts.VisitedCorners, alongRow);
        }
      }
      Finish(setup, *block, count, uniform, noise + first, counts);
    }
  }
  return counts;
}

// ---- points -------------------------------------------------------------------------------------

template <int N>
EvaluationCounts EvaluatePoints(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  EvaluationCounts counts;
  auto block = std::make_unique<MetricBlock>();
  for (std::size_t first = begin; first < end; first += BlockSize)
  {
    const std::size_t count = std::min(BlockSize, end - first);
    if (setup.Curved)
    {
      CopyCurvature<N>(setup, field.Curvature->Read(first, count, block->Tuples), count, *block);
    }
    const bool uniform = Metrics<N>(setup, field, first, count, *block);
    if (setup.Octaves.size() > 1)
    {
      std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
    }
    const double* place = positions.Read(first, count, block->Positions);
    for (const OctaveSetup& octave : setup.Octaves)
    {
      AddPoints<N>(setup, octave, place, count, uniform, *block, counts.VisitedCorners);
    }
    Finish(setup, *block, count, uniform, noise + first, counts);
  }
  return counts;
}

EvaluationCounts EvaluateImage2(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<2>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluateImage3(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<3>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluatePoints2(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<2>(setup, positions, field, begin, end, noise);
}

EvaluationCounts EvaluatePoints3(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<3>(setup, positions, field, begin, end, noise);
}
} // namespace HWY_NAMESPACE
} // namespace steerable
