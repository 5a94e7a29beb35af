// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The sum over corners for any Quality and any variant (see SteerableNoiseSimd-inl.h, which includes
 * this for each SIMD level).
 *
 * Neighbouring samples are reached by the same corners. So they are listed once for a tile of several
 * registers of samples, with a register of corners at a time: first the lattice rows, then the corners
 * on them with their gradients. Then each register of samples finds out which of the corners reach it,
 * again for a register of corners at a time, and takes those one by one. Registers that differ too much
 * do not share a list; samples of a register that lie apart have rows in common only and go to their own
 * corners.
 */

/// first, first + 1, ... (Highway 1.0 makes them lane by lane).
HWY_INLINE VI RampInt(int first)
{
  HWY_ALIGN static constexpr std::int32_t steps[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
    13, 14, 15 };
  static_assert(Lanes <= 16);
  return hn::Add(hn::Set(DI(), first), hn::Load(DI(), steps));
}

HWY_INLINE V Ramp(float first)
{
  return hn::Add(Const(first), hn::ConvertTo(DF(), RampInt(0)));
}

/// Corners of a list, or lattice rows, that go through the stages together: a bit for each.
constexpr std::size_t ListSize = 64;

/// Corners that may be in reach, and what samples need to know of them.
template <int N>
struct CornerList
{
  std::size_t Count = 0;
  /// How many of them have been sifted.
  std::size_t Sifted = 0;
  /// From the cell that the tile counts from. There is room for a register behind.
  HWY_ALIGN std::int32_t Index[N][ListSize + 16];
  HWY_ALIGN float Offset[N][ListSize];
  HWY_ALIGN float Gradient[N][ListSize];
  /// Of variants: displacement of the corner, (τ - 1/2) Speed, and what the surflet is multiplied by.
  HWY_ALIGN float Jitter[N][ListSize];
  HWY_ALIGN float Travel[ListSize];
  HWY_ALIGN float Amplitude[ListSize];
  /// Of the axes that all samples of a register of an image share: window, and distances (3D).
  HWY_ALIGN float RowWindow[ListSize];
  HWY_ALIGN float FromRow[N][ListSize];
};

/// The same of a corner for the lanes of a register.
template <int N>
struct Corner
{
  V Offset[N];
  V Gradient[N];
  V Jitter[N];
  V Travel;
  V Amplitude;
  V RowWindow;
  V FromRow[N];

  WALK_INLINE Corner() {}
  /// One corner of a list for all lanes.
  WALK_INLINE Corner(const CornerList<N>& list, std::size_t i)
    : Travel(Const(list.Travel[i]))
    , Amplitude(Const(list.Amplitude[i]))
    , RowWindow(Const(list.RowWindow[i]))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Offset[axis] = Const(list.Offset[axis][i]);
      this->Gradient[axis] = Const(list.Gradient[axis][i]);
      this->Jitter[axis] = Const(list.Jitter[axis][i]);
      this->FromRow[axis] = Const(list.FromRow[axis][i]);
    }
  }
};

/// The surflet of a tile: half axes, where its fade ends, and how far it travels to either side.
struct Extent
{
  float HalfLength;
  float HalfWidth;
  float Travel;
  /// A streak has the same width everywhere.
  bool Tapers;
};

/**
 * A group of samples, the same in all lanes. They change almost linearly with two numbers λ in [-1, 1], one
 * within a register, the other from one to the next: a sample is at Place + Σ λ PlaceStep, and so on, up to
 * small rests. Distances s along and t across are from the bent axis of the middle.
 *
 * Such a sample sees a corner at v - Σ λ PlaceStep, along u = U + Σ λ UStep, with the bend + Σ λ BendStep,
 * each up to its rest. Its s is therefore s + Σ λ sStep up to AlongRest, with sStep = v UStep - AlongStep,
 * and across U, which only takes away, its t is t - Σ λ (PlaceStep + s UStep + s²/2 BendStep + s sStep
 * Bend) up to GetRest(s, Σ |sStep|).
 */
template <int N>
struct Group
{
  V Place[N];
  V U[N];
  V Bend[N];
  V PlaceStep[2][N]; // as distances, not in indices of the lattice
  V UStep[2][N];
  V BendStep[2][N];
  V PlaceRest;
  V DirectionRest;
  V BendRest;

  V BendLength;
  V AlongStep[2];
  /// Sums over the steps: of their lengths, and the largest v UStep.
  V Places;
  V Turn;
  V Change;
  V MostTurn;
  V AlongRest;
  /// What GetRest is made of.
  V TurnRest;
  V ChangeRest;
  V HalfKappa;
  V Linear;
  V HalfBendRest;

  WALK_INLINE Group() {}

  /// What follows from the numbers before.
  WALK_INLINE void SetBounds(const Extent& extent)
  {
    const V half = Const(0.5f);
    this->BendLength = hn::Sqrt(Dot(this->Bend, this->Bend));
    this->Places = this->Turn = this->Change = hn::Zero(DF());
    V bendTurn = hn::Zero(DF());
    for (int k = 0; k < 2; ++k)
    {
      this->AlongStep[k] = Dot(this->PlaceStep[k], this->U);
      this->Places = hn::Add(this->Places, Length(this->PlaceStep[k]));
      this->Turn = hn::Add(this->Turn, Length(this->UStep[k]));
      this->Change = hn::Add(this->Change, Length(this->BendStep[k]));
      bendTurn = hn::Add(bendTurn, hn::Abs(Dot(this->Bend, this->UStep[k])));
    }
    // A corner in reach is at most this far from the sample, along it and, unbent, across it.
    const float mostAlong = extent.HalfLength + extent.Travel;
    const V mostSag = Const(0.5f * mostAlong * mostAlong);
    const V turn = hn::Add(this->Turn, this->DirectionRest);
    const V change = hn::Add(this->Change, this->BendRest);
    const V kappa = hn::Add(this->BendLength, change);
    const V places = hn::Add(this->Places, this->PlaceRest);
    const V mostAcross = hn::MulAdd(mostSag, kappa, Const(extent.HalfWidth));
    this->MostTurn = hn::MulAdd(mostSag, bendTurn,
      hn::Mul(this->Turn,
        hn::MulAdd(turn, Const(mostAlong),
          hn::MulAdd(mostSag, change, hn::Add(places, Const(extent.HalfWidth))))));
    const V rest = hn::Add(this->PlaceRest,
      hn::MulAdd(places, this->Turn,
        hn::Mul(this->DirectionRest, hn::Add(places, hn::Add(mostAcross, Const(mostAlong))))));
    this->AlongRest = rest;
    this->TurnRest = turn;
    this->ChangeRest = change;
    this->HalfKappa = hn::Mul(half, kappa);
    this->Linear = hn::MulAdd(kappa, rest, this->DirectionRest);
    this->HalfBendRest = hn::Mul(half, this->BendRest);
  }

  /// What t can be off; `steps`: Σ |sStep|, or more.
  WALK_INLINE V GetRest(V distance, V steps) const
  {
    const V both = hn::Add(steps, this->AlongRest);
    const V constant =
      hn::MulAdd(both, hn::MulAdd(this->HalfKappa, both, this->TurnRest), this->PlaceRest);
    const V linear = hn::MulAdd(steps, this->ChangeRest, this->Linear);
    return hn::MulAdd(hn::MulAdd(this->HalfBendRest, distance, linear), distance, constant);
  }

private:
  static WALK_INLINE V Length(const V (&v)[N]) { return hn::Sqrt(Dot(v, v)); }
};

/// A quadratic in s.
WALK_INLINE V Quadratic(const V (&coefficients)[3], V s)
{
  return hn::MulAdd(hn::MulAdd(coefficients[2], s, coefficients[1]), s, coefficients[0]);
}

/// Half-width of a surflet at |s| = `distance` and farther; beyond its end so negative that it stays so.
WALK_INLINE V GetTaper(V distance, V inverseLength, V halfWidth, bool tapers)
{
  const V s = hn::Mul(hn::Max(distance, hn::Zero(DF())), inverseLength);
  const V left = hn::NegMulAdd(s, s, Const(1.0f));
  const V taper = tapers ? hn::Sqrt(hn::Max(left, hn::Zero(DF()))) : Const(1.0f);
  return hn::IfThenElse(hn::Lt(left, hn::Zero(DF())), Const(-1e9f), hn::Mul(halfWidth, taper));
}

/// Where lattice rows are cut: the reach of registers together in all lanes, or that of a sample in each.
template <int N>
struct Reach
{
  V Place[N];
  V U[N];
  V Bend[N];
  V BendLength;
  V LargestBend; // of any sample
  V Length;      // what can be ahead or behind included
  V HalfWidth;
  V LargestWidth;
  V InverseLength;
  /// Largest distance of a place from the middle; how far rows are continued for samples ahead on them.
  V Spread;
  V RowSpread;
  /// What s can be off that of the middle; and t, by Across[0] + Across[1] |s| + Across[2] s².
  V AlongReach;
  V Across[3];
  bool Tapers;

  WALK_INLINE Reach() {}

