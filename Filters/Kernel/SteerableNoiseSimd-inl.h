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

/// Gradients of the lattice rows around a row of pixels, hashed once and kept while they serve.
template <int N>
class GradientRows
{
public:
  /// Columns [firstColumn, firstColumn + columns); rows within `reach` of the pixels' cell.
  GradientRows(const OctaveSetup& octave, std::int64_t firstColumn, std::size_t columns, int reach)
    : Octave(octave)
    , FirstColumn(firstColumn)
    , Stride((columns + Lanes - 1) / Lanes * Lanes + Lanes)
    , Reach(reach)
    , Side(2 * reach + 2)
    , Slots(N == 3 ? Side * Side : Side)
    , Gradients(static_cast<std::size_t>(Slots) * N * Stride)
    , Tags(Slots, { INT64_MIN, INT64_MIN })
    , Rows(Slots)
  {
  }

  /// Makes the rows around the cell (y, z) ready.
  void MoveTo(std::int64_t y, std::int64_t z)
  {
    const int low = -this->Reach;
    for (int slot = 0; slot < this->Slots; ++slot)
    {
      const std::int64_t row = y + low + slot % this->Side;
      const std::int64_t slice = N == 3 ? z + low + slot / this->Side : 0;
      const int home = Modulo(row) + (N == 3 ? this->Side * Modulo(slice) : 0);
      float* gradients = this->Gradients.data() + static_cast<std::size_t>(home) * N * this->Stride;
      if (this->Tags[home][0] != row || this->Tags[home][1] != slice)
      {
        this->Tags[home] = { row, slice };
        this->HashRow(row, slice, gradients);
      }
      this->Rows[slot] = gradients;
    }
  }

  /// The row at this offset from the cell; each of its N components is GetStride() long.
  const float* GetRow(int oy, int oz) const
  {
    return this->Rows[(oy + this->Reach) + (N == 3 ? this->Side * (oz + this->Reach) : 0)];
  }

  std::size_t GetStride() const { return this->Stride; }

private:
  int Modulo(std::int64_t index) const
  {
    const int rest = static_cast<int>(index % this->Side);
    return rest < 0 ? rest + this->Side : rest;
  }

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
  std::size_t Stride;
  int Reach;
  int Side;
  int Slots;
  std::vector<float> Gradients;
  std::vector<std::array<std::int64_t, 2>> Tags;
  std::vector<const float*> Rows;
};

/// Corners of neighbouring pixels: gradients come from rows, permuted to the lanes.
template <int N>
class RowCorners
{
public:
  HWY_INLINE explicit RowCorners(const GradientRows<N>& rows)
    : Rows(rows)
    , Lane(hn::Zero(DU()))
  {
  }

  /// `columns` of the lanes' cells, counted from the first column of the rows.
  HWY_INLINE void SetCells(const std::uint32_t* columns)
  {
    this->First = columns[0];
    this->Lane = hn::Sub(hn::LoadU(DU(), columns), hn::Set(DU(), this->First));
  }
  HWY_INLINE void SelectRow(int oy, int oz) { this->Row = this->Rows.GetRow(oy, oz) + this->First; }
  HWY_INLINE void GetGradient(int ox, V (&g)[N]) const
  {
    const auto lane = hn::IndicesFromVec(DF(), this->Lane);
    for (int axis = 0; axis < N; ++axis)
    {
      g[axis] = hn::TableLookupLanes(Load(this->Row + axis * this->Rows.GetStride() + ox), lane);
    }
  }

private:
  const GradientRows<N>& Rows;
  const float* Row = nullptr;
  std::size_t First = 0;
  VU Lane;
};

/// Corners of samples anywhere: hashed lane by lane.
template <int N>
class LaneCorners
{
public:
  HWY_INLINE LaneCorners(const OctaveSetup& octave, GradientSet gradients)
    : Octave(octave)
    , Gradients(gradients)
    , Row(hn::Zero(DU()))
  {
  }

  HWY_INLINE void SetCells(const std::uint32_t* x, const std::uint32_t* y, const std::uint32_t* z)
  {
    this->Cell[0] = hn::LoadU(DU(), x);
    this->Cell[1] = hn::LoadU(DU(), y);
    this->Cell[2] = N == 3 ? hn::LoadU(DU(), z) : hn::Zero(DU());
  }
  HWY_INLINE void SelectRow(int oy, int oz)
  {
    VU row = hn::Xor(HashOneAxis(this->GetIndex(1, oy), 1), hn::Set(DU(), this->Octave.Seed));
    if (N == 3)
    {
      row = hn::Xor(row, HashOneAxis(this->GetIndex(2, oz), 2));
    }
    this->Row = row;
  }
  HWY_INLINE VU GetHash(int ox) const
  {
    return HashJoinAxes(hn::Xor(HashOneAxis(this->GetIndex(0, ox), 0), this->Row));
  }
  HWY_INLINE void GetGradient(int ox, V (&g)[N]) const { UniformGradient(this->GetHash(ox), g); }
  HWY_INLINE void GetGradient(VU hash, V (&g)[N]) const
  {
    if (this->Gradients == GradientSet::Perlin)
    {
      PerlinGradient<N>(hash, g);
    }
    else
    {
      UniformGradient(hash, g);
    }
  }

private:
  HWY_INLINE VU GetIndex(int axis, int offset) const
  {
    VU index = hn::Add(this->Cell[axis], hn::Set(DU(), static_cast<std::uint32_t>(offset)));
    return this->Octave.Period[axis] > 0 ? this->Wrap(index, this->Octave.Period[axis]) : index;
  }

