// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The sum over corners for any Quality and any variant (see SteerableNoiseSimd-inl.h, which includes
 * this for each SIMD level).
 *
 * Neighbouring samples are reached by the same corners. So they are listed once for a few registers of
 * samples, with a register of corners at a time: first the lattice rows, then the corners on them, then
 * those that really are in reach with their gradients. After that the samples take them one by one.
 * Samples that differ too much, or lie apart, have rows in common only and go to their own corners.
 */

/// Where the samples of a register are in the lattice of an octave: cells as the hash takes them, and
/// fractions from their corners.
template <int N>
struct Places
{
  VU Cell[N];
  V Fraction[N];
};

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

/// Registers of samples that share their lists where they can.
constexpr std::size_t TileRegisters = 2;
constexpr std::size_t TileSamples = TileRegisters * Lanes;

/// Corners of a list, or lattice rows, that go through the stages together: a bit for each.
constexpr std::size_t ListSize = 64;

/// Corners that may be in reach, and what samples need to know of them.
template <int N>
struct CornerList
{
  std::size_t Count = 0;
  /// From the cell that the group counts from.
  HWY_ALIGN std::int32_t Index[N][ListSize];
  HWY_ALIGN float Offset[N][ListSize];
  HWY_ALIGN float Gradient[N][ListSize];
  /// Offset and window on the axes that all samples of an image row share.
  HWY_ALIGN float FromRow[N][ListSize];
  HWY_ALIGN float RowWindow[ListSize];
  /// Of variants: displacement of the corner, (τ - 1/2) Speed, and what the surflet is multiplied by.
  HWY_ALIGN float Jitter[N][ListSize];
  HWY_ALIGN float Travel[ListSize];
  HWY_ALIGN float Amplitude[ListSize];
};

/// The same of a corner for the lanes of a register.
template <int N>
struct Corner
{
  V Offset[N];
  V Gradient[N];
  V FromRow[N];
  V RowWindow;
  V Jitter[N];
  V Travel;
  V Amplitude;

  WALK_INLINE Corner() {}
  /// One corner of a list for all lanes.
  WALK_INLINE Corner(const CornerList<N>& list, std::size_t i)
    : RowWindow(Const(list.RowWindow[i]))
    , Travel(Const(list.Travel[i]))
    , Amplitude(Const(list.Amplitude[i]))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Offset[axis] = Const(list.Offset[axis][i]);
      this->Gradient[axis] = Const(list.Gradient[axis][i]);
      this->FromRow[axis] = Const(list.FromRow[axis][i]);
      this->Jitter[axis] = Const(list.Jitter[axis][i]);
    }
  }
};

/**
 * The samples that share a list. They change almost linearly from the first to the last, so sample λ in
 * [-1, 1] is at Place + λ PlaceStep, and so on, up to small rests. Distances s along and t across are
 * from the bent axis of the middle.
 */
template <int N>
struct Group
{
  /// Registers [Begin, End) of the tile.
  std::size_t Begin;
  std::size_t End;
  float LambdaStep; // between neighbours
  float Place[N];
  float PlaceStep[N]; // as a distance, not in indices of the lattice
  float U[N];
  float UStep[N];
  float Bend[N];
  float BendStep[N];
  float BendLength;
  /// Half axes of the surflet: where its fade ends.
  float HalfLength;
  float HalfWidth;
  float InverseLength;
  /// A streak has the same width everywhere.
  bool Tapers;
  /// Change of s with λ that comes from the places.
  float AlongStep;
  /// Largest distance between places, and that along a lattice row.
  float Spread;
  float RowSpread;
  /// What s can be off its linear change, surflet's travel included, and off that of the middle, where
  /// a row takes the change along it into account.
  float AlongRest;
  float AlongReach;
  /// The same for t: Rest[0] + Rest[1] |s| + Rest[2] s², and Across[...] likewise.
  float Rest[3];
  float Across[3];