  /**
   * All that a group reaches. Of its first step the part on a lattice row, as long as `row`, is either a
   * step like others, or the row is continued by it.
   */
  WALK_INLINE Reach(const Group<N>& group, const Extent& extent, V row)
    : BendLength(group.BendLength)
    , LargestBend(hn::Add(group.HalfKappa, group.HalfKappa))
    , HalfWidth(Const(extent.HalfWidth))
    , InverseLength(Const(1.0f / extent.HalfLength))
    , Spread(hn::Add(group.Places, group.PlaceRest))
    , Tapers(extent.Tapers)
  {
    std::copy(group.Place, group.Place + N, this->Place);
    std::copy(group.U, group.U + N, this->U);
    std::copy(group.Bend, group.Bend + N, this->Bend);
    this->SetAcross(group, extent, hn::Zero(DF()));
    const Reach<N> stepped(*this);
    this->SetAcross(group, extent, row);
    if (hn::GetLane(hn::Sub(stepped.LargestWidth, this->LargestWidth)) < 0.0f)
    {
      *this = stepped;
    }
  }

private:
  WALK_INLINE void SetAcross(const Group<N>& group, const Extent& extent, V row)
  {
    const V half = Const(0.5f);
    this->RowSpread = row;
    // Σ |sStep| at most.
    V along = group.MostTurn;
    V steps0 = hn::Zero(DF());
    V steps1 = hn::Zero(DF());
    for (int k = 0; k < 2; ++k)
    {
      V place[N];
      std::copy(group.PlaceStep[k], group.PlaceStep[k] + N, place);
      place[0] = k == 0 ? hn::Sub(place[0], hn::CopySign(row, place[0])) : place[0];
      const V alongStep = Dot(place, this->U);
      V turn[N];
      for (int axis = 0; axis < N; ++axis)
      {
        place[axis] = hn::NegMulAdd(alongStep, this->U[axis], place[axis]);
        turn[axis] = hn::NegMulAdd(alongStep, this->Bend[axis], group.UStep[k][axis]);
      }
      along = hn::Add(along, hn::Abs(alongStep));
      steps0 = hn::Add(steps0, hn::Sqrt(Dot(place, place)));
      steps1 = hn::Add(steps1, hn::Sqrt(Dot(turn, turn)));
    }
    this->Across[0] = hn::Add(steps0, group.GetRest(hn::Zero(DF()), along));
    this->Across[1] = hn::Add(hn::MulAdd(group.BendLength, group.MostTurn, steps1),
      hn::MulAdd(along, group.ChangeRest, group.Linear));
    this->Across[2] = hn::MulAdd(half, group.Change, group.HalfBendRest);
    this->AlongReach = hn::Add(hn::Add(along, group.AlongRest), Const(extent.Travel));
    this->Length = hn::Add(Const(extent.HalfLength), this->AlongReach);
    this->LargestWidth = hn::Add(this->HalfWidth, Quadratic(this->Across, this->Length));
  }
};

/**
 * The registers of a tile, in arrays over registers: each changes almost linearly from its first sample to
 * its last, from Place - PlaceStep to Place + PlaceStep, and so on, up to the rests.
 */
template <int N>
struct Lines
{
  static constexpr std::size_t Room = TileRegisters > Lanes ? TileRegisters : Lanes;
  /// The first sample's; places are counted from there.
  HWY_ALIGN std::uint32_t Cell[N][Room];
  HWY_ALIGN float Place[N][Room];
  HWY_ALIGN float PlaceStep[N][Room];
  HWY_ALIGN float U[N][Room];
  HWY_ALIGN float UStep[N][Room];
  HWY_ALIGN float Bend[N][Room];
  HWY_ALIGN float BendStep[N][Room];
  HWY_ALIGN float PlaceRest[Room];
  HWY_ALIGN float DirectionRest[Room];
  HWY_ALIGN float BendRest[Room];
};

/// Axes across the flow: in 2D the normal (-u_y, u_x), in 3D those of space.
template <int N>
constexpr int AxesAcross = N == 2 ? 1 : N;

/// A vector across u on these axes.
template <int N>
WALK_INLINE void ToAcross(const V (&v)[N], const V (&u)[N], V (&across)[AxesAcross<N>])
{
  if constexpr (N == 2)
  {
    across[0] = hn::MulSub(u[0], v[1], hn::Mul(u[1], v[0]));
  }
  else
  {
    const V along = Dot(v, u);
    for (int axis = 0; axis < N; ++axis)
    {
      across[axis] = hn::NegMulAdd(along, u[axis], v[axis]);
    }
  }
}

/**
 * Registers that share a list, as a group that changes with λ within each and with μ from one to the next;
 * what a corner needs of it to find out which of them it reaches.
 */
template <int N>
struct Span
{
  std::size_t Begin;
  std::size_t End;
  /// Across the flow.
  V Bend[AxesAcross<N>];
  V PlaceStep[2][AxesAcross<N>];
  V UStep[2][AxesAcross<N>];
  V BendStep[2][AxesAcross<N>];
  const Group<N>& Whole;

  WALK_INLINE Span(std::size_t begin, std::size_t end, const Group<N>& group)
    : Begin(begin)
    , End(end)
    , Whole(group)
  {
    ToAcross<N>(group.Bend, group.U, this->Bend);
    for (int k = 0; k < 2; ++k)
    {
      ToAcross<N>(group.PlaceStep[k], group.U, this->PlaceStep[k]);
      ToAcross<N>(group.UStep[k], group.U, this->UStep[k]);
      ToAcross<N>(group.BendStep[k], group.U, this->BendStep[k]);
    }
  }

  /// μ of a register.
  float GetMu(std::size_t r) const
  {
    return this->End - this->Begin < 2 ? 0.0f
                                       : 2.0f * static_cast<float>(r - this->Begin) /
          static_cast<float>(this->End - this->Begin - 1) -
        1.0f;
  }
};

/// How a span sees corners: across the flow they are at T - λ Step[0] - μ Step[1], in reach if within Width.
template <int N>
struct View
{
  V T[AxesAcross<N>];
  V Step[2][AxesAcross<N>];
  V Width;

  WALK_INLINE View() {}

  /// Whether there is a λ in [-1, 1] at which T is within `width` of 0.
  static WALK_INLINE hn::Mask<DF> IsNear(
    const V (&t)[AxesAcross<N>], const V (&step)[AxesAcross<N>], V width)
  {
    if constexpr (N == 2)
    {
      return hn::Le(hn::Sub(hn::Abs(t[0]), hn::Abs(step[0])), width);
    }
    else
    {
      const V one = Const(1.0f);
      const V tStep = Dot(t, step);
      const V step2 = hn::Add(Dot(step, step), Const(1e-20f));
      const V best = hn::Max(hn::Min(hn::Div(tStep, step2), one), hn::Neg(one));
      const V least = hn::MulAdd(hn::MulSub(best, step2, hn::Add(tStep, tStep)), best, Dot(t, t));
      return hn::And(
        hn::Le(least, hn::MulAdd(width, width, Const(1e-5f))), hn::Ge(width, hn::Zero(DF())));
    }
  }
};

/// Samples of a tile with what surflets need of them: a register.
template <int N>
struct Sample
{
  /// Whole cells from where offsets count, and the fraction.
  V Shift[N];
  V Fraction[N];
  V U[N];
  V Bend[N];
  V Along;
  V Across;
  V Sense;
  V RootAlong;
  /// Of metrics with a second axis: it, u x m, what u lacks on them, and the eigenvalue.
  V M[N];
  V ThirdAxis[N];
  V Rest[2];
  V Second;
  /// 2D: the normal n = (-u_y, u_x), also in two parts, see Walk::AddSurflet; what the fraction has of u
  /// and, in two parts, of n; and κ/2.
  V Normal[2];
  V HighNormal[2];
  V LowNormal[2];
  V AlongFraction;
  V HighAcross;
  V LowAcross;
  V HalfBend;

  WALK_INLINE Sample(
    const NoiseSetup& setup, const MetricBlock& block, std::size_t i, const VU (&cell)[N])
    : Along(Load((setup.Curved ? block.BentAlong : block.Along) + i))
    , Across(Load((setup.Curved ? block.BentAcross : block.Across) + i))
    , Sense(Load(block.Sense + i))
    , RootAlong(hn::Sqrt(Along))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Shift[axis] = hn::ConvertTo(
        DF(), hn::BitCast(DI(), hn::Sub(hn::LoadU(DU(), block.Cell[axis] + i), cell[axis])));
      this->Fraction[axis] = Load(block.Fraction[axis] + i);
      this->U[axis] = Load(block.U[axis] + i);
      this->Bend[axis] = setup.Curved ? Load(block.ClampedBend[axis] + i) : hn::Zero(DF());
    }
    if (N == 3 && setup.Biaxial)
    {
      this->Second = Load((setup.Curved ? block.BentSecond : block.Second) + i);
      for (int axis = 0; axis < N; ++axis)
      {
        this->M[axis] = Load(block.M[axis] + i);
      }
      for (int axis = 0; axis < N; ++axis)
      {
        const int j = (axis + 1) % N;
        const int k = (axis + 2) % N;
        this->ThirdAxis[axis] = hn::MulSub(this->U[j], this->M[k], hn::Mul(this->U[k], this->M[j]));
      }
      this->Rest[0] = Load(block.URest[0] + i);
      this->Rest[1] = Load(block.URest[1] + i);
    }
    if constexpr (N == 2)
    {
      this->Normal[0] = hn::Neg(this->U[1]);
      this->Normal[1] = this->U[0];
      this->LowNormal[0] = hn::Neg(Load(block.URest[1] + i));
      this->LowNormal[1] = Load(block.URest[0] + i);
      V high[2];
      V low[2];
      for (int axis = 0; axis < 2; ++axis)
      {
        const V normal = this->Normal[axis];
        this->HighNormal[axis] = RoundTo(normal, 16384.0f);
        this->LowNormal[axis] =
          hn::Add(hn::Sub(normal, this->HighNormal[axis]), this->LowNormal[axis]);
        high[axis] = RoundTo(this->Fraction[axis], 65536.0f);
        low[axis] = hn::Sub(this->Fraction[axis], high[axis]);
      }
      this->AlongFraction = Dot(this->U, this->Fraction);
      this->HighAcross = Dot(this->HighNormal, high);
      this->LowAcross = hn::Add(Dot(this->HighNormal, low), Dot(this->LowNormal, this->Fraction));
      this->HalfBend = hn::Mul(Const(0.5f), Dot(this->Normal, this->Bend));
    }
  }
};