  /// Cells come wrapped, so few steps bring an index near them back into [0, period).
  static HWY_NOINLINE VU Wrap(VU index, std::int64_t period)
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

  const OctaveSetup& Octave;
  GradientSet Gradients;
  VU Cell[3];
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
 * Quality 0, straight, unnormalised: the 2^N corners of the cell, with the metric as a matrix.
 */
template <int N, class Corners>
WALK_INLINE V SumOverCell(const Frame<N>& frame, const V (&f)[N], Corners& corners)
{
  // G = b I + (k - b) u uT
  const V c = hn::Sub(frame.Along, frame.Across);
  V G[N][N];
  for (int i = 0; i < N; ++i)
  {
    const V cu = hn::Mul(c, frame.U[i]);
    for (int j = i; j < N; ++j)
    {
      G[i][j] = i == j ? hn::MulAdd(cu, frame.U[j], frame.Across) : hn::Mul(cu, frame.U[j]);
      G[j][i] = G[i][j];
    }
  }
  // Both offsets and both window factors of every axis.
  const V one = Const(1.0f);
  V v[N][2];
  V window[N][2];
  for (int axis = 0; axis < N; ++axis)
  {
    v[axis][0] = hn::Neg(f[axis]);
    v[axis][1] = hn::Sub(one, f[axis]);
    window[axis][0] = PlainQuinticFade(f[axis]);
    window[axis][1] = hn::Sub(one, window[axis][0]); // s(1 - t) = 1 - s(t)
  }

  V noise = hn::Zero(DF());
  for (int oz = 0; oz < (N == 3 ? 2 : 1); ++oz)
  {
    for (int oy = 0; oy < 2; ++oy)
    {
      corners.SelectRow(oy, oz);
      // What does not change along the row.
      V Gv0[N];
      for (int i = 0; i < N; ++i)
      {
        Gv0[i] = hn::Mul(G[i][1], v[1][oy]);
        if constexpr (N == 3)
        {
          Gv0[i] = hn::MulAdd(G[i][2], v[2][oz], Gv0[i]);
        }
      }
      V row = hn::Zero(DF());
      for (int ox = 0; ox < 2; ++ox)
      {
        V Gv[N];
        for (int i = 0; i < N; ++i)
        {
          Gv[i] = hn::MulAdd(G[i][0], v[0][ox], Gv0[i]);
        }
        V q = hn::MulAdd(v[0][ox], Gv[0], hn::Mul(v[1][oy], Gv[1]));
        if constexpr (N == 3)
        {
          q = hn::MulAdd(v[2][oz], Gv[2], q);
        }
        V g[N];
        corners.GetGradient(ox, g);
        row = hn::MulAdd(hn::Mul(window[0][ox], PlainQuinticFade(q)), Dot(g, Gv), row);
      }
      const V rowWindow = N == 3 ? hn::Mul(window[1][oy], window[N - 1][oz]) : window[1][oy];
      noise = hn::MulAdd(row, rowWindow, noise);
    }
  }
  return noise;
}

/**
 * Any Quality and any variant: walks the lattice rows that meet the surflets' reach and, on each, the
 * interval of corners that can lie inside.
 */
template <int N, bool Variant, class Corners>
class Walk
{
public:
  WALK_INLINE Walk(
    const NoiseSetup& setup, const Frame<N>& frame, const V (&f)[N], Corners& corners)
    : Setup(setup)
    , Params(setup.Parameters)
    , F(frame)
    , Corner(corners)
    , Straight(!setup.Curved &&
        !(Variant && (Params.Motion || Params.Surflet == Basis::Streaks || setup.JitterRadius > 0)))
    , InverseReach(Const(1.0f / (Params.Quality + 1)))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Fraction[axis] = f[axis];
      this->Step[axis] = Const(
        Variant ? static_cast<float>(setup.LatticeSteps[axis][0]) : (axis == 0 ? 1.0f : 0.0f));
    }
    this->RootAlong = hn::Sqrt(frame.Along);
    if constexpr (N == 2)
    {
      const V product = hn::Mul(frame.U[1], f[0]);
      this->CrossFraction =
        hn::Sub(hn::MulSub(frame.U[0], f[1], product), hn::MulSub(frame.U[1], f[0], product));
    }
    this->SetReach();
  }

  WALK_INLINE V Evaluate(std::uint64_t& visited)
  {
    int zLow = 0;
    int zHigh = 0;
    if constexpr (N == 3)
    {
      this->GetRange(2, zLow, zHigh);
    }
    int yLow = 0;
    int yHigh = 0;
    this->GetRange(1, yLow, yHigh);
    this->GetExtent(0, this->BoxLow, this->BoxHigh);
    if (this->Straight)
    {
      this->SetQuadratic();
    }
    for (int oz = zLow; oz <= zHigh; ++oz)
    {
      for (int oy = yLow; oy <= yHigh; ++oy)
      {
        this->VisitRow(oy, oz, visited);
      }
    }
    return Normalized(this->Setup, this->Total);
  }