  /**
   * Bounds, from what places, directions and bends are off their linear change. Sample λ sees a corner
   * at v - λ PlaceStep, along u + λ UStep, with the bend + λ BendStep, each up to its rest. Across U,
   * which only takes away, its t is therefore t - λ (PlaceStep + s UStep + s²/2 BendStep + s sStep Bend)
   * up to Rest, where s + λ sStep is its s up to AlongRest and sStep = v UStep - AlongStep.
   */
  WALK_INLINE void SetBounds(
    float placeRest, float directionRest, float bendRest, float travel, bool oblique)
  {
    float place2 = 0.0f;
    float turn2 = 0.0f;
    float change2 = 0.0f;
    this->AlongStep = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      place2 += this->PlaceStep[axis] * this->PlaceStep[axis];
      turn2 += this->UStep[axis] * this->UStep[axis];
      change2 += this->BendStep[axis] * this->BendStep[axis];
      this->AlongStep += this->PlaceStep[axis] * this->U[axis];
    }
    this->RowSpread = oblique ? 0.0f : std::abs(this->PlaceStep[0]);
    const float places = std::sqrt(place2);
    const float fromRow = std::sqrt(std::max(0.0f, place2 - this->RowSpread * this->RowSpread));
    const float turn = std::sqrt(turn2);
    const float change = std::sqrt(change2);
    const float kappa = this->BendLength + change + bendRest;
    // Largest distances of a corner in reach, unbent; and what follows from them.
    const float mostAlong = this->HalfLength + travel;
    const float mostAcross = this->HalfWidth + 0.5f * mostAlong * mostAlong * kappa;
    const float mostTurn = turn * (mostAcross + turn * mostAlong);
    const float mostStep = std::abs(this->AlongStep) + mostTurn;
    const float alongRest =
      places * turn + directionRest * (mostAlong + mostAcross + places) + placeRest;
    const float both = mostStep + alongRest;
    this->Spread = places + placeRest;
    this->AlongRest = alongRest + travel;
    this->AlongReach = fromRow + mostTurn + alongRest + travel;
    this->Rest[0] = placeRest + both * (turn + 0.5f * kappa * both);
    this->Rest[1] = directionRest + kappa * alongRest + mostStep * change;
    this->Rest[2] = 0.5f * bendRest;
    this->Across[0] = this->Rest[0] + fromRow;
    this->Across[1] = this->Rest[1] + turn + kappa * (fromRow + mostTurn);
    this->Across[2] = this->Rest[2] + 0.5f * change;
  }

  float GetLength() const { return this->HalfLength + this->AlongReach; }
  float GetLargestWidth() const
  {
    const float s = this->GetLength();
    return this->HalfWidth + this->Across[0] + s * (this->Across[1] + s * this->Across[2]);
  }
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

/// Where lattice rows are cut: the group's reach in all lanes, or that of a sample in each.
template <int N>
struct Reach
{
  V Place[N];
  V U[N];
  V Bend[N];
  V BendLength;
  V Length; // what can be ahead or behind included
  V HalfWidth;
  V LargestWidth;
  V InverseLength;
  V Spread;
  V RowSpread;
  V AlongReach;
  V Across[3];
  bool Tapers;

  WALK_INLINE Reach() {}
  WALK_INLINE explicit Reach(const Group<N>& group)
    : BendLength(Const(group.BendLength))
    , Length(Const(group.GetLength()))
    , HalfWidth(Const(group.HalfWidth))
    , LargestWidth(Const(group.GetLargestWidth()))
    , InverseLength(Const(group.InverseLength))
    , Spread(Const(group.Spread))
    , RowSpread(Const(group.RowSpread))
    , AlongReach(Const(group.AlongReach))
    , Tapers(group.Tapers)
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Place[axis] = Const(group.Place[axis]);
      this->U[axis] = Const(group.U[axis]);
      this->Bend[axis] = Const(group.Bend[axis]);
    }
    for (int i = 0; i < 3; ++i)
    {
      this->Across[i] = Const(group.Across[i]);
    }
  }
};

/// `Aligned`: the samples have their places on all axes but the first in common.
template <int N, bool Variant, bool Aligned>
class Walk
{
public:
  WALK_INLINE Walk(const NoiseSetup& setup, const OctaveSetup& octave)
    : Setup(setup)
    , Params(setup.Parameters)
    , Octave(octave)
    , InverseReach(Const(1.0f / (Params.Quality + 1)))
    , GradientPower(Const(static_cast<float>(GradientVariance(Params.Gradients, N))))
  {
  }

  /// Takes register `r` of the tile from sample `i` of the block.
  WALK_INLINE void SetRegister(
    std::size_t r, const MetricBlock& block, std::size_t i, const Places<N>& places)
  {
    this->F[r] = Frame<N>(this->Setup, block, i, this->Octave.CellSize);
    this->P[r] = places;
    if constexpr (N == 2)
    {
      const Frame<N>& frame = this->F[r];
      const V product = hn::Mul(frame.U[1], places.Fraction[0]);
      this->CrossFraction[r] = hn::Sub(hn::MulSub(frame.U[0], places.Fraction[1], product),
        hn::MulSub(frame.U[1], places.Fraction[0], product));
    }
    this->Total[r] = Sums();
  }

  /// Sums up the first `count` samples of the tile; returns how many corners they visited.
  WALK_INLINE std::uint64_t Evaluate(std::size_t count)
  {
    this->Count = count;
    this->Visited = 0;
    this->AddSpan(0, (count + Lanes - 1) / Lanes);
    return this->Visited;
  }