/// `Aligned`: the samples of a register have their places on all axes but the first in common.
template <int N, bool Variant, bool Aligned>
class Walk
{
public:
  WALK_INLINE Walk(const NoiseSetup& setup, const OctaveSetup& octave, const MetricBlock& block)
    : Setup(setup)
    , Params(setup.Parameters)
    , Octave(octave)
    , Block(block)
    , Along(setup.Curved ? block.BentAlong : block.Along)
    , Across(setup.Curved ? block.BentAcross : block.Across)
    , Second(setup.Curved ? block.BentSecond : block.Second)
    // Without a window the fade is taken at 0.
    , InverseReach(Const(Params.LatticeWindow ? 1.0f / (Params.Quality + 1) : 0.0f))
    , LaneStep(hn::Mul(Ramp(0.0f), Const(1.0f / std::max<float>(1.0f, Lanes - 1.0f))))
    , GroupLines()
  {
  }

  /// Register `r` of the tile is that from sample `i` of the block, of which it uses `count` lanes.
  WALK_INLINE void SetRegister(std::size_t r, std::size_t i, std::size_t count)
  {
    this->First[r] = i;
    this->Count[r] = count;
    this->Total[r] = Sums();
  }

  /// Sums up the first `registers` of the tile; returns how many corners their samples visited.
  WALK_INLINE std::uint64_t Evaluate(std::size_t registers)
  {
    this->Visited = 0;
    this->SetLines(registers);
    this->AddSpan(0, registers);
    return this->Visited;
  }

  WALK_INLINE std::size_t GetFirst(std::size_t r) const { return this->First[r]; }
  WALK_INLINE V GetNoise(std::size_t r) const { return Normalized(this->Setup, N, this->Total[r]); }

private:
  // ---- which registers share a list -------------------------------------------------------------

  /// Registers [begin, end): together if they are alike, else half by half.
  HWY_NOINLINE void AddSpan(std::size_t begin, std::size_t end)
  {
    const float* rest = this->GroupLines.PlaceRest;
    if (*std::max_element(rest + begin, rest + end) < LargestSpread) // else it cannot be
    {
      const Group<N> group = this->GetGroup(begin, end);
      const V row = this->IsOblique() ? hn::Zero(DF()) : hn::Abs(group.PlaceStep[0][0]);
      const Reach<N> reach(group, this->Surflet, row);
      if (hn::GetLane(reach.LargestWidth) - this->Surflet.HalfWidth < LargestSpread &&
        hn::GetLane(reach.Spread) < LargestExtent)
      {
        this->AddTogether(Span<N>(begin, end, group), reach);
        return;
      }
    }
    if (end - begin > 1)
    {
      const std::size_t middle = (begin + end) / 2;
      this->AddSpan(begin, middle);
      this->AddSpan(middle, end);
    }
    else
    {
      this->AddApart(begin);
    }
  }

  WALK_INLINE bool IsStreaks() const { return Variant && this->Params.Surflet == Basis::Streaks; }

  WALK_INLINE V GetLeastAcross(std::size_t i) const
  {
    const V across = Load(this->Across + i);
    return this->Setup.Biaxial ? hn::Min(across, Load(this->Second + i)) : across;
  }

  /// Half-length in units of that of the metric's ellipsoid, and half-width.
  WALK_INLINE float GetLengthSupport() const
  {
    return this->IsStreaks() ? 1.0f : std::sqrt(this->Setup.Support);
  }
  WALK_INLINE float GetWidthSupport() const
  {
    return this->IsStreaks() ? this->Setup.Support : std::sqrt(this->Setup.Support);
  }

  /// How far surflets travel to either side, in half-lengths.
  WALK_INLINE float GetTravel() const
  {
    return Variant && this->Params.Motion ? 0.5f * std::abs(static_cast<float>(this->Params.Speed))
                                          : 0.0f;
  }

  /// Middle and half of the way from `first` to `last`; adds the squares of what `values` are off it.
  WALK_INLINE V AddRest(
    V rest2, V values, float first, float last, float& middle, float& step) const
  {
    middle = 0.5f * (first + last);
    step = 0.5f * (last - first);
    const V linear = hn::MulAdd(this->LaneStep, Const(last - first), Const(first));
    const V rest = hn::Sub(values, linear);
    return hn::MulAdd(rest, rest, rest2);
  }

  /// The tile's registers as lines, and the largest surflet of their samples.
  HWY_NOINLINE void SetLines(std::size_t registers)
  {
    Lines<N>& lines = this->GroupLines;
    V along = Load(this->Along + this->First[0]);
    V across = this->GetLeastAcross(this->First[0]);
    float before[N] = {};
    for (std::size_t r = 0; r < registers; ++r)
    {
      const std::size_t first = this->First[r];
      const std::size_t last = first + Lanes - 1;
      along = hn::Min(along, Load(this->Along + first));
      across = hn::Min(across, this->GetLeastAcross(first));
      // u and -u are the same axis: all on one side of the first, and that on the side of the line before.
      float side = 0.0f;
      float lastSide = 0.0f;
      for (int axis = 0; axis < N; ++axis)
      {
        const float* u = this->Block.U[axis];
        side += u[first] * before[axis];
        lastSide += u[last] * u[first];
      }
      side = std::copysign(1.0f, side);
      V cosine = hn::Zero(DF());
      for (int axis = 0; axis < N; ++axis)
      {
        const float* u = this->Block.U[axis];
        before[axis] = side * u[first];
        cosine = hn::MulAdd(Load(u + first), Const(before[axis]), cosine);
      }
      const V sign = hn::And(cosine, hn::BitCast(DF(), hn::Set(DU(), 0x80000000u)));
      const float lastSign = side * std::copysign(1.0f, lastSide);
      V place2 = hn::Zero(DF());
      V direction2 = hn::Zero(DF());
      V bend2 = hn::Zero(DF());
      for (int axis = 0; axis < N; ++axis)
      {
        const float* u = this->Block.U[axis];
        direction2 = this->AddRest(direction2, hn::Xor(Load(u + first), sign), before[axis],
          lastSign * u[last], lines.U[axis][r], lines.UStep[axis][r]);
        if (this->Setup.Curved)
        {
          const float* bend = this->Block.ClampedBend[axis];
          bend2 = this->AddRest(bend2, Load(bend + first), bend[first], bend[last],
            lines.Bend[axis][r], lines.BendStep[axis][r]);
        }
        const std::uint32_t* cell = this->Block.Cell[axis];
        const float* fraction = this->Block.Fraction[axis];
        lines.Cell[axis][r] = cell[first];
        lines.Place[axis][r] = fraction[first];
        lines.PlaceStep[axis][r] = 0.0f;
        if (!Aligned || axis == 0)
        {
          const VU cells = hn::Sub(hn::LoadU(DU(), cell + first), hn::Set(DU(), cell[first]));
          const V places =
            hn::Add(hn::ConvertTo(DF(), hn::BitCast(DI(), cells)), Load(fraction + first));
          const auto lastCells = static_cast<std::int32_t>(cell[last] - cell[first]);
          place2 = this->AddRest(place2, places, fraction[first],
            static_cast<float>(lastCells) + fraction[last], lines.Place[axis][r],
            lines.PlaceStep[axis][r]);
        }
      }
      // At first the squares.
      lines.PlaceRest[r] = GreatestLane(place2);
      lines.DirectionRest[r] = GreatestLane(direction2);
      lines.BendRest[r] = this->Setup.Curved ? GreatestLane(bend2) : 0.0f;
    }
    this->Surflet.HalfLength = this->GetLengthSupport() / std::sqrt(LeastLane(along)) + Slack;
    this->Surflet.HalfWidth = this->GetWidthSupport() / std::sqrt(LeastLane(across)) + Slack;
    this->Surflet.Travel = this->GetTravel() / std::sqrt(LeastLane(along));
    this->Surflet.Tapers = !this->IsStreaks();
    for (float* rest : { lines.PlaceRest, lines.DirectionRest, lines.BendRest })
    {
      for (std::size_t r = 0; r < registers; r += Lanes)
      {
        hn::Store(hn::Sqrt(hn::Load(DF(), rest + r)), DF(), rest + r);
      }
    }
  }

  template <std::size_t Axes, std::size_t Room>
  static WALK_INLINE void LoadAll(
    const float (&arrays)[Axes][Room], std::size_t i, V (&values)[Axes])
  {
    for (std::size_t axis = 0; axis < Axes; ++axis)
    {
      values[axis] = hn::Load(DF(), arrays[axis] + i);
    }
  }

  template <std::size_t Axes, std::size_t Room>
  static WALK_INLINE void StoreAll(
    const V (&values)[Axes], float (&arrays)[Axes][Room], std::size_t i)
  {
    for (std::size_t axis = 0; axis < Axes; ++axis)
    {
      hn::Store(values[axis], DF(), arrays[axis] + i);
    }
  }

  /// Leaves of v what is across u; returns the rest.
  static WALK_INLINE V TakeAlong(V (&v)[N], const V (&u)[N])
  {
    const V along = Dot(v, u);
    for (int axis = 0; axis < N; ++axis)
    {
      v[axis] = hn::NegMulAdd(along, u[axis], v[axis]);
    }
    return hn::Abs(along);
  }