private:
  /// Half-length along the flow and half-width across it, travel included.
  WALK_INLINE void SetReach()
  {
    const float support = this->Setup.Support;
    float along = std::sqrt(support);
    float across = along;
    if constexpr (Variant)
    {
      if (this->Params.Surflet == Basis::Streaks)
      {
        along = 1.0f;
        across = support;
      }
      if (this->Params.Motion)
      {
        along += 0.5f * std::abs(static_cast<float>(this->Params.Speed));
      }
    }
    // A little more than needed: every lane must visit all its own corners, whatever rounding does.
    const V slack = Const(1e-3f);
    V across2 = this->F.Across;
    if (this->Setup.Biaxial)
    {
      across2 = hn::Min(across2, this->F.Second);
    }
    this->HalfLength = hn::Add(hn::Div(Const(along), this->RootAlong), slack);
    this->HalfWidth = hn::Add(hn::Div(Const(across), hn::Sqrt(across2)), slack);
    if constexpr (Variant)
    {
      // The corner that jitter moves into reach stands up to its radius away, and as much more as the
      // sag of the bend changes over that radius.
      const V radius = Const(this->Setup.JitterRadius);
      this->HalfLength = hn::Add(this->HalfLength, radius);
      const V bend = hn::Sqrt(Dot(this->F.Bend, this->F.Bend));
      this->HalfWidth =
        hn::Add(this->HalfWidth, hn::MulAdd(hn::Mul(radius, bend), this->HalfLength, radius));
    }
  }

  /// Bounds of the reach along one index axis of the lattice, as offsets from the sample's cell.
  WALK_INLINE void GetExtent(int axis, V& low, V& high) const
  {
    // w: how the index grows with the place.
    V w[N];
    float w2 = 1.0f;
    V along = this->F.U[axis];
    V bend = this->F.Bend[axis];
    if constexpr (Variant)
    {
      w2 = 0.0f;
      for (int i = 0; i < N; ++i)
      {
        const auto component = static_cast<float>(this->Setup.LatticeIndices[axis][i]);
        w[i] = Const(component);
        w2 += component * component;
      }
      along = Dot(w, this->F.U);
      bend = Dot(w, this->F.Bend);
    }
    const V across = hn::Sqrt(hn::Max(hn::NegMulAdd(along, along, Const(w2)), Const(0.0f)));
    const V zero = Const(0.0f);
    V half;
    if (this->Straight)
    {
      // The ellipsoid's own extent, the root of wT G^-1 w.
      const V a = hn::Mul(along, this->HalfLength);
      const V c = hn::Mul(across, this->HalfWidth);
      half = hn::Sqrt(hn::MulAdd(a, a, hn::Mul(c, c)));
      low = hn::Neg(half);
      high = half;
    }
    else
    {
      half = hn::MulAdd(hn::Abs(along), this->HalfLength, hn::Mul(across, this->HalfWidth));
      const V sag =
        hn::Mul(hn::Mul(Const(0.5f), hn::Mul(this->HalfLength, this->HalfLength)), bend);
      low = hn::Sub(hn::Min(sag, zero), half);
      high = hn::Add(hn::Max(sag, zero), half);
    }
    if (!this->Params.AnisotropicWeight)
    {
      high = Const(1e9f);
      low = hn::Neg(high);
    }
    // The window is a box of places; oblique indices need √3 times as many to cover it.
    const float reach =
      this->Setup.WindowReach * (this->Params.Grid == Lattice::Simplicial ? 1.75f : 1.0f);
    low = hn::Max(low, Const(-reach - this->Setup.JitterUp));
    high = hn::Min(high, Const(reach + this->Setup.JitterDown));
    low = hn::Add(this->Fraction[axis], low);
    high = hn::Add(this->Fraction[axis], high);
  }

  /// The same as whole numbers, for all lanes together.
  WALK_INLINE void GetRange(int axis, int& low, int& high) const
  {
    V lowest;
    V highest;
    this->GetExtent(axis, lowest, highest);
    low = ToCorner(std::ceil(LeastLane(lowest)));
    high = ToCorner(std::floor(GreatestLane(highest)));
  }

  /// Coefficients of q along a row that are the same for all rows.
  WALK_INLINE void SetQuadratic()
  {
    const V c = hn::Sub(this->F.Along, this->F.Across);
    const V cu = hn::Mul(c, Dot(this->Step, this->F.U));
    for (int i = 0; i < N; ++i)
    {
      this->GStep[i] = hn::MulAdd(cu, this->F.U[i], hn::Mul(this->F.Across, this->Step[i]));
    }
    if (this->Setup.Biaxial)
    {
      const V em = hn::Mul(hn::Sub(this->F.Second, this->F.Across), Dot(this->Step, this->F.M));
      for (int i = 0; i < N; ++i)
      {
        this->GStep[i] = hn::MulAdd(em, this->F.M[i], this->GStep[i]);
      }
    }
    this->QuadraticA = Dot(this->Step, this->GStep);
    this->InverseA = hn::Div(Const(1.0f), this->QuadraticA);
  }

  /// Offset of the corner with ox = 0 of a row.
  WALK_INLINE void SetRow(int oy, int oz)
  {
    if constexpr (Variant)
    {
      const V o[3] = { hn::Neg(this->Fraction[0]),
        hn::Sub(Const(static_cast<float>(oy)), this->Fraction[1]),
        N == 3 ? hn::Sub(Const(static_cast<float>(oz)), this->Fraction[N - 1]) : hn::Zero(DF()) };
      for (int i = 0; i < N; ++i)
      {
        this->RowV[i] = hn::Zero(DF());
        for (int j = 0; j < N; ++j)
        {
          this->RowV[i] = hn::MulAdd(
            Const(static_cast<float>(this->Setup.LatticeSteps[i][j])), o[j], this->RowV[i]);
        }
      }
    }
    else
    {
      this->RowV[0] = hn::Neg(this->Fraction[0]);
      const V row = Const(static_cast<float>(oy));
      this->RowV[1] = hn::Sub(row, this->Fraction[1]);
      if constexpr (N == 2)
      {
        // u x v for a far corner is a small difference of large products. The high parts of u have
        // 16 bits, so their products with corners and the difference are exact.
        this->CrossRow = hn::Mul(this->F.UHigh[0], row);
        this->CrossRest = hn::MulSub(this->F.ULow[0], row, this->CrossFraction);
      }
      if constexpr (N == 3)
      {
        this->RowV[2] = hn::Sub(Const(static_cast<float>(oz)), this->Fraction[2]);
      }
    }
  }

  /// Interval of q < Support: the roots of a quadratic.
  WALK_INLINE void CutByEllipsoid(V& low, V& high) const
  {
    const V s = Dot(this->RowV, this->F.U);
    V q = hn::Mul(this->F.Across, Dot(this->RowV, this->RowV));
    q = hn::MulAdd(hn::Mul(hn::Sub(this->F.Along, this->F.Across), s), s, q);
    if (this->Setup.Biaxial)
    {
      const V r = Dot(this->RowV, this->F.M);
      q = hn::MulAdd(hn::Mul(hn::Sub(this->F.Second, this->F.Across), r), r, q);
    }
    const V B = Dot(this->RowV, this->GStep);
    const V C = hn::Sub(q, Const(this->Setup.Support + 1e-3f));
    const V discriminant = hn::NegMulAdd(this->QuadraticA, C, hn::Mul(B, B));
    const V root = hn::Sqrt(hn::Max(discriminant, Const(0.0f)));
    const auto outside = hn::Lt(discriminant, Const(0.0f));
    low = hn::Max(low, hn::Mul(hn::Neg(hn::Add(B, root)), this->InverseA));
    high = hn::Min(high, hn::Mul(hn::Sub(root, B), this->InverseA));
    high = hn::IfThenElse(outside, Const(-1e9f), high);
  }

  /**
   * Interval of a bent surflet: a slab along the flow, then a tube around the parabola, whose sag is
   * known within a band once the slab has bounded the distance along the flow.
   */
  WALK_INLINE void CutByTube(V& low, V& high) const
  {
    const V one = Const(1.0f);
    const V s0 = Dot(this->RowV, this->F.U);
    const V se = Dot(this->Step, this->F.U);
    const V safe = hn::CopySign(hn::Max(hn::Abs(se), Const(1e-6f)), se);
    const V inverse = hn::Div(one, safe);
    const V middle = hn::Neg(hn::Mul(s0, inverse));
    const V half = hn::Abs(hn::Mul(this->HalfLength, inverse));
    low = hn::Max(low, hn::Sub(middle, half));
    high = hn::Min(high, hn::Add(middle, half));

    const V first = hn::MulAdd(low, se, s0);
    const V last = hn::MulAdd(high, se, s0);
    const V first2 = hn::Mul(first, first);
    const V last2 = hn::Mul(last, last);
    const V most = hn::Max(first2, last2);
    const V least = hn::IfThenElse(
      hn::Lt(hn::Mul(first, last), Const(0.0f)), Const(0.0f), hn::Min(first2, last2));
    const V quarter = Const(0.25f);
    const V sag = hn::Mul(quarter, hn::Add(most, least));
    const V bend2 = Dot(this->F.Bend, this->F.Bend);
    const V width =
      hn::MulAdd(hn::Mul(quarter, hn::Sub(most, least)), hn::Sqrt(bend2), this->HalfWidth);

    // |t0 + x te| < width with t the part across the flow, t0 shifted by the sag.
    V t0[N];
    V te[N];
    for (int i = 0; i < N; ++i)
    {
      t0[i] = hn::NegMulAdd(sag, this->F.Bend[i], hn::NegMulAdd(s0, this->F.U[i], this->RowV[i]));
      te[i] = hn::NegMulAdd(se, this->F.U[i], this->Step[i]);
    }
    const V A = hn::Max(Dot(te, te), Const(1e-6f));
    const V B = Dot(t0, te);
    const V C = hn::NegMulAdd(width, width, Dot(t0, t0));
    const V discriminant = hn::NegMulAdd(A, C, hn::Mul(B, B));
    const V inverseA = hn::Div(one, A);
    const V root = hn::Mul(hn::Sqrt(hn::Max(discriminant, Const(0.0f))), inverseA);
    const V center = hn::Neg(hn::Mul(B, inverseA));
    const V slack = Const(1e-3f);
    low = hn::Max(low, hn::Sub(hn::Sub(center, root), slack));
    high = hn::Min(high, hn::Add(hn::Add(center, root), slack));
    high = hn::IfThenElse(hn::Lt(discriminant, Const(0.0f)), Const(-1e9f), high);
  }

  WALK_INLINE void VisitRow(int oy, int oz, std::uint64_t& visited)
  {
    this->SetRow(oy, oz);
    V low = this->BoxLow;
    V high = this->BoxHigh;
    if (this->Params.AnisotropicWeight)
    {
      if (this->Straight)
      {
        this->CutByEllipsoid(low, high);
      }
      else
      {
        this->CutByTube(low, high);
      }
    }
    // Lanes with nothing on this row must not widen the others' interval.
    const auto empty = hn::Gt(low, high);
    if (hn::AllTrue(DF(), empty))
    {
      return;
    }
    const int first = ToCorner(std::ceil(LeastLane(hn::IfThenElse(empty, Const(1e9f), low))));
    const int last = ToCorner(std::floor(GreatestLane(hn::IfThenElse(empty, Const(-1e9f), high))));
    if (first > last)
    {
      return;
    }
    visited += last - first + 1;
    this->Corner.SelectRow(oy, oz);
    if constexpr (!Variant)
    {
      this->RowWindow = Const(1.0f);
      if (this->Params.LatticeWindow)
      {
        for (int axis = 1; axis < N; ++axis)
        {
          const V factor = QuinticFade(hn::Mul(hn::Abs(this->RowV[axis]), this->InverseReach));
          this->RowWindow = axis == 1 ? factor : hn::Mul(this->RowWindow, factor);
        }
      }
    }
    for (int ox = first; ox <= last; ++ox)
    {
      this->AddSurflet(ox);
    }
  }

  WALK_INLINE V GetWindow(const V (&v)[N]) const
  {
    if (!this->Params.LatticeWindow)
    {
      return Const(1.0f);
    }
    if constexpr (!Variant)
    {
      return hn::Mul(this->RowWindow, QuinticFade(hn::Mul(hn::Abs(v[0]), this->InverseReach)));
    }
    else
    {
      const Fade fade = this->Params.Interpolant;
      if (this->Params.Window == Falloff::Radial)
      {
        return FadeOf(fade, hn::Mul(hn::Sqrt(Dot(v, v)), this->InverseReach));
      }
      V product = FadeOf(fade, hn::Mul(v[0], this->InverseReach));
      for (int axis = 1; axis < N; ++axis)
      {
        product = hn::Mul(product, FadeOf(fade, hn::Mul(v[axis], this->InverseReach)));
      }
      return product;
    }
  }

  WALK_INLINE void AddSurflet(int ox)
  {
    const V offset = Const(static_cast<float>(ox));
    V v[N];
    for (int i = 0; i < N; ++i)
    {
      v[i] = Variant ? hn::MulAdd(offset, this->Step[i], this->RowV[i])
        : i == 0     ? hn::Add(offset, this->RowV[0])
                     : this->RowV[i];
    }
    VU hash = hn::Zero(DU());
    if constexpr (Variant)
    {
      hash = this->Corner.GetHash(ox);
      if (this->Setup.JitterRadius > 0.0f)
      {
        for (int i = 0; i < N; ++i)
        {
          v[i] = hn::Add(
            v[i], hn::Sub(HashToUnit(HashStream(hash, 3 + i)), Const(this->Setup.JitterDown)));
        }
      }
    }

    // Along the flow and across it: s, and t as a vector (in 2D as a number along the normal n).
    V s = Dot(v, this->F.U);
    V t[N];
    if constexpr (N == 2)
    {
      t[0] = Variant ? hn::MulSub(this->F.U[0], v[1], hn::Mul(this->F.U[1], v[0]))
                     : hn::Add(hn::NegMulAdd(this->F.UHigh[1], offset, this->CrossRow),
                         hn::NegMulAdd(this->F.ULow[1], offset, this->CrossRest));
    }
    else
    {
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(s, this->F.U[i], v[i]);
      }
      // u has not quite length 1 and s is rounded: what t still has of u is large beside it.
      const V rest = Dot(t, this->F.U);
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(rest, this->F.U[i], t[i]);
      }
      s = hn::Add(s, rest);
    }
    if (this->Setup.Curved)
    {
      const V sag = hn::Mul(hn::Mul(Const(0.5f), s), s);
      if constexpr (N == 2)
      {
        t[0] = hn::NegMulAdd(sag, this->F.BendAcross, t[0]);
      }
      else
      {
        for (int i = 0; i < N; ++i)
        {
          t[i] = hn::NegMulAdd(sag, this->F.Bend[i], t[i]);
        }
      }
    }
    V amplitude = Const(1.0f);
    if constexpr (Variant)
    {
      if (this->Params.Motion)
      {
        const V clock = hn::Add(HashToUnit(HashStream(hash, 1)),
          Const(static_cast<float>(this->Params.Phase - std::floor(this->Params.Phase))));
        const V tau = hn::Sub(clock, hn::Floor(clock));
        const V centered = hn::Sub(tau, Const(0.5f));
        s = hn::MulAdd(
          hn::Mul(centered, hn::Mul(this->F.Sense, Const(static_cast<float>(this->Params.Speed)))),
          hn::Div(Const(1.0f), this->RootAlong), s);
        const V wave = CosPi(centered); // sin(π τ)
        amplitude = hn::Mul(hn::Mul(wave, wave), Const(1.6329931619f));
      }
    }

    const V ks = hn::Mul(this->F.Along, s);
    const V t2 = N == 2 ? hn::Mul(t[0], t[0]) : Dot(t, t);
    V across2 = hn::Mul(this->F.Across, t2);
    V r = hn::Zero(DF());
    if (N == 3 && this->Setup.Biaxial)
    {
      r = Dot(t, this->F.M);
      across2 = hn::MulAdd(hn::Mul(hn::Sub(this->F.Second, this->F.Across), r), r, across2);
    }
    const V q = hn::MulAdd(ks, s, across2);
    V weight = this->GetWindow(v);

    if constexpr (Variant)
    {
      if (this->Params.Surflet == Basis::Streaks)
      {
        this->AddStreak(hash, amplitude, weight, s, across2);
        return;
      }
      if (this->Params.AnisotropicWeight)
      {
        weight = hn::Mul(weight, FadeOf(this->Params.Interpolant, q));
      }
      if (this->Params.Surflet == Basis::Value)
      {
        const V value = hn::Mul(HashToSigned(hash), Const(2.0f));
        const V weight2 = hn::Mul(weight, weight);
        this->Total.Noise = hn::MulAdd(hn::Mul(amplitude, weight), value, this->Total.Noise);
        this->Total.Variance = hn::MulAdd(weight2, Const(1.0f / 3.0f), this->Total.Variance);
        this->Total.Weight = hn::Add(this->Total.Weight, weight);
        return;
      }
    }
    else
    {
      weight = hn::Mul(weight, QuinticFade(q));
    }

    // G v' in the axes of the metric, then the gradient.
    V Gv[N];
    if constexpr (N == 2)
    {
      const V bt = hn::Mul(this->F.Across, t[0]);
      Gv[0] = hn::MulSub(ks, this->F.U[0], hn::Mul(bt, this->F.U[1]));
      Gv[1] = hn::MulAdd(ks, this->F.U[1], hn::Mul(bt, this->F.U[0]));
    }
    else
    {
      for (int i = 0; i < N; ++i)
      {
        Gv[i] = hn::MulAdd(ks, this->F.U[i], hn::Mul(this->F.Across, t[i]));
      }
      if (this->Setup.Biaxial)
      {
        const V er = hn::Mul(hn::Sub(this->F.Second, this->F.Across), r);
        for (int i = 0; i < N; ++i)
        {
          Gv[i] = hn::MulAdd(er, this->F.M[i], Gv[i]);
        }
      }
    }
    V g[N];
    if constexpr (Variant)
    {
      this->Corner.GetGradient(hash, g);
      this->Total.Noise = hn::MulAdd(hn::Mul(amplitude, weight), Dot(g, Gv), this->Total.Noise);
    }
    else
    {
      this->Corner.GetGradient(ox, g);
      this->Total.Noise = hn::MulAdd(weight, Dot(g, Gv), this->Total.Noise);
    }
    if (this->Params.Normalize == Normalization::UnitVariance)
    {
      const auto variance = static_cast<float>(GradientVariance(this->Params.Gradients, N));
      this->Total.Variance = hn::MulAdd(
        hn::Mul(hn::Mul(weight, weight), Const(variance)), Dot(Gv, Gv), this->Total.Variance);
    }
    else
    {
      this->Total.Weight = hn::Add(this->Total.Weight, weight);
    }
  }

  WALK_INLINE void AddStreak(VU hash, V amplitude, V window, V s, V across2)
  {
    const V sigma = hn::Neg(hn::Mul(s, this->RootAlong));
    const V across = hn::Sqrt(hn::Max(across2, Const(0.0f)));
    const V profile = hn::Mul(hn::Mul(window, this->F.Sense),
      hn::Mul(StreakProfile(sigma), FadeOf(this->Params.Interpolant, across)));
    const auto density = static_cast<float>(this->Params.Density);
    const auto on = hn::Lt(HashToUnit(HashStream(hash, 2)), Const(density));
    this->Total.Noise =
      hn::Add(this->Total.Noise, hn::IfThenElseZero(on, hn::Mul(amplitude, profile)));
    this->Total.Variance =
      hn::MulAdd(hn::Mul(Const(density), profile), profile, this->Total.Variance);
    this->Total.Weight = hn::Add(this->Total.Weight, profile);
  }

  const NoiseSetup& Setup;
  const NoiseParameters& Params;
  const Frame<N>& F;
  Corners& Corner;
  bool Straight;
  V InverseReach;
  V RootAlong;
  V HalfLength;
  V HalfWidth;
  V Fraction[N];
  V Step[N];
  V BoxLow;
  V BoxHigh;
  V GStep[N];
  V QuadraticA;
  V InverseA;
  V RowV[N];
  V RowWindow;
  V CrossFraction;
  V CrossRow;
  V CrossRest;
  Sums Total;
};