  WALK_INLINE V GetNoise(std::size_t r) const { return Normalized(this->Setup, this->Total[r]); }

private:
  static WALK_INLINE float LaneOf(V v, std::size_t lane)
  {
    HWY_ALIGN float lanes[Lanes];
    hn::Store(v, DF(), lanes);
    return lanes[lane];
  }

  // ---- the group --------------------------------------------------------------------------------

  /// The samples of registers [begin, end): together if they are alike, else half by half.
  HWY_NOINLINE void AddSpan(std::size_t begin, std::size_t end)
  {
    Group<N> group;
    group.Begin = begin;
    group.End = end;
    const auto samples = static_cast<float>(Lanes * (end - begin));
    group.LambdaStep = 2.0f / std::max(1.0f, samples - 1.0f);
    if (this->SetGroup(group))
    {
      this->AddGroup(group);
    }
    else if (end - begin > 1)
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

  /// Samples of a register.
  WALK_INLINE std::size_t GetCount(std::size_t r) const
  {
    return std::min(Lanes, this->Count - r * Lanes);
  }

  WALK_INLINE V GetLeastAcross(std::size_t r) const
  {
    const Frame<N>& frame = this->F[r];
    return this->Setup.Biaxial ? hn::Min(frame.Across, frame.Second) : frame.Across;
  }

  WALK_INLINE bool IsStreaks() const { return Variant && this->Params.Surflet == Basis::Streaks; }

  /// How far surflets travel to either side, in half-lengths.
  WALK_INLINE float GetTravel() const
  {
    return Variant && this->Params.Motion ? 0.5f * std::abs(static_cast<float>(this->Params.Speed))
                                          : 0.0f;
  }

  /// Half axes of the surflet from the least eigenvalues.
  WALK_INLINE void SetAxes(Group<N>& group, float along, float across) const
  {
    const float support = this->Setup.Support;
    const bool streaks = this->IsStreaks();
    group.HalfLength = (streaks ? 1.0f : std::sqrt(support)) / std::sqrt(along) + Slack;
    group.HalfWidth = (streaks ? support : std::sqrt(support)) / std::sqrt(across) + Slack;
    group.InverseLength = 1.0f / group.HalfLength;
    group.Tapers = !streaks;
  }

  /// The samples of a register, each with its own cell, place and reach.
  WALK_INLINE void SetApart(Reach<N>& reach, std::size_t r)
  {
    const Frame<N>& frame = this->F[r];
    V bend2 = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      this->Cell[axis] = this->P[r].Cell[axis];
      this->Shift[r][axis] = hn::Zero(DF());
      reach.Place[axis] = this->P[r].Fraction[axis];
      reach.U[axis] = frame.U[axis];
      reach.Bend[axis] = frame.Bend[axis];
      bend2 = hn::MulAdd(frame.Bend[axis], frame.Bend[axis], bend2);
    }
    reach.BendLength = hn::Sqrt(bend2);
    const float support = this->Setup.Support;
    const bool streaks = this->IsStreaks();
    const V one = Const(1.0f);
    const V rootInverse = hn::Div(one, hn::Sqrt(frame.Along));
    const V length =
      hn::MulAdd(Const(streaks ? 1.0f : std::sqrt(support)), rootInverse, Const(Slack));
    reach.HalfWidth = hn::Add(
      hn::Div(Const(streaks ? support : std::sqrt(support)), hn::Sqrt(this->GetLeastAcross(r))),
      Const(Slack));
    reach.LargestWidth = reach.HalfWidth;
    reach.InverseLength = hn::Div(one, length);
    reach.AlongReach = hn::Mul(rootInverse, Const(this->GetTravel()));
    reach.Length = hn::Add(length, reach.AlongReach);
    reach.Spread = reach.RowSpread = hn::Zero(DF());
    reach.Across[0] = reach.Across[1] = reach.Across[2] = hn::Zero(DF());
    reach.Tapers = !streaks;
  }

  /// Splits what `get` gives for a register into its linear change and the squares of the rest.
  template <class Get>
  static WALK_INLINE void SplitLinear(
    const Group<N>& group, float& middle, float& step, V (&rest2)[TileRegisters], Get&& get)
  {
    const float first = hn::GetLane(get(group.Begin));
    const float last = LaneOf(get(group.End - 1), Lanes - 1);
    middle = 0.5f * (first + last);
    step = 0.5f * (last - first);
    for (std::size_t r = group.Begin; r < group.End; ++r)
    {
      const V index = Ramp(static_cast<float>(Lanes * (r - group.Begin)));
      const V linear = hn::MulAdd(index, Const(step * group.LambdaStep), Const(first));
      const V rest = hn::Sub(get(r), linear);
      rest2[r] = hn::MulAdd(rest, rest, rest2[r]);
    }
  }