  /// The middle of unit vectors is shorter than 1, and bends and changes are not quite across it.
  static WALK_INLINE void SetAcrossFlow(Group<N>& group)
  {
    const V norm = hn::Sqrt(Dot(group.U, group.U));
    const V inverse = Inverse(norm);
    for (V& component : group.U)
    {
      component = hn::Mul(component, inverse);
    }
    group.DirectionRest = hn::Add(group.DirectionRest, hn::Abs(hn::Sub(Const(1.0f), norm)));
    group.BendRest = hn::Add(group.BendRest, TakeAlong(group.Bend, group.U));
    for (int k = 0; k < 2; ++k)
    {
      group.DirectionRest = hn::Add(group.DirectionRest, TakeAlong(group.UStep[k], group.U));
      group.BendRest = hn::Add(group.BendRest, TakeAlong(group.BendStep[k], group.U));
    }
  }

  /// From indices of the lattice to distances; its steps have length 1 at most.
  WALK_INLINE void ToDistances(V (&place)[N]) const
  {
    V index[N];
    std::copy(place, place + N, index);
    this->ToPlace(index, place);
  }

  /**
   * Splits vectors of the lines [begin, end), `value(axis, i)` their middles and `steps` what changes
   * within them, into the linear change within a line and from line to line. Returns the most that they,
   * with their own rests, are off that.
   */
  template <class Value>
  WALK_INLINE V SplitSpan(std::size_t begin, std::size_t end, Value&& value,
    const float (&steps)[N][Lines<N>::Room], const float* rests, V (&middle)[N],
    V (&change)[2][N]) const
  {
    const V half = Const(0.5f);
    for (int axis = 0; axis < N; ++axis)
    {
      const V first = Const(value(axis, begin));
      const V last = Const(value(axis, end - 1));
      middle[axis] = hn::Mul(half, hn::Add(first, last));
      change[0][axis] = Const(0.5f * (steps[axis][begin] + steps[axis][end - 1]));
      change[1][axis] = hn::Mul(half, hn::Sub(last, first));
    }
    const float lambdaStep = 2.0f / std::max<float>(1.0f, end - begin - 1.0f);
    V most = hn::Zero(DF());
    for (std::size_t i = 0; i < end; i += Lanes)
    {
      const V r = Ramp(static_cast<float>(i) - static_cast<float>(begin));
      const V lambda = hn::MulSub(r, Const(lambdaStep), Const(end - begin > 1 ? 1.0f : 0.0f));
      V rest2 = hn::Zero(DF());
      V step2 = hn::Zero(DF());
      for (int axis = 0; axis < N; ++axis)
      {
        HWY_ALIGN float values[Lanes];
        for (std::size_t lane = 0; lane < Lanes; ++lane)
        {
          values[lane] = value(axis, i + lane);
        }
        const V linear = hn::MulAdd(lambda, change[1][axis], middle[axis]);
        const V rest = hn::Sub(hn::Load(DF(), values), linear);
        rest2 = hn::MulAdd(rest, rest, rest2);
        const V step = hn::Sub(hn::Load(DF(), steps[axis] + i), change[0][axis]);
        step2 = hn::MulAdd(step, step, step2);
      }
      const auto used =
        hn::And(hn::Ge(r, hn::Zero(DF())), hn::Lt(r, Const(static_cast<float>(end - begin))));
      const V rest = hn::Add(hn::Load(DF(), rests + i), hn::Add(hn::Sqrt(rest2), hn::Sqrt(step2)));
      most = hn::Max(most, hn::IfThenElseZero(used, rest));
    }
    return hn::MaxOfLanes(DF(), most);
  }

  /// The registers [begin, end) as a group. Offsets count from its first cell from now on.
  WALK_INLINE Group<N> GetGroup(std::size_t begin, std::size_t end)
  {
    const Lines<N>& lines = this->GroupLines;
    Group<N> group;
    for (int axis = 0; axis < N; ++axis)
    {
      this->Cell[axis] = hn::Set(DU(), lines.Cell[axis][begin]);
    }
    group.PlaceRest = this->SplitSpan(
      begin, end,
      [&](int axis, std::size_t r) HWY_ATTR
      {
        const auto cells = static_cast<std::int32_t>(lines.Cell[axis][r] - lines.Cell[axis][begin]);
        return lines.Place[axis][r] + static_cast<float>(cells);
      },
      lines.PlaceStep, lines.PlaceRest, group.Place, group.PlaceStep);
    group.DirectionRest = this->SplitSpan(
      begin, end, [&](int axis, std::size_t r) HWY_ATTR { return lines.U[axis][r]; }, lines.UStep,
      lines.DirectionRest, group.U, group.UStep);
    if (this->Setup.Curved)
    {
      group.BendRest = this->SplitSpan(
        begin, end, [&](int axis, std::size_t r) HWY_ATTR { return lines.Bend[axis][r]; },
        lines.BendStep, lines.BendRest, group.Bend, group.BendStep);
    }
    else
    {
      group.BendRest = hn::Zero(DF());
      for (int axis = 0; axis < N; ++axis)
      {
        group.Bend[axis] = group.BendStep[0][axis] = group.BendStep[1][axis] = hn::Zero(DF());
      }
    }
    this->ToDistances(group.PlaceStep[0]);
    this->ToDistances(group.PlaceStep[1]);
    if (this->IsOblique())
    {
      group.PlaceRest = hn::Add(group.PlaceRest, group.PlaceRest);
    }
    SetAcrossFlow(group);
    group.SetBounds(this->Surflet);
    return group;
  }

  /// The samples of a register, each with its own cell, place and reach.
  WALK_INLINE void SetApart(Reach<N>& reach, std::size_t r)
  {
    const std::size_t first = this->First[r];
    for (int axis = 0; axis < N; ++axis)
    {
      this->Cell[axis] = hn::LoadU(DU(), this->Block.Cell[axis] + first);
      reach.Place[axis] = Load(this->Block.Fraction[axis] + first);
      reach.U[axis] = Load(this->Block.U[axis] + first);
      reach.Bend[axis] =
        this->Setup.Curved ? Load(this->Block.ClampedBend[axis] + first) : hn::Zero(DF());
    }
    reach.BendLength = reach.LargestBend = hn::Sqrt(Dot(reach.Bend, reach.Bend));
    const V one = Const(1.0f);
    const V rootInverse = hn::Div(one, hn::Sqrt(Load(this->Along + first)));
    const V length = hn::MulAdd(Const(this->GetLengthSupport()), rootInverse, Const(Slack));
    reach.HalfWidth = hn::Add(
      hn::Div(Const(this->GetWidthSupport()), hn::Sqrt(this->GetLeastAcross(first))), Const(Slack));
    reach.LargestWidth = reach.HalfWidth;
    reach.InverseLength = hn::Div(one, length);
    reach.AlongReach = hn::Mul(rootInverse, Const(this->GetTravel()));
    reach.Length = hn::Add(length, reach.AlongReach);
    reach.Spread = reach.RowSpread = hn::Zero(DF());
    reach.Across[0] = reach.Across[1] = reach.Across[2] = hn::Zero(DF());
    reach.Tapers = !this->IsStreaks();
  }

  // ---- listing corners --------------------------------------------------------------------------

  /// Bounds of loops over corners, whatever the numbers are.
  static WALK_INLINE VI ToCorners(V place)
  {
    return hn::ConvertTo(DI(), hn::Max(hn::Min(place, Const(1000.0f)), Const(-1000.0f)));
  }

  WALK_INLINE bool IsOblique() const { return Variant && this->Params.Grid == Lattice::Simplicial; }

  /// From indices of the lattice to its places.
  WALK_INLINE void ToPlace(const V (&index)[N], V (&place)[N]) const
  {
    for (int i = 0; i < N; ++i)
    {
      place[i] = index[i];
      if (this->IsOblique())
      {
        place[i] = hn::Mul(index[0], Const(this->Setup.LatticeSteps[i][0]));
        for (int j = 1; j < N; ++j)
        {
          place[i] = hn::MulAdd(index[j], Const(this->Setup.LatticeSteps[i][j]), place[i]);
        }
      }
    }
  }

  /// How an index of the lattice changes along the flow, and with it across.
  struct IndexAxis
  {
    V Along;
    V InverseAlong;
    V Bend;
    V Width;
    V BoxLow;
    V BoxHigh;
  };

  /// 1 / v, or that of something small.
  static WALK_INLINE V Inverse(V v)
  {
    return hn::Div(Const(1.0f), hn::CopySign(hn::Max(hn::Abs(v), Const(1e-6f)), v));
  }

  WALK_INLINE IndexAxis GetIndexAxis(const Reach<N>& reach, int axis) const
  {
    IndexAxis result;
    result.Along = reach.U[axis];
    result.Bend = reach.Bend[axis];
    float w2 = 1.0f;
    if (this->IsOblique())
    {
      result.Along = result.Bend = hn::Zero(DF());
      w2 = 0.0f;
      for (int i = 0; i < N; ++i)
      {
        const auto w = static_cast<float>(this->Setup.LatticeIndices[axis][i]);
        result.Along = hn::MulAdd(Const(w), reach.U[i], result.Along);
        result.Bend = hn::MulAdd(Const(w), reach.Bend[i], result.Bend);
        w2 += w * w;
      }
    }
    const V across =
      hn::Sqrt(hn::Max(hn::NegMulAdd(result.Along, result.Along, Const(w2)), hn::Zero(DF())));
    result.Width = hn::Mul(hn::Add(reach.LargestWidth, this->GetLooseness(reach)), across);
    result.InverseAlong = Inverse(result.Along);
    // Window and jitter are boxes of places; oblique indices need √3 times as many to cover them.
    const float more = this->IsOblique() ? 1.75f : 1.0f;
    const V box =
      hn::MulAdd(reach.Spread, Const(std::sqrt(w2)), Const(this->Setup.WindowReach * more));
    result.BoxLow = hn::Sub(reach.Place[axis], hn::Add(box, Const(this->Setup.JitterUp * more)));
    result.BoxHigh = hn::Add(reach.Place[axis], hn::Add(box, Const(this->Setup.JitterDown * more)));
    return result;
  }