template <int N, bool Variant, class Corners>
WALK_INLINE V SumSurflets(const NoiseSetup& setup, const Frame<N>& frame, const V (&f)[N],
  Corners& corners, std::uint64_t& visited)
{
  if constexpr (!Variant)
  {
    if (setup.SingleCell)
    {
      visited += 1 << N;
      return SumOverCell<N>(frame, f, corners);
    }
  }
  return Walk<N, Variant, Corners>(setup, frame, f, corners).Evaluate(visited);
}

/// Adds one octave to the samples of a block whose cells and fractions are set.
template <int N, bool Variant, class Corners, class SetCells>
WALK_INLINE void AddOctave(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, Corners& corners, std::uint64_t& visited, SetCells&& setCells)
{
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    V f[N];
    setCells(i, f);
    const Frame<N> frame(setup, block, i, octave.CellSize);
    std::uint64_t corner = 0;
    V noise = SumSurflets<N, Variant>(setup, frame, f, corners, corner);
    visited += corner * std::min(Lanes, count - i);
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
}

// ---- metrics ------------------------------------------------------------------------------------

/**
 * Unit vectors of `count` tuples of 3 floats, 0 where there is none, and their lengths. In 2D the
 * third component is not looked at. `low`: also what stays behind the high parts.
 */