  /// Root of the largest of the squares.
  static WALK_INLINE float GetLargest(const Group<N>& group, const V (&squares)[TileRegisters])
  {
    V most = squares[group.Begin];
    for (std::size_t r = group.Begin + 1; r < group.End; ++r)
    {
      most = hn::Max(most, squares[r]);
    }
    return std::sqrt(GreatestLane(most));
  }

  /// False if the samples had better not share a list.
  HWY_NOINLINE bool SetGroup(Group<N>& group)
  {
    V along = this->F[group.Begin].Along;
    V across = this->GetLeastAcross(group.Begin);
    V sign[TileRegisters];
    V place2[TileRegisters];
    V direction2[TileRegisters];
    V bend2[TileRegisters];
    for (int axis = 0; axis < N; ++axis)
    {
      this->Cell[axis] = hn::Set(DU(), hn::GetLane(this->P[group.Begin].Cell[axis]));
    }
    for (std::size_t r = group.Begin; r < group.End; ++r)
    {
      const Frame<N>& frame = this->F[r];
      along = hn::Min(along, frame.Along);
      across = hn::Min(across, this->GetLeastAcross(r));
      // u and -u are the same axis.
      V cosine = hn::Zero(DF());
      for (int axis = 0; axis < N; ++axis)
      {
        const float first = hn::GetLane(this->F[group.Begin].U[axis]);
        cosine = hn::MulAdd(frame.U[axis], Const(first), cosine);
        this->Shift[r][axis] = hn::Zero(DF());
        if (!Aligned || axis == 0)
        {
          this->Shift[r][axis] = hn::ConvertTo(
            DF(), hn::BitCast(DI(), hn::Sub(this->P[r].Cell[axis], this->Cell[axis])));
        }
      }
      sign[r] = hn::And(cosine, hn::BitCast(DF(), hn::Set(DU(), 0x80000000u)));
      place2[r] = direction2[r] = bend2[r] = hn::Zero(DF());
    }
    this->SetAxes(group, LeastLane(along), LeastLane(across));
    const float travel = this->GetTravel() / std::sqrt(LeastLane(along));
    for (int axis = 0; axis < N; ++axis)
    {
      SplitLinear(group, group.U[axis], group.UStep[axis], direction2,
        [&](std::size_t r) HWY_ATTR { return hn::Xor(this->F[r].U[axis], sign[r]); });
      group.Bend[axis] = group.BendStep[axis] = 0.0f;
      if (this->Setup.Curved)
      {
        SplitLinear(group, group.Bend[axis], group.BendStep[axis], bend2,
          [&](std::size_t r) HWY_ATTR { return this->F[r].Bend[axis]; });
      }
      if (Aligned && axis > 0)
      {
        group.Place[axis] = hn::GetLane(this->P[group.Begin].Fraction[axis]);
        group.PlaceStep[axis] = 0.0f;
      }
      else
      {
        SplitLinear(group, group.Place[axis], group.PlaceStep[axis], place2,
          [&](std::size_t r) HWY_ATTR
          { return hn::Add(this->Shift[r][axis], this->P[r].Fraction[axis]); });
      }
    }
    float place = GetLargest(group, place2);
    if (this->IsOblique())
    {
      // From indices of the lattice to distances; its steps have length 1 at most.
      float step[N];
      for (int i = 0; i < N; ++i)
      {
        step[i] = 0.0f;
        for (int j = 0; j < N; ++j)
        {
          step[i] += static_cast<float>(this->Setup.LatticeSteps[i][j]) * group.PlaceStep[j];
        }
      }
      std::copy(step, step + N, group.PlaceStep);
      place *= 2.0f;
    }
    // The middle of unit vectors is shorter than 1, and bends and changes are not quite across it.
    float norm2 = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      norm2 += group.U[axis] * group.U[axis];
    }
    const float norm = std::sqrt(norm2);
    float alongBend = 0.0f;
    float alongBendStep = 0.0f;
    float alongStep = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      group.U[axis] /= norm;
      alongBend += group.Bend[axis] * group.U[axis];
      alongBendStep += group.BendStep[axis] * group.U[axis];
      alongStep += group.UStep[axis] * group.U[axis];
    }
    float length2 = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      group.Bend[axis] -= alongBend * group.U[axis];
      group.BendStep[axis] -= alongBendStep * group.U[axis];
      group.UStep[axis] -= alongStep * group.U[axis];
      length2 += group.Bend[axis] * group.Bend[axis];
    }
    group.BendLength = std::sqrt(length2);
    const float direction =
      GetLargest(group, direction2) + std::abs(1.0f - norm) + std::abs(alongStep);
    const float bend = this->Setup.Curved ? GetLargest(group, bend2) : 0.0f;
    group.SetBounds(place, direction, bend, travel, this->IsOblique());
    return group.GetLargestWidth() - group.HalfWidth < LargestSpread;
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
        place[i] = hn::Mul(index[0], Const(static_cast<float>(this->Setup.LatticeSteps[i][0])));
        for (int j = 1; j < N; ++j)
        {
          place[i] = hn::MulAdd(
            index[j], Const(static_cast<float>(this->Setup.LatticeSteps[i][j])), place[i]);
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
    // The window is a box of places; oblique indices need √3 times as many to cover it.
    const V box = hn::MulAdd(reach.Spread, Const(std::sqrt(w2)),
      Const(this->Setup.WindowReach * (this->IsOblique() ? 1.75f : 1.0f)));
    result.BoxLow = hn::Sub(reach.Place[axis], hn::Add(box, Const(this->Setup.JitterUp)));
    result.BoxHigh = hn::Add(reach.Place[axis], hn::Add(box, Const(this->Setup.JitterDown)));
    return result;
  }

  /// How much farther across a corner can stand before jitter moves it, the change of its sag included.
  WALK_INLINE V GetLooseness(const Reach<N>& reach) const
  {
    const V radius = Const(this->Setup.JitterRadius);
    return hn::MulAdd(hn::Mul(radius, reach.BendLength), hn::Add(reach.Length, radius), radius);
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

  HWY_NOINLINE void AddGroup(const Group<N>& group)
  {
    HWY_ALIGN std::int32_t rowY[ListSize];
    HWY_ALIGN std::int32_t rowZ[ListSize];
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    std::size_t rows = 0;
    CornerList<N> list;
    const Reach<N> reach(group);
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
          this->AddRows(group, reach, rowY, rowZ, rows, list);
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
    this->AddRows(group, reach, rowY, rowZ, rows, list);
    this->AddCorners(group, list);
  }

  /// Puts the corners of these rows on the list.
  HWY_NOINLINE void AddRows(const Group<N>& group, const Reach<N>& reach, std::int32_t* rowY,
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
            this->AddCorners(group, list);
            list.Count = 0;
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
        se = hn::MulAdd(Const(static_cast<float>(this->Setup.LatticeSteps[i][0])), reach.U[i], se);
      }
    }
    V t0[N];
    V te[N];
    for (int i = 0; i < N; ++i)
    {
      t0[i] = hn::NegMulAdd(s0, reach.U[i], row[i]);
      te[i] =
        hn::NegMulAdd(se, reach.U[i], Const(static_cast<float>(this->Setup.LatticeSteps[i][0])));
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
    const IndexAxis axisY = this->GetIndexAxis(reach, 1);
    const V length = hn::Add(reach.Length, Const(this->Setup.JitterRadius));
    V first;
    V last;
    if constexpr (N == 2)
    {
      this->GetRange(reach, 1, axisY, hn::Neg(length), length, first, last);
      this->AddRowsApart(reach, r, first, last, 0);
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
        this->AddRowsApart(reach, r, first, last, z);
      }
    }
  }

  /// The corners of the rows from the least of `first` to the greatest of `last`.
  WALK_INLINE void AddRowsApart(const Reach<N>& reach, std::size_t r, V first, V last, int z)
  {
    const Sample sample{ this->F[r], this->P[r].Fraction, this->Shift[r], this->CrossFraction[r] };
    const IndexAxis axisX = this->GetIndexAxis(reach, 0);
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
        this->AddSurflet(sample, this->Describe(offset, this->HashCorners(corner)), this->Total[r]);
        this->Visited += this->GetCount(r);
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

  /// Sets the bits, from bit `firstBit` on, of those of these corners that reach samples of a register.
  WALK_INLINE void AddReaching(const Group<N>& group, const V (&offset)[N], VU hash,
    hn::Mask<DF> listed, std::size_t firstBit, std::uint64_t (&bits)[TileRegisters]) const
  {
    V index[N];
    V v[N];
    for (int axis = 0; axis < N; ++axis)
    {
      index[axis] = hn::Sub(offset[axis], Const(group.Place[axis]));
    }
    this->ToPlace(index, v);
    for (int axis = 0; axis < N && Variant && this->Setup.JitterRadius > 0.0f; ++axis)
    {
      v[axis] = hn::Add(v[axis], this->GetJitter(hash, axis));
    }
    V s = hn::Mul(v[0], Const(group.U[0]));
    for (int axis = 1; axis < N; ++axis)
    {
      s = hn::MulAdd(v[axis], Const(group.U[axis]), s);
    }
    const V sag = hn::Mul(hn::Mul(s, s), Const(0.5f));
    V sStep = Const(-group.AlongStep);
    for (int axis = 0; axis < N; ++axis)
    {
      sStep = hn::MulAdd(v[axis], Const(group.UStep[axis]), sStep);
    }
    const V sagStep = hn::Mul(s, sStep);
    V t2 = hn::Zero(DF());
    V step2 = Const(1e-20f);
    V tStep = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      V t = hn::NegMulAdd(s, Const(group.U[axis]), v[axis]);
      V step = hn::MulAdd(s, Const(group.UStep[axis]),
        Const(group.PlaceStep[axis] - group.AlongStep * group.U[axis]));
      if (this->Setup.Curved)
      {
        const V bend = Const(group.Bend[axis]);
        t = hn::NegMulAdd(sag, bend, t);
        step = hn::MulAdd(sag, Const(group.BendStep[axis]), step);
        step = hn::MulAdd(sagStep, bend, step);
      }
      t2 = hn::MulAdd(t, t, t2);
      tStep = hn::MulAdd(t, step, tStep);
      step2 = hn::MulAdd(step, step, step2);
    }
    const V rest[3] = { Const(group.Rest[0]), Const(group.Rest[1]), Const(group.Rest[2]) };
    const V more = Quadratic(rest, hn::Abs(s));
    // |t - λ step| at the λ where it is least, of those that a register has.
    const V best = hn::Div(tStep, step2);
    for (std::size_t r = group.Begin; r < group.End; ++r)
    {
      const float step = group.LambdaStep;
      const float first = static_cast<float>(Lanes * (r - group.Begin)) * step - 1.0f;
      const float half = 0.5f * static_cast<float>(Lanes - 1) * step;
      const V lambda = hn::Max(hn::Min(best, Const(first + 2.0f * half)), Const(first));
      const V least = hn::MulAdd(hn::MulSub(lambda, step2, hn::Add(tStep, tStep)), lambda, t2);
      // Distance along the flow from the middle of the register.
      const V distance = hn::Abs(hn::MulAdd(sStep, Const(first + half), s));
      const V shortest =
        hn::Sub(distance, hn::MulAdd(hn::Abs(sStep), Const(half), Const(group.AlongRest)));
      const V width = hn::Add(
        more, GetTaper(shortest, Const(group.InverseLength), Const(group.HalfWidth), group.Tapers));
      const auto inside = hn::Le(least, hn::MulAdd(width, width, Const(1e-5f)));
      bits[r] |= ToBits(hn::And(listed, hn::And(inside, hn::Gt(width, hn::Zero(DF())))))
        << firstBit;
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
    corner.RowWindow = Const(1.0f);
    for (int axis = 0; axis < N; ++axis)
    {
      corner.Offset[axis] = offset[axis];
      if (Aligned && !Variant && axis > 0)
      {
        corner.FromRow[axis] = hn::Sub(offset[axis], this->P[0].Fraction[axis]);
        if (this->Params.LatticeWindow)
        {
          corner.RowWindow = hn::Mul(corner.RowWindow,
            QuinticFade(hn::Mul(hn::Abs(corner.FromRow[axis]), this->InverseReach)));
        }
      }
    }
    if constexpr (Variant)
    {
      for (int axis = 0; axis<N&& this->Setup.JitterRadius> 0.0f; ++axis)
      {
        corner.Jitter[axis] = this->GetJitter(hash, axis);
      }
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
        const auto on =
          hn::Lt(HashToUnit(HashStream(hash, 2)), Const(static_cast<float>(this->Params.Density)));
        corner.Amplitude = hn::IfThenElseZero(on, corner.Amplitude);
      }
    }
    return corner;
  }

  /// Writes a register of corners to the list.
  WALK_INLINE void Put(const Corner<N>& corner, CornerList<N>& list, std::size_t i) const
  {
    for (int axis = 0; axis < N; ++axis)
    {
      hn::Store(corner.Offset[axis], DF(), list.Offset[axis] + i);
      hn::Store(corner.Gradient[axis], DF(), list.Gradient[axis] + i);
      if (Aligned && !Variant && axis > 0)
      {
        hn::Store(corner.FromRow[axis], DF(), list.FromRow[axis] + i);
      }
      if (Variant && this->Setup.JitterRadius > 0.0f)
      {
        hn::Store(corner.Jitter[axis], DF(), list.Jitter[axis] + i);
      }
    }
    if constexpr (Variant)
    {
      hn::Store(corner.Travel, DF(), list.Travel + i);
      hn::Store(corner.Amplitude, DF(), list.Amplitude + i);
    }
    else if constexpr (Aligned)
    {
      hn::Store(corner.RowWindow, DF(), list.RowWindow + i);
    }
  }

  /// Adds those corners of the list that reach the samples to their sums.
  HWY_NOINLINE void AddCorners(const Group<N>& group, CornerList<N>& list)
  {
    std::uint64_t bits[TileRegisters] = {};
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
      const auto listed = hn::FirstN(DF(), list.Count - i);
      VI corner[N];
      V offset[N];
      for (int axis = 0; axis < N; ++axis)
      {
        corner[axis] = hn::Load(DI(), list.Index[axis] + i);
        offset[axis] = hn::ConvertTo(DF(), corner[axis]);
      }
      const VU hash = this->HashCorners(corner);
      if (this->Params.AnisotropicWeight)
      {
        this->AddReaching(group, offset, hash, listed, i, bits);
      }
      else
      {
        for (std::size_t r = group.Begin; r < group.End; ++r)
        {
          bits[r] |= ToBits(listed) << i;
        }
      }
      this->Put(this->Describe(offset, hash), list, i);
    }
    for (std::size_t r = group.Begin; r < group.End; ++r)
    {
      this->AddSurflets(r, list, bits[r]);
    }
  }

  /// Adds the corners whose bits are set.
  HWY_NOINLINE void AddSurflets(std::size_t r, const CornerList<N>& list, std::uint64_t bits)
  {
    const Sample sample{ this->F[r], this->P[r].Fraction, this->Shift[r], this->CrossFraction[r] };
    Sums sums = this->Total[r];
    this->Visited += this->GetCount(r) * hwy::PopCount(bits);
    for (; bits != 0; bits &= bits - 1)
    {
      const std::size_t corner = hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
      this->AddSurflet(sample, Corner<N>(list, corner), sums);
    }
    this->Total[r] = sums;
  }

  // ---- surflets ---------------------------------------------------------------------------------

  /// A register of samples.
  struct Sample
  {
    const Frame<N>& F;
    const V (&Fraction)[N];
    const V (&Shift)[N];
    const V& CrossFraction;
  };

  WALK_INLINE V GetWindow(const Corner<N>& corner, const V (&v)[N]) const
  {
    if (!this->Params.LatticeWindow)
    {
      return Const(1.0f);
    }
    if constexpr (!Variant)
    {
      V window = QuinticFade(hn::Mul(hn::Abs(v[0]), this->InverseReach));
      if constexpr (Aligned)
      {
        return hn::Mul(corner.RowWindow, window);
      }
      for (int axis = 1; axis < N; ++axis)
      {
        window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v[axis]), this->InverseReach)));
      }
      return window;
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

  WALK_INLINE void AddSurflet(const Sample& sample, const Corner<N>& corner, Sums& sums) const
  {
    V offset[N];
    V v[N];
    for (int axis = 0; axis < N; ++axis)
    {
      offset[axis] = corner.Offset[axis];
      if (!Aligned || axis == 0)
      {
        offset[axis] = hn::Sub(offset[axis], sample.Shift[axis]);
      }
      v[axis] = Aligned && !Variant && axis > 0 ? corner.FromRow[axis]
                                                : hn::Sub(offset[axis], sample.Fraction[axis]);
    }
    if constexpr (Variant)
    {
      V index[N];
      for (int axis = 0; axis < N; ++axis)
      {
        index[axis] = v[axis];
      }
      this->ToPlace(index, v);
      for (int axis = 0; axis<N&& this->Setup.JitterRadius> 0.0f; ++axis)
      {
        v[axis] = hn::Add(v[axis], corner.Jitter[axis]);
      }
    }

    // Along the flow and across it: s, and t as a vector (in 2D as a number along the normal n).
    V s = Dot(v, sample.F.U);
    V t[N];
    if constexpr (N == 2)
    {
      // u x v for a far corner is a small difference of large products. The high parts of u have
      // 16 bits, so their products with corners and the difference are exact.
      t[0] = Variant ? hn::MulSub(sample.F.U[0], v[1], hn::Mul(sample.F.U[1], v[0]))
                     : hn::Add(hn::NegMulAdd(sample.F.UHigh[1], offset[0],
                                 hn::Mul(sample.F.UHigh[0], offset[1])),
                         hn::NegMulAdd(sample.F.ULow[1], offset[0],
                           hn::MulSub(sample.F.ULow[0], offset[1], sample.CrossFraction)));
    }
    else
    {
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(s, sample.F.U[i], v[i]);
      }
      // u has not quite length 1 and s is rounded: what t still has of u is large beside it.
      const V rest = Dot(t, sample.F.U);
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(rest, sample.F.U[i], t[i]);
      }
      s = hn::Add(s, rest);
    }
    if (this->Setup.Curved)
    {
      const V sag = hn::Mul(hn::Mul(Const(0.5f), s), s);
      if constexpr (N == 2)
      {
        t[0] = hn::NegMulAdd(sag, sample.F.BendAcross, t[0]);
      }
      else
      {
        for (int i = 0; i < N; ++i)
        {
          t[i] = hn::NegMulAdd(sag, sample.F.Bend[i], t[i]);
        }
      }
    }
    if constexpr (Variant)
    {
      if (this->Params.Motion)
      {
        s = hn::MulAdd(hn::Mul(corner.Travel, sample.F.Sense),
          hn::Div(Const(1.0f), hn::Sqrt(sample.F.Along)), s);
      }
    }

    const V ks = hn::Mul(sample.F.Along, s);
    const V t2 = N == 2 ? hn::Mul(t[0], t[0]) : Dot(t, t);
    V across2 = hn::Mul(sample.F.Across, t2);
    V r = hn::Zero(DF());
    if (N == 3 && this->Setup.Biaxial)
    {
      r = Dot(t, sample.F.M);
      across2 = hn::MulAdd(hn::Mul(hn::Sub(sample.F.Second, sample.F.Across), r), r, across2);
    }
    const V q = hn::MulAdd(ks, s, across2);
    V weight = this->GetWindow(corner, v);

    V amplified = weight;
    if constexpr (Variant)
    {
      const V amplitude = corner.Amplitude;
      if (this->Params.Surflet == Basis::Streaks)
      {
        this->AddStreak(sample, amplitude, weight, s, across2, sums);
        return;
      }
      if (this->Params.AnisotropicWeight)
      {
        weight = hn::Mul(weight, FadeOf(this->Params.Interpolant, q));
      }
      amplified = hn::Mul(amplitude, weight);
      if (this->Params.Surflet == Basis::Value)
      {
        sums.Noise = hn::MulAdd(amplified, corner.Gradient[0], sums.Noise);
        sums.Variance = hn::MulAdd(hn::Mul(weight, weight), Const(1.0f / 3.0f), sums.Variance);
        sums.Weight = hn::Add(sums.Weight, weight);
        return;
      }
    }
    else
    {
      weight = hn::Mul(weight, QuinticFade(q));
      amplified = weight;
    }

    // G v' in the axes of the metric, then the gradient.
    V Gv[N];
    if constexpr (N == 2)
    {
      const V bt = hn::Mul(sample.F.Across, t[0]);
      Gv[0] = hn::MulSub(ks, sample.F.U[0], hn::Mul(bt, sample.F.U[1]));
      Gv[1] = hn::MulAdd(ks, sample.F.U[1], hn::Mul(bt, sample.F.U[0]));
    }
    else
    {
      for (int i = 0; i < N; ++i)
      {
        Gv[i] = hn::MulAdd(ks, sample.F.U[i], hn::Mul(sample.F.Across, t[i]));
      }
      if (this->Setup.Biaxial)
      {
        const V er = hn::Mul(hn::Sub(sample.F.Second, sample.F.Across), r);
        for (int i = 0; i < N; ++i)
        {
          Gv[i] = hn::MulAdd(er, sample.F.M[i], Gv[i]);
        }
      }
    }
    V g[N];
    for (int axis = 0; axis < N; ++axis)
    {
      g[axis] = corner.Gradient[axis];
    }
    sums.Noise = hn::MulAdd(amplified, Dot(g, Gv), sums.Noise);
    if (this->Params.Normalize == Normalization::UnitVariance)
    {
      sums.Variance = hn::MulAdd(
        hn::Mul(hn::Mul(weight, weight), this->GradientPower), Dot(Gv, Gv), sums.Variance);
    }
    else
    {
      sums.Weight = hn::Add(sums.Weight, weight);
    }
  }

  WALK_INLINE void AddStreak(
    const Sample& sample, V amplitude, V window, V s, V across2, Sums& sums) const
  {
    const V sigma = hn::Neg(hn::Mul(s, hn::Sqrt(sample.F.Along)));
    const V across = hn::Sqrt(hn::Max(across2, Const(0.0f)));
    const V profile = hn::Mul(hn::Mul(window, sample.F.Sense),
      hn::Mul(StreakProfile(sigma), FadeOf(this->Params.Interpolant, across)));
    const auto density = static_cast<float>(this->Params.Density);
    sums.Noise = hn::MulAdd(amplitude, profile, sums.Noise);
    sums.Variance = hn::MulAdd(hn::Mul(Const(density), profile), profile, sums.Variance);
    sums.Weight = hn::Add(sums.Weight, profile);
  }

  /// Samples that are farther apart than this, as their surflets see it, do not share a list.
  static constexpr float LargestSpread = 1.5f;

  /// A little more than needed: every sample must see all its own corners, whatever rounding does.
  static constexpr float Slack = 1e-3f;

  const NoiseSetup& Setup;
  const NoiseParameters& Params;
  const OctaveSetup& Octave;
  V InverseReach;
  /// Variance of a gradient's component.
  V GradientPower;
  std::size_t Count = 0;
  std::uint64_t Visited = 0;
  Frame<N> F[TileRegisters];
  Places<N> P[TileRegisters];
  V CrossFraction[TileRegisters];
  /// The cells that offsets count from, and the samples' own cells from there.
  VU Cell[N];
  V Shift[TileRegisters][N];
  Sums Total[TileRegisters];
};