  /// How much farther across a corner can stand before jitter moves it, the change of its sag included.
  WALK_INLINE V GetLooseness(const Reach<N>& reach) const
  {
    const V radius = Const(this->Setup.JitterRadius);
    return hn::MulAdd(hn::Mul(radius, reach.LargestBend), hn::Add(reach.Length, radius), radius);
  }

  /// s²/2 on an interval, times a factor: its least and greatest value.
  static WALK_INLINE void GetSag(V factor, V low, V high, V& least, V& greatest)
  {
    const V half = hn::Mul(Const(0.5f), factor);
    const V first = hn::Mul(hn::Mul(low, low), half);
    const V last = hn::Mul(hn::Mul(high, high), half);
    const V turn =
      hn::IfThenElse(hn::Lt(hn::Mul(low, high), hn::Zero(DF())), hn::Zero(DF()), first);
    least = hn::Min(hn::Min(first, last), turn);
    greatest = hn::Max(hn::Max(first, last), turn);
  }

  /// Leaves of [low, high] the s at which the index of that axis can be `index`.
  WALK_INLINE void Narrow(
    const Reach<N>& reach, int number, const IndexAxis& axis, V index, V& low, V& high) const
  {
    const V offset = hn::Sub(index, hn::Sub(reach.Place[number], Const(this->Setup.JitterMiddle)));
    V least = hn::Zero(DF());
    V greatest = hn::Zero(DF());
    for (int round = 0; round < (this->Setup.Curved ? 2 : 1); ++round)
    {
      if (this->Setup.Curved)
      {
        GetSag(axis.Bend, low, high, least, greatest);
      }
      const V a = hn::Mul(hn::Sub(hn::Sub(offset, axis.Width), greatest), axis.InverseAlong);
      const V b = hn::Mul(hn::Sub(hn::Add(offset, axis.Width), least), axis.InverseAlong);
      low = hn::Max(low, hn::Min(a, b));
      high = hn::Min(high, hn::Max(a, b));
    }
  }

  /// Indices that the reach has for s in [low, high]; none if that is empty.
  WALK_INLINE void GetRange(const Reach<N>& reach, int number, const IndexAxis& axis, V low, V high,
    V& first, V& last) const
  {
    first = axis.BoxLow;
    last = axis.BoxHigh;
    if (this->Params.AnisotropicWeight)
    {
      V least = hn::Zero(DF());
      V greatest = hn::Zero(DF());
      if (this->Setup.Curved)
      {
        GetSag(axis.Bend, low, high, least, greatest);
      }
      const V a = hn::Mul(low, axis.Along);
      const V b = hn::Mul(high, axis.Along);
      const V place = hn::Sub(reach.Place[number], Const(this->Setup.JitterMiddle));
      first = hn::Max(first, hn::Add(place, hn::Sub(hn::Add(hn::Min(a, b), least), axis.Width)));
      last = hn::Min(last, hn::Add(place, hn::Add(hn::Add(hn::Max(a, b), greatest), axis.Width)));
    }
    first = hn::Ceil(first);
    last = hn::IfThenElse(hn::Gt(low, high), Const(-1e9f), hn::Floor(last));
  }

  HWY_NOINLINE void AddTogether(const Span<N>& span, const Reach<N>& reach)
  {
    HWY_ALIGN std::int32_t rowY[ListSize];
    HWY_ALIGN std::int32_t rowZ[ListSize];
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    std::size_t rows = 0;
    CornerList<N> list;
    const IndexAxis axisY = this->GetIndexAxis(reach, 1);
    const V length = hn::Add(reach.Length, Const(this->Setup.JitterRadius));
    V first;
    V last;
    const auto addRows = [&](int y, int lastY, int z) HWY_ATTR
    {
      for (; y <= lastY; y += static_cast<int>(Lanes))
      {
        if (rows + Lanes > ListSize)
        {
          this->AddRows(span, reach, rowY, rowZ, rows, list);
          rows = 0;
        }
        hn::StoreU(RampInt(y), DI(), rowY + rows);
        hn::StoreU(hn::Set(DI(), z), DI(), rowZ + rows);
        rows += static_cast<std::size_t>(std::min(static_cast<int>(Lanes), lastY - y + 1));
      }
    };
    if constexpr (N == 2)
    {
      this->GetRange(reach, 1, axisY, hn::Neg(length), length, first, last);
      addRows(ToCorner(hn::GetLane(first)), ToCorner(hn::GetLane(last)), 0);
    }
    else
    {
      const IndexAxis axisZ = this->GetIndexAxis(reach, 2);
      this->GetRange(reach, 2, axisZ, hn::Neg(length), length, first, last);
      const int lastZ = ToCorner(hn::GetLane(last));
      for (int z = ToCorner(hn::GetLane(first)); z <= lastZ; z += static_cast<int>(Lanes))
      {
        V low = hn::Neg(length);
        V high = length;
        if (this->Params.AnisotropicWeight)
        {
          this->Narrow(reach, 2, axisZ, Ramp(static_cast<float>(z)), low, high);
        }
        this->GetRange(reach, 1, axisY, low, high, first, last);
        hn::Store(ToCorners(first), DI(), firsts);
        hn::Store(ToCorners(last), DI(), lasts);
        for (int i = 0; i < static_cast<int>(Lanes) && z + i <= lastZ; ++i)
        {
          addRows(firsts[i], lasts[i], z + i);
        }
      }
    }
    this->AddRows(span, reach, rowY, rowZ, rows, list);
    this->Sift(span, reach, list);
    this->AddCorners(span, list);
  }

  /// Puts the corners of these rows on the list.
  HWY_NOINLINE void AddRows(const Span<N>& span, const Reach<N>& reach, std::int32_t* rowY,
    std::int32_t* rowZ, std::size_t rows, CornerList<N>& list)
  {
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    const IndexAxis axis = this->GetIndexAxis(reach, 0);
    for (std::size_t i = rows; i % Lanes != 0; ++i)
    {
      rowY[i] = rowZ[i] = 0; // lanes that nobody looks at
    }
    for (std::size_t i = 0; i < rows; i += Lanes)
    {
      V low = axis.BoxLow;
      V high = axis.BoxHigh;
      if (this->Params.AnisotropicWeight)
      {
        this->CutRows(reach, hn::ConvertTo(DF(), hn::LoadU(DI(), rowY + i)),
          hn::ConvertTo(DF(), hn::LoadU(DI(), rowZ + i)), low, high);
      }
      hn::Store(ToCorners(hn::Ceil(low)), DI(), firsts);
      hn::Store(ToCorners(hn::Floor(high)), DI(), lasts);
      const std::size_t count = std::min(Lanes, rows - i);
      for (std::size_t lane = 0; lane < count; ++lane)
      {
        for (int x = firsts[lane]; x <= lasts[lane]; x += static_cast<int>(Lanes))
        {
          if (list.Count + Lanes > ListSize)
          {
            this->Sift(span, reach, list);
            if (2 * list.Count > ListSize)
            {
              this->AddCorners(span, list);
              list.Count = list.Sifted = 0;
            }
          }
          hn::StoreU(RampInt(x), DI(), list.Index[0] + list.Count);
          hn::StoreU(hn::Set(DI(), rowY[i + lane]), DI(), list.Index[1] + list.Count);
          if constexpr (N == 3)
          {
            hn::StoreU(hn::Set(DI(), rowZ[i + lane]), DI(), list.Index[2] + list.Count);
          }
          list.Count +=
            static_cast<std::size_t>(std::min(static_cast<int>(Lanes), lasts[lane] - x + 1));
        }
      }
    }
  }

  /**
   * Interval of a register of rows: a slab along the flow, then a tube around the parabola, whose sag
   * and width are known within a band once the slab has bounded the distance along the flow.
   */
  WALK_INLINE void CutRows(const Reach<N>& reach, V rowY, V rowZ, V& low, V& high) const
  {
    V row[N];
    V index[N];
    index[0] = hn::Neg(reach.Place[0]);
    index[1] = hn::Sub(rowY, reach.Place[1]);
    if constexpr (N == 3)
    {
      index[2] = hn::Sub(rowZ, reach.Place[2]);
    }
    this->ToPlace(index, row);
    // s and the part t across the flow at the beginning of the row, and their changes along it.
    V s0 = hn::Zero(DF());
    V se = this->IsOblique() ? hn::Zero(DF()) : reach.U[0];
    for (int i = 0; i < N; ++i)
    {
      row[i] = hn::Add(row[i], Const(this->Setup.JitterMiddle));
      s0 = hn::MulAdd(row[i], reach.U[i], s0);
      if (this->IsOblique())
      {
        se = hn::MulAdd(Const(this->Setup.LatticeSteps[i][0]), reach.U[i], se);
      }
    }
    V t0[N];
    V te[N];
    for (int i = 0; i < N; ++i)
    {
      t0[i] = hn::NegMulAdd(s0, reach.U[i], row[i]);
      te[i] = hn::NegMulAdd(se, reach.U[i], Const(this->Setup.LatticeSteps[i][0]));
    }
    const V inverse = Inverse(se);
    const V middle = hn::Neg(hn::Mul(s0, inverse));
    const V half =
      hn::Abs(hn::Mul(hn::Add(reach.Length, Const(this->Setup.JitterRadius)), inverse));
    low = hn::Max(low, hn::Sub(middle, half));
    high = hn::Min(high, hn::Add(middle, half));
    for (int round = 0; round < (this->Setup.Curved ? 2 : 1); ++round)
    {
      this->CutByTube(reach, s0, se, t0, te, low, high);
    }
    low = hn::Sub(low, reach.RowSpread);
    high = hn::Add(high, reach.RowSpread);
  }