template <int N>
HWY_NOINLINE void UnitVectors(const float* tuples, std::size_t count, float* const (&unit)[3],
  float* length, float* const* low = nullptr)
{
  HWY_ALIGN float tail[3 * Lanes] = {};
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    const float* from = tuples + 3 * i;
    if (i + Lanes > count)
    {
      std::copy(from, tuples + 3 * count, tail);
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
    const V inverse = hn::IfThenElseZero(good, hn::Div(Const(1.0f), norm));
    for (int axis = 0; axis < N; ++axis)
    {
      const V component = hn::IfThenElseZero(good, hn::Mul(u[axis], inverse));
      hn::StoreU(component, DF(), unit[axis] + i);
      if (low)
      {
        const V rest = hn::MulSub(u[axis], inverse, HighPart(component));
        hn::StoreU(hn::IfThenElseZero(good, rest), DF(), low[axis] + i);
      }
    }
    hn::StoreU(norm, DF(), length + i);
    if (!hn::AllTrue(DF(), good))
    {
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
        if (any && !(norm2 > 1e-30 && norm2 < 1e30))
        {
          vector.normalize(); // in double
          for (int axis = 0; axis < N; ++axis)
          {
            unit[axis][i + lane] = static_cast<float>(vector[axis]);
            if (low)
            {
              low[axis][i + lane] = LowPart(vector[axis]);
            }
          }
        }
        length[i + lane] = any ? static_cast<float>(std::sqrt(norm2)) : 0.0f;
      }
    }
  }
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
  const V zero = Const(0.0f);
  const V one = Const(1.0f);
  const V along = Const(static_cast<float>(range.Along) - 1.0f);
  const V across = Const(static_cast<float>(range.Across) - 1.0f);
  const V surfaceAcross = Const(static_cast<float>(SurfaceEigenvalues(p).Across) - 1.0f);
  const V normal = Const(static_cast<float>(SurfaceNormalEigenvalue) - 1.0f);
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
    hn::StoreU(hn::MulAdd(strength, along, one), DF(), block.Along + i);
    hn::StoreU(hn::IfThenElseZero(there, one), DF(), block.Sense + i);
    if (!setup.Biaxial)
    {
      hn::StoreU(hn::MulAdd(strength, across, one), DF(), block.Across + i);
      continue;
    }
    const V m2 = hn::MulAdd(Load(block.M[0] + i), Load(block.M[0] + i),
      hn::MulAdd(Load(block.M[1] + i), Load(block.M[1] + i),
        hn::Mul(Load(block.M[2] + i), Load(block.M[2] + i))));
    const auto onSurface = hn::Gt(m2, Const(0.5f));
    hn::StoreU(hn::MulAdd(strength, hn::IfThenElse(onSurface, surfaceAcross, across), one), DF(),
      block.Across + i);
    hn::StoreU(
      hn::MulAdd(strength, hn::IfThenElse(onSurface, normal, across), one), DF(), block.Second + i);
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