  /// What a tube around the parabola leaves of [low, high], whose s bound its sag and its width.
  WALK_INLINE void CutByTube(
    const Reach<N>& reach, V s0, V se, const V (&t0)[N], const V (&te)[N], V& low, V& high) const
  {
    const V radius = Const(this->Setup.JitterRadius);
    const V first = hn::MulAdd(low, se, s0);
    const V last = hn::MulAdd(high, se, s0);
    const V most = hn::Max(hn::Abs(first), hn::Abs(last));
    const V least = hn::IfThenElseZero(
      hn::Ge(hn::Mul(first, last), hn::Zero(DF())), hn::Min(hn::Abs(first), hn::Abs(last)));
    V width = GetTaper(hn::Sub(least, hn::Add(radius, reach.AlongReach)), reach.InverseLength,
      reach.HalfWidth, reach.Tapers);
    width = hn::Add(
      width, hn::Add(Quadratic(reach.Across, hn::Add(most, radius)), this->GetLooseness(reach)));
    V sag = hn::Zero(DF());
    if (this->Setup.Curved)
    {
      const V quarter = Const(0.25f);
      const V most2 = hn::Mul(most, most);
      const V least2 = hn::Mul(least, least);
      sag = hn::Mul(quarter, hn::Add(most2, least2));
      width = hn::MulAdd(hn::Mul(quarter, hn::Sub(most2, least2)), reach.BendLength, width);
    }
    // |t0 + x te - sag bend| < width.
    V A = hn::Zero(DF());
    V B = hn::Zero(DF());
    V C = hn::Neg(hn::Mul(width, hn::Max(width, hn::Zero(DF()))));
    for (int i = 0; i < N; ++i)
    {
      const V t = hn::NegMulAdd(sag, reach.Bend[i], t0[i]);
      A = hn::MulAdd(te[i], te[i], A);
      B = hn::MulAdd(t, te[i], B);
      C = hn::MulAdd(t, t, C);
    }
    // A row along the flow: what the clamped coefficient adds must not count.
    const V clamped = hn::Max(A, Const(1e-6f));
    C = hn::NegMulAdd(hn::Sub(clamped, A), hn::Max(hn::Mul(low, low), hn::Mul(high, high)), C);
    A = clamped;
    const V discriminant = hn::NegMulAdd(A, C, hn::Mul(B, B));
    const V inverseA = hn::Div(Const(1.0f), A);
    const V root = hn::Mul(hn::Sqrt(hn::Max(discriminant, hn::Zero(DF()))), inverseA);
    const V center = hn::Neg(hn::Mul(B, inverseA));
    const V slack = Const(1e-3f);
    low = hn::Max(low, hn::Sub(hn::Sub(center, root), slack));
    high = hn::Min(high, hn::Add(hn::Add(center, root), slack));
    high = hn::IfThenElse(hn::Lt(discriminant, hn::Zero(DF())), Const(-1e9f), high);
  }

  // ---- samples apart ----------------------------------------------------------------------------

  /// Every sample of a register goes along the same rows, counted from its own cell, by itself.
  HWY_NOINLINE void AddApart(std::size_t r)
  {
    Reach<N> reach;
    this->SetApart(reach, r);
    const Sample<N> sample(this->Setup, this->Block, this->First[r], this->Cell);
    const IndexAxis axisX = this->GetIndexAxis(reach, 0);
    const IndexAxis axisY = this->GetIndexAxis(reach, 1);
    const V length = hn::Add(reach.Length, Const(this->Setup.JitterRadius));
    V first;
    V last;
    if constexpr (N == 2)
    {
      this->GetRange(reach, 1, axisY, hn::Neg(length), length, first, last);
      this->AddRowsApart(reach, axisX, r, sample, first, last, 0);
    }
    else
    {
      const IndexAxis axisZ = this->GetIndexAxis(reach, 2);
      this->GetRange(reach, 2, axisZ, hn::Neg(length), length, first, last);
      const int lastZ = ToCorner(GreatestLane(last));
      for (int z = ToCorner(LeastLane(first)); z <= lastZ; ++z)
      {
        V low = hn::Neg(length);
        V high = length;
        if (this->Params.AnisotropicWeight)
        {
          this->Narrow(reach, 2, axisZ, Const(static_cast<float>(z)), low, high);
        }
        this->GetRange(reach, 1, axisY, low, high, first, last);
        this->AddRowsApart(reach, axisX, r, sample, first, last, z);
      }
    }
  }

  /// The corners of the rows from the least of `first` to the greatest of `last`.
  WALK_INLINE void AddRowsApart(const Reach<N>& reach, const IndexAxis& axisX, std::size_t r,
    const Sample<N>& sample, V first, V last, int z)
  {
    const auto none = hn::Gt(first, last);
    const int lastY = ToCorner(GreatestLane(hn::IfThenElse(none, Const(-1e9f), last)));
    for (int y = ToCorner(LeastLane(hn::IfThenElse(none, Const(1e9f), first))); y <= lastY; ++y)
    {
      V low = axisX.BoxLow;
      V high = axisX.BoxHigh;
      if (this->Params.AnisotropicWeight)
      {
        this->CutRows(reach, Const(static_cast<float>(y)), Const(static_cast<float>(z)), low, high);
      }
      const VI begin = ToCorners(hn::Ceil(low));
      const VI steps = hn::Sub(ToCorners(hn::Floor(high)), begin);
      const auto most = static_cast<int>(GreatestLane(hn::ConvertTo(DF(), steps)));
      for (int step = 0; step <= most; ++step)
      {
        // A sample that has no corner here any more is too far from this one.
        VI corner[N];
        corner[0] = hn::Add(begin, hn::Set(DI(), step));
        corner[1] = hn::Set(DI(), y);
        if constexpr (N == 3)
        {
          corner[2] = hn::Set(DI(), z);
        }
        V offset[N];
        for (int axis = 0; axis < N; ++axis)
        {
          offset[axis] = hn::ConvertTo(DF(), corner[axis]);
        }
        Corner<N> described = this->Describe(offset, this->HashCorners(corner));
        described.RowWindow = this->GetRowWindow(sample, offset);
        for (int axis = 1; axis < N; ++axis)
        {
          described.FromRow[axis] = GetDistance(sample, offset[axis], axis);
        }
        this->WithKind([&](auto curved, auto normalize) HWY_ATTR
          { this->template AddSurflet<curved(), normalize()>(sample, described, this->Total[r]); });
        this->Visited += this->Count[r];
      }
    }
  }

  // ---- listed corners ---------------------------------------------------------------------------

  WALK_INLINE VU HashCorners(const VI (&corner)[N]) const
  {
    VU hash = hn::Set(DU(), this->Octave.Seed);
    for (int axis = 0; axis < N; ++axis)
    {
      VU index = hn::Add(this->Cell[axis], hn::BitCast(DU(), corner[axis]));
      if (this->Octave.Period[axis] > 0)
      {
        index = WrapIndex(index, this->Octave.Period[axis]);
      }
      hash = hn::Xor(hash, HashOneAxis(index, axis));
    }
    return HashJoinAxes(hash);
  }

  WALK_INLINE V GetJitter(VU hash, int axis) const
  {
    return hn::Sub(HashToUnit(HashStream(hash, 3 + axis)), Const(this->Setup.JitterDown));
  }

  WALK_INLINE bool IsJittered() const { return Variant && this->Setup.JitterRadius > 0.0f; }

  WALK_INLINE Corner<N> Describe(const V (&offset)[N], VU hash) const
  {
    Corner<N> corner;
    if (!Variant ||
      (this->Params.Surflet == Basis::Gradient && this->Params.Gradients == GradientSet::Uniform))
    {
      UniformGradient(hash, corner.Gradient);
    }
    else if (this->Params.Surflet == Basis::Gradient)
    {
      PerlinGradient<N>(hash, corner.Gradient);
    }
    else
    {
      // The value.
      std::fill(corner.Gradient, corner.Gradient + N, hn::Mul(HashToSigned(hash), Const(2.0f)));
    }
    for (int axis = 0; axis < N; ++axis)
    {
      corner.Offset[axis] = offset[axis];
      if (this->IsJittered())
      {
        corner.Jitter[axis] = this->GetJitter(hash, axis);
      }
    }
    if constexpr (Variant)
    {
      corner.Amplitude = Const(1.0f);
      if (this->Params.Motion)
      {
        const V clock = hn::Add(HashToUnit(HashStream(hash, 1)),
          Const(static_cast<float>(this->Params.Phase - std::floor(this->Params.Phase))));
        const V tau = hn::Sub(clock, hn::Floor(clock));
        const V centered = hn::Sub(tau, Const(0.5f));
        corner.Travel = hn::Mul(centered, Const(static_cast<float>(this->Params.Speed)));
        const V wave = CosPi(centered); // sin(π τ)
        corner.Amplitude = hn::Mul(hn::Mul(wave, wave), Const(1.6329931619f));
      }
      if (this->Params.Surflet == Basis::Streaks)
      {
        const auto on = hn::Lt(HashToUnit(HashStream(hash, 2)),
          Const(static_cast<float>(this->Params.GetStreakProbability())));
        corner.Amplitude = hn::IfThenElseZero(on, corner.Amplitude);
      }
    }
    return corner;
  }

  /// Writes a register of corners to the list.
  WALK_INLINE void Put(const Corner<N>& corner, CornerList<N>& list, std::size_t i) const
  {
    StoreAll(corner.Offset, list.Offset, i);
    StoreAll(corner.Gradient, list.Gradient, i);
    if (this->IsJittered())
    {
      StoreAll(corner.Jitter, list.Jitter, i);
    }
    if constexpr (Variant)
    {
      hn::Store(corner.Travel, DF(), list.Travel + i);
      hn::Store(corner.Amplitude, DF(), list.Amplitude + i);
    }
  }

  /// Adds those corners of the list that reach the samples of a span to their sums.
  HWY_NOINLINE void AddCorners(const Span<N>& span, CornerList<N>& list)
  {
    // What stands behind the end of the list must at least be an index.
    for (int axis = 0; axis < N; ++axis)
    {
      for (std::size_t i = list.Count; i % Lanes != 0; ++i)
      {
        list.Index[axis][i] = 0;
      }
    }
    for (std::size_t i = 0; i < list.Count; i += Lanes)
    {
      VI corner[N];
      V offset[N];
      for (int axis = 0; axis < N; ++axis)
      {
        corner[axis] = hn::Load(DI(), list.Index[axis] + i);
        offset[axis] = hn::ConvertTo(DF(), corner[axis]);
      }
      this->Put(this->Describe(offset, this->HashCorners(corner)), list, i);
    }
    std::uint64_t reaching[TileRegisters];
    this->SetReaching(span, list, reaching);
    for (std::size_t r = span.Begin; r < span.End; ++r)
    {
      const std::uint64_t bits = reaching[r];
      this->Visited += this->Count[r] * hwy::PopCount(bits);
      const Sample<N> sample(this->Setup, this->Block, this->First[r], this->Cell);
      this->SetFromRow(sample, list);
      this->WithKind([&](auto curved, auto normalize) HWY_ATTR
        { this->template AddSurflets<curved(), normalize()>(sample, list, bits, this->Total[r]); });
    }
  }

  /// Calls `work` with what surflets take into account, as types: bends, and which sums are wanted.
  template <class Work>
  WALK_INLINE void WithKind(Work&& work) const
  {
#ifdef STEERABLENOISE_INSTRUMENTED
    constexpr std::true_type straight;
#else
    constexpr std::bool_constant<Variant> straight; // there variants are not worth more code
#endif
    this->Setup.Curved ? this->WithSums(work, std::true_type()) : this->WithSums(work, straight);
  }

  template <class Work, class Curved>
  WALK_INLINE void WithSums(Work&& work, Curved curved) const
  {
    switch (this->Params.Normalize)
    {
      case Normalization::UnitVariance:
        return work(curved, std::integral_constant<Normalization, Normalization::UnitVariance>());
      case Normalization::WeightSum:
        return work(curved, std::integral_constant<Normalization, Normalization::WeightSum>());
      case Normalization::None:
      default:
        return work(curved, std::integral_constant<Normalization, Normalization::None>());
    }
  }