template <int N>
void ClearTail(MetricBlock& block, std::size_t count)
{
  // Lanes behind the last sample are computed too: give them something harmless.
  if (count % Lanes == 0)
  {
    return;
  }
  for (std::size_t i = count; i < count + Lanes; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      block.U[axis][i] = block.M[axis][i] = block.Bend[axis][i] = 0.0f;
      block.ULow[axis % 2][i] = 0.0f;
      block.Fraction[axis][i] = count > 0 ? block.Fraction[axis][count - 1] : 0.0f;
      block.Cell[axis][i] = count > 0 ? block.Cell[axis][count - 1] : 0;
    }
    block.Length[i] = 0.0f;
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
  for (std::size_t i = count; i < count + Lanes; ++i)
  {
    block.Along[i] = block.Across[i] = block.Second[i] = 1.0f;
    block.Sense[i] = 0.0f;
    block.U[0][i] = block.M[1][i] = 1.0f;
  }
}

/// Unit vectors along the flow for samples [first, first + count): 0 where there is none.
template <int N>
void Directions(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t count,
  MetricBlock& block, float* const (&unit)[3])
{
  if (field.Vectors)
  {
    UnitVectors<N>(field.Vectors->Read(first, count, block.Tuples), count, unit, block.Length);
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

/// Axes and eigenvalues of a block, once its bend is known.
template <int N>
void Metrics(const NoiseSetup& setup, const Field& field, std::size_t first, std::size_t count,
  MetricBlock& block)
{
  if (field.Tensors)
  {
    MetricsOfTensors<N>(setup, field.Tensors->Read(first, count, block.Tuples), count, block);
    return;
  }
  float* const low[2] = { block.ULow[0], block.ULow[1] };
  const float* vectors = field.Vectors->Read(first, count, block.Tuples);
  UnitVectors<N>(
    vectors, count, { block.U[0], block.U[1], block.U[2] }, block.Length, N == 2 ? low : nullptr);
  if (field.Normals)
  {
    const float* normals = field.Normals->Read(first, count, block.Tuples + 3 * BlockRoom);
    ProjectOnSurface(vectors, normals, count, block);
  }
  MetricsOfDirections<N>(setup, block, count);
}

/// Scales, masks, counts and hands out the noise of a block.
void Finish(const NoiseSetup& setup, MetricBlock& block, std::size_t count, float* noise,
  EvaluationCounts& counts)
{
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
  HWY_ALIGN double tail[3 * Lanes] = {};
  constexpr std::size_t half = hn::MaxLanes(DD());
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
    for (VD& coordinate : p)
    {
      coordinate = hn::Mul(coordinate, scale);
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
      HWY_ALIGN std::uint64_t bits[half];
      const hn::ScalableTag<std::uint64_t> d64;
      hn::Store(hn::BitCast(d64, hn::Add(cell, toInteger)), d64, bits);
      for (std::size_t lane = 0; lane < half; ++lane)
      {
        block.Cell[axis][i + lane] = static_cast<std::uint32_t>(bits[lane]);
      }
    }
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

/// Cells around a sample's own that the fast loops can ask for.
template <int N>
int RowReach(const NoiseSetup& setup)
{
  const double length = 1.0 / std::sqrt(VectorEigenvalues(setup.Parameters, N).Along);
  // Bent by at most half the length, since the length is at most the radius of curvature.
  double reach = std::max(1.0, setup.Curved ? 1.5 * length + 1.0 : length);
  if (setup.Parameters.LatticeWindow)
  {
    reach = std::min(reach, static_cast<double>(setup.Parameters.Quality + 1));
  }
  return static_cast<int>(std::ceil(reach)) + 1;
}

/// One octave of an image: places along x, and the gradient rows if they serve.
template <int N>
struct ImageOctave
{
  std::vector<std::uint32_t> Column; // wrapped cell, or its distance from the first of the rows
  std::vector<float> Fraction;
  std::unique_ptr<GradientRows<N>> Rows;

  ImageOctave(const NoiseSetup& setup, const OctaveSetup& octave, const ImageGrid& grid)
    : Column(grid.Dimensions[0] + Lanes)
    , Fraction(grid.Dimensions[0] + Lanes)
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
    const int reach = RowReach<N>(setup);
    const bool serve = !setup.Variant && step >= 0.0 && step <= 1.0 && reach <= 32;
    const std::int64_t firstColumn = serve ? cells.front() - reach : 0;
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
    if (serve)
    {
      const auto columns = static_cast<std::size_t>(cells.back() - firstColumn + reach + 2);
      this->Rows = std::make_unique<GradientRows<N>>(octave, firstColumn, columns, reach);
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
      ClearTail<N>(*block, count);
      if (setup.Curved)
      {
        ImageCurvature<N>(setup, grid, field, scaleX, i0, count, j, k, *block);
      }
      Metrics<N>(setup, field, first, count, *block);
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
        const auto fractions = [&](std::size_t i, V(&f)[N]) HWY_ATTR
        {
          f[0] = Load(image.Fraction.data() + i0 + i);
          for (int axis = 1; axis < N; ++axis)
          {
            f[axis] = fraction[axis];
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
          LocatePoints<N>(setup, octave, block->Positions, count, *block);
          LaneCorners<N> corners(octave, setup.Parameters.Gradients);
          AddOctave<N, true>(setup, octave, *block, count, corners, counts.VisitedCorners,
            [&](std::size_t i, V(&f)[N]) HWY_ATTR
            {
              corners.SetCells(block->Cell[0] + i, block->Cell[1] + i, block->Cell[2] + i);
              for (int axis = 0; axis < N; ++axis)
              {
                f[axis] = Load(block->Fraction[axis] + i);
              }
            });
        }
        else if (image.Rows)
        {
          image.Rows->MoveTo(cell[1], cell[2]);
          RowCorners<N> corners(*image.Rows);
          AddOctave<N, false>(setup, octave, *block, count, corners, counts.VisitedCorners,
            [&](std::size_t i, V(&f)[N]) HWY_ATTR
            {
              corners.SetCells(image.Column.data() + i0 + i);
              fractions(i, f);
            });
        }
        else
        {
          HWY_ALIGN std::uint32_t y[Lanes];
          HWY_ALIGN std::uint32_t z[Lanes];
          std::fill(y, y + Lanes, WrapToPeriod(cell[1], octave.Period[1]));
          std::fill(z, z + Lanes, WrapToPeriod(cell[2], octave.Period[2]));
          LaneCorners<N> corners(octave, setup.Parameters.Gradients);
          const auto setCells = [&](std::size_t i, V(&f)[N]) HWY_ATTR
          {
            corners.SetCells(image.Column.data() + i0 + i, y, z);
            fractions(i, f);
          };
          if (setup.Variant)
          {
            AddOctave<N, true>(
              setup, octave, *block, count, corners, counts.VisitedCorners, setCells);
          }
          else
          {
            AddOctave<N, false>(
              setup, octave, *block, count, corners, counts.VisitedCorners, setCells);
          }
        }
      }
      Finish(setup, *block, count, noise + first, counts);
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
    ClearTail<N>(*block, count);
    if (setup.Curved)
    {
      CopyCurvature<N>(setup, field.Curvature->Read(first, count, block->Tuples), count, *block);
    }
    Metrics<N>(setup, field, first, count, *block);
    if (setup.Octaves.size() > 1)
    {
      std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
    }
    const double* place = positions.Read(first, count, block->Positions);
    for (const OctaveSetup& octave : setup.Octaves)
    {
      LocatePoints<N>(setup, octave, place, count, *block);
      LaneCorners<N> corners(octave, setup.Parameters.Gradients);
      const auto setCells = [&](std::size_t i, V(&f)[N]) HWY_ATTR
      {
        corners.SetCells(block->Cell[0] + i, block->Cell[1] + i, block->Cell[2] + i);
        for (int axis = 0; axis < N; ++axis)
        {
          f[axis] = Load(block->Fraction[axis] + i);
        }
      };
      if (setup.Variant)
      {
        AddOctave<N, true>(setup, octave, *block, count, corners, counts.VisitedCorners, setCells);
      }
      else
      {
        AddOctave<N, false>(setup, octave, *block, count, corners, counts.VisitedCorners, setCells);
      }
    }
    Finish(setup, *block, count, noise + first, counts);
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