  static WALK_INLINE std::uint64_t ToBits(hn::Mask<DF> mask)
  {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(DF(), mask, bytes);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < (Lanes + 7) / 8; ++i)
    {
      bits |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
    }
    return bits;
  }

  /// How a span sees corners at these indices, displaced by `jitter` and, at most, by as much as `loose`.
  WALK_INLINE View<N> GetView(
    const Span<N>& span, const V (&corner)[N], const V (&jitter)[N], float loose) const
  {
    const Group<N>& group = span.Whole;
    View<N> view;
    V v[N];
    for (int axis = 0; axis < N; ++axis)
    {
      v[axis] = hn::Sub(corner[axis], group.Place[axis]);
    }
    if constexpr (Variant)
    {
      V index[N];
      std::copy(v, v + N, index);
      this->ToPlace(index, v);
      for (int axis = 0; axis < N && this->IsJittered(); ++axis)
      {
        v[axis] = hn::Add(v[axis], jitter[axis]);
      }
    }
    const V s = Dot(v, group.U);
    ToAcross<N>(v, group.U, view.T);
    const V sag = hn::Mul(hn::Mul(s, s), Const(0.5f));
    V steps = hn::Zero(DF());
    for (int k = 0; k < 2; ++k)
    {
      // v UStep is that of the part across.
      const V sStep = hn::Sub(Dot(view.T, span.UStep[k]), group.AlongStep[k]);
      steps = hn::Add(steps, hn::Abs(sStep));
      for (int axis = 0; axis < AxesAcross<N>; ++axis)
      {
        view.Step[k][axis] = hn::MulAdd(s, span.UStep[k][axis], span.PlaceStep[k][axis]);
        if (this->Setup.Curved)
        {
          view.Step[k][axis] = hn::MulAdd(sag, span.BendStep[k][axis], view.Step[k][axis]);
          view.Step[k][axis] = hn::MulAdd(hn::Mul(s, sStep), span.Bend[axis], view.Step[k][axis]);
        }
      }
    }
    for (int axis = 0; axis < AxesAcross<N> && this->Setup.Curved; ++axis)
    {
      view.T[axis] = hn::NegMulAdd(sag, span.Bend[axis], view.T[axis]);
    }
    const V distance = hn::Abs(s);
    const V shortest = hn::Sub(
      distance, hn::Add(hn::Add(steps, group.AlongRest), Const(this->Surflet.Travel + loose)));
    view.Width = hn::Add(group.GetRest(hn::Add(distance, Const(loose)), steps),
      GetTaper(shortest, Const(1.0f / this->Surflet.HalfLength), Const(this->Surflet.HalfWidth),
        this->Surflet.Tapers));
    return view;
  }

  /// For each register of the span bits of the corners on the list that reach its samples.
  WALK_INLINE void SetReaching(
    const Span<N>& span, const CornerList<N>& list, std::uint64_t (&reaching)[TileRegisters]) const
  {
    const bool all = !this->Params.AnisotropicWeight;
    std::fill_n(reaching, TileRegisters, 0);
    for (std::size_t i = 0; i < list.Count; i += Lanes)
    {
      const auto listed = hn::FirstN(DF(), list.Count - i);
      V offset[N];
      V jitter[N];
      LoadAll(list.Offset, i, offset);
      LoadAll(list.Jitter, i, jitter);
      const View<N> view = this->GetView(span, offset, jitter, 0.0f);
      for (std::size_t r = span.Begin; r < span.End; ++r)
      {
        const V mu = Const(span.GetMu(r));
        V t[AxesAcross<N>];
        for (int axis = 0; axis < AxesAcross<N>; ++axis)
        {
          t[axis] = hn::NegMulAdd(mu, view.Step[1][axis], view.T[axis]);
        }
        const auto near = View<N>::IsNear(t, view.Step[0], view.Width);
        reaching[r] |= ToBits(all ? listed : hn::And(listed, near)) << i;
      }
    }
  }

  /// Takes corners off the list that reach no sample of the span, from where that was done before on.
  HWY_NOINLINE void Sift(const Span<N>& span, const Reach<N>& reach, CornerList<N>& list) const
  {
    if (!this->Params.AnisotropicWeight)
    {
      return;
    }
    // Jitter is not known yet.
    const V looseness = this->GetLooseness(reach);
    V middle[N];
    std::fill_n(middle, N, Const(this->Setup.JitterMiddle));
    std::size_t kept = list.Sifted;
    for (std::size_t i = list.Sifted; i < list.Count; i += Lanes)
    {
      V offset[N];
      for (int axis = 0; axis < N; ++axis)
      {
        offset[axis] = hn::ConvertTo(DF(), hn::LoadU(DI(), list.Index[axis] + i));
      }
      const View<N> view = this->GetView(span, offset, middle, this->Setup.JitterRadius);
      const V width =
        hn::Add(hn::Add(view.Width, looseness), hn::Sqrt(Dot(view.Step[1], view.Step[1])));
      const auto listed = hn::FirstN(DF(), list.Count - i);
      std::uint64_t bits = ToBits(hn::And(listed, View<N>::IsNear(view.T, view.Step[0], width)));
      for (; bits != 0; bits &= bits - 1, ++kept)
      {
        const std::size_t from = i + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
        for (auto& index : list.Index)
        {
          index[kept] = index[from];
        }
      }
    }
    list.Count = list.Sifted = kept;
  }

  /// Distance of a corner on an axis, in cells.
  static WALK_INLINE V GetDistance(const Sample<N>& sample, V offset, int axis)
  {
    return hn::Sub(hn::Sub(offset, sample.Shift[axis]), sample.Fraction[axis]);
  }

  /// Window of a corner on all axes but the first.
  WALK_INLINE V GetRowWindow(const Sample<N>& sample, const V (&offset)[N]) const
  {
    V window = Const(1.0f);
    for (int axis = 1; axis < N; ++axis)
    {
      const V v = GetDistance(sample, offset[axis], axis);
      window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v), this->InverseReach)));
    }
    return window;
  }

  /// Sees to what all lanes of the sample have in common, for a register of corners at a time.
  WALK_INLINE void SetFromRow(const Sample<N>& sample, CornerList<N>& list) const
  {
    if constexpr (Aligned)
    {
      for (std::size_t i = 0; i < list.Count; i += Lanes)
      {
        V offset[N];
        LoadAll(list.Offset, i, offset);
        hn::Store(this->GetRowWindow(sample, offset), DF(), list.RowWindow + i);
        for (int axis = 1; axis < N && N == 3; ++axis)
        {
          hn::Store(GetDistance(sample, offset[axis], axis), DF(), list.FromRow[axis] + i);
        }
      }
    }
  }

  /// Adds the corners whose bits are set.
  template <bool Curved, Normalization Normalize>
  HWY_NOINLINE void AddSurflets(
    const Sample<N>& sample, const CornerList<N>& list, std::uint64_t bits, Sums& total)
  {
    Sums sums = total;
    for (; bits != 0; bits &= bits - 1)
    {
      Corner<N> corner(list, hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
      if constexpr (!Aligned)
      {
        corner.RowWindow = this->GetRowWindow(sample, corner.Offset);
      }
      this->template AddSurflet<Curved, Normalize>(sample, corner, sums);
    }
    total = sums;
  }

  // ---- surflets ---------------------------------------------------------------------------------

  /// The window of variants.
  WALK_INLINE V GetWindow(const V (&v)[N]) const
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

  /// `Curved`: bends count. Sums that `Normalize` has no use for are left out.
  template <bool Curved, Normalization Normalize>
  WALK_INLINE void AddSurflet(const Sample<N>& sample, const Corner<N>& corner, Sums& sums) const
  {
    constexpr bool squares = Normalize == Normalization::UnitVariance;
    V offset[N];
    V v[N];
    for (int axis = 0; axis < N; ++axis)
    {
      offset[axis] = hn::Sub(corner.Offset[axis], sample.Shift[axis]);
      v[axis] = Aligned && N == 3 && axis > 0 ? corner.FromRow[axis]
                                              : hn::Sub(offset[axis], sample.Fraction[axis]);
    }
    if constexpr (Variant)
    {
      V index[N];
      std::copy(v, v + N, index);
      this->ToPlace(index, v);
      for (int axis = 0; axis < N && this->IsJittered(); ++axis)
      {
        v[axis] = hn::Add(v[axis], corner.Jitter[axis]);
      }
    }
    // Along the flow and across it: q = k s² + b t², g G v', and |G v'|².
    V s;
    V sigma; // √k s, of variants
    V ks;
    V across2;
    V q;
    V slope;
    V slope2;
    const V(&g)[N] = corner.Gradient;
    if constexpr (N == 2)
    {
      V t;
      if constexpr (Variant)
      {
        s = Dot(v, sample.U);
        t = Dot(v, sample.Normal);
      }
      else
      {
        // n . v of a far corner is a small difference of large products. Of the high parts of n and the
        // fraction products and, up to 256 cells, the difference are exact. Where streamlines bend s² is
        // a part of it, so s is as precise there.
        const V(&high)[2] = sample.HighNormal;
        const V(&low)[2] = sample.LowNormal;
        if constexpr (Curved || !HWY_NATIVE_FMA) // without fused products this much is needed anyway
        {
          s = hn::Add(hn::MulSub(high[1], offset[0], hn::Mul(high[0], offset[1])),
            hn::MulSub(low[1], offset[0], hn::MulAdd(low[0], offset[1], sample.AlongFraction)));
        }
        else
        {
          s = hn::MulAdd(
            sample.U[0], offset[0], hn::MulSub(sample.U[1], offset[1], sample.AlongFraction));
        }
        t = hn::Sub(
          hn::MulAdd(high[0], offset[0], hn::Mul(high[1], offset[1])), sample.HighAcross);
        if constexpr (Curved)
        {
          // Before anything is rounded: of the sag, many cells, little is left.
          t = hn::NegMulAdd(hn::Mul(s, s), sample.HalfBend, t);
        }
        t = hn::Add(t, hn::MulAdd(low[0], offset[0], hn::MulSub(low[1], offset[1], sample.LowAcross)));
      }
      if constexpr (Curved && Variant)
      {
        t = hn::NegMulAdd(hn::Mul(s, s), sample.HalfBend, t);
      }
      this->Travel(sample, corner, s, sigma);
      ks = hn::Mul(sample.Along, s);
      const V bt = hn::Mul(sample.Across, t);
      across2 = hn::Mul(bt, t);
      q = hn::MulAdd(ks, s, across2);
      slope = hn::MulAdd(ks, Dot(sample.U, g), hn::Mul(bt, Dot(sample.Normal, g)));
      if constexpr (squares)
      {
        slope2 = hn::MulAdd(ks, ks, hn::Mul(bt, bt));
      }
      if (Variant && !this->Params.MetricInProjection)
      {
        slope = hn::MulAdd(s, Dot(sample.U, g), hn::Mul(t, Dot(sample.Normal, g)));
        slope2 = hn::MulAdd(s, s, hn::Mul(t, t));
      }
    }
    else
    {
      s = Dot(v, sample.U);
      V t[N];
      const V sag = hn::Mul(hn::Mul(Const(0.5f), s), s);
      if (Curved && !Variant && !this->Setup.Biaxial)
      {
        // As in the plane: the offset is exact, and of the sag, many cells, little is left.
        // (With axes of its own the parts are small already, and near corners would lose by it.)
        for (int i = 0; i < N; ++i)
        {
          t[i] = hn::NegMulAdd(sag, sample.Bend[i], offset[i]);
          t[i] = hn::Sub(hn::NegMulAdd(s, sample.U[i], t[i]), sample.Fraction[i]);
        }
      }
      else
      {
        for (int i = 0; i < N; ++i)
        {
          t[i] = hn::NegMulAdd(s, sample.U[i], v[i]);
          t[i] = Curved ? hn::NegMulAdd(sag, sample.Bend[i], t[i]) : t[i];
        }
      }
      const V unmoved = s;
      this->Travel(sample, corner, s, sigma);
      ks = hn::Mul(sample.Along, s);
      if (this->Setup.Biaxial)
      {
        // On axes of its own each part keeps its precision.
        const V second = hn::NegMulAdd(unmoved, sample.Rest[0], Dot(t, sample.M));
        const V third = hn::NegMulAdd(unmoved, sample.Rest[1], Dot(t, sample.ThirdAxis));
        const V es = hn::Mul(sample.Second, second);
        const V bt = hn::Mul(sample.Across, third);
        across2 = hn::MulAdd(bt, third, hn::Mul(es, second));
        slope = hn::MulAdd(ks, Dot(sample.U, g),
          hn::MulAdd(bt, Dot(sample.ThirdAxis, g), hn::Mul(es, Dot(sample.M, g))));
        if constexpr (squares)
        {
          slope2 = hn::MulAdd(ks, ks, hn::MulAdd(bt, bt, hn::Mul(es, es)));
        }
      }
      else
      {
        across2 = hn::Mul(sample.Across, Dot(t, t));
        // s is rounded and u has not quite length 1: what t still has of u is large beside it. It does
        // not change t² but g . t.
        const V rest = Dot(t, sample.U);
        slope = hn::MulAdd(hn::NegMulAdd(sample.Across, rest, ks), Dot(sample.U, g),
          hn::Mul(sample.Across, Dot(t, g)));
        if constexpr (squares)
        {
          slope2 = hn::MulAdd(ks, ks, hn::Mul(sample.Across, across2));
        }
      }
      q = hn::MulAdd(ks, s, across2);
      if (Variant && !this->Params.MetricInProjection)
      {
        slope = hn::MulAdd(s, Dot(sample.U, g), Dot(t, g));
        slope2 = hn::MulAdd(s, s, Dot(t, t));
      }
    }

    V weight;
    V amplitude;
    if constexpr (Variant)
    {
      weight = this->GetWindow(v);
      if (this->Params.Surflet == Basis::Streaks)
      {
        const V across = hn::Sqrt(hn::Max(across2, hn::Zero(DF())));
        weight = hn::Mul(hn::Mul(weight, sample.Sense),
          hn::Mul(StreakProfile(hn::Neg(sigma)), FadeOf(this->Params.Interpolant, across)));
      }
      else if (this->Params.AnisotropicWeight)
      {
        weight = hn::Mul(weight, FadeOf(this->Params.Interpolant, q));
      }
      amplitude = hn::Mul(corner.Amplitude, weight);
      if (this->Params.Surflet != Basis::Gradient)
      {
        slope = this->Params.Surflet == Basis::Value ? g[0] : Const(1.0f);
        slope2 = Const(1.0f);
      }
    }
    else
    {
      const V away = hn::Mul(hn::Abs(v[0]), this->InverseReach);
      amplitude = weight = hn::Mul(corner.RowWindow, QuinticFades(away, q));
    }
    sums.Noise = hn::MulAdd(amplitude, slope, sums.Noise);
    if constexpr (Normalize == Normalization::WeightSum)
    {
      sums.Weight = hn::Add(sums.Weight, weight);
    }
    if constexpr (squares)
    {
      sums.Variance = hn::MulAdd(hn::Mul(weight, weight), slope2, sums.Variance);
    }
  }

  /// Moves the surflet of a corner on its way along the flow, and gives s in half-lengths.
  WALK_INLINE void Travel(const Sample<N>& sample, const Corner<N>& corner, V& s, V& sigma) const
  {
    if constexpr (Variant)
    {
      sigma = hn::Mul(sample.RootAlong, s);
      if (this->Params.Motion)
      {
        sigma = hn::MulAdd(corner.Travel, sample.Sense, sigma);
        s = hn::Div(sigma, sample.RootAlong);
      }
    }
  }

  /// Samples that are farther apart than this, as their surflets see it, do not share a list.
  static constexpr float LargestSpread = 1.5f;

  /// Nor do samples this many cells from their middle: distances of corners must keep their precision.
  static constexpr float LargestExtent = 16.0f;

  /// A little more than needed: every sample must see all its own corners, whatever rounding does.
  static constexpr float Slack = 1e-3f;

  const NoiseSetup& Setup;
  const NoiseParameters& Params;
  const OctaveSetup& Octave;
  const MetricBlock& Block;
  /// Eigenvalues of this octave.
  const float* Along;
  const float* Across;
  const float* Second;
  V InverseReach;
  /// From 0 at the first lane to 1 at the last.
  V LaneStep;
  std::size_t First[TileRegisters];
  std::size_t Count[TileRegisters];
  std::uint64_t Visited = 0;
  Lines<N> GroupLines;
  Extent Surflet;
  /// The cells that offsets count from.
  VU Cell[N];
  Sums Total[TileRegisters];
};
