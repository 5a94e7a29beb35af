// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The sum over corners for any Quality and any variant (see SteerableNoiseSimd-inl.h, which includes
 * this for each SIMD level).
 *
 * Neighbouring samples are reached by the same corners. So they are listed once for a register of
 * samples, with a register of corners at a time: first the lattice rows, then the corners on them, then
 * those that really are in reach with their gradients. After that the samples take them one by one.
 * Samples that differ too much, or lie apart, are listed for one at a time.
 */

/// Where the samples of a register are in the lattice of an octave: cells as the hash takes them, and
/// fractions from their corners.
template <int N>
struct Places
{
  VU Cell[N];
  V Fraction[N];
};

/// Corners of a list that go through the stages together, and room for a register behind them.
constexpr std::size_t ListSize = 64;
constexpr std::size_t ListRoom = ListSize + 2 * Lanes;

/// Corners that may be in reach, as offsets from the cell of the first sample.
template <int N>
struct CornerList
{
  std::size_t Count = 0;
  HWY_ALIGN float Offset[N][ListRoom];
};

/// What samples need to know of a register of corners.
template <int N>
struct CornerBatch
{
  HWY_ALIGN float Offset[N][Lanes];
  HWY_ALIGN float Gradient[N][Lanes];
  /// Offset and window on the axes that all samples of an image row share.
  HWY_ALIGN float FromRow[N][Lanes];
  HWY_ALIGN float RowWindow[Lanes];
  /// Of variants: displacement of the corner, (τ - 1/2) Speed, and what the surflet is multiplied by.
  HWY_ALIGN float Jitter[N][Lanes];
  HWY_ALIGN float Travel[Lanes];
  HWY_ALIGN float Amplitude[Lanes];
};

/**
 * The samples that share a list. They change almost linearly from the first to the last, so sample λ in
 * [-1, 1] is at Place + λ PlaceStep, and so on, up to small rests. Distances s along and t across are
 * from the bent axis of the middle.
 */
template <int N>
struct Group
{
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
  float AlongStep;
  /// Largest distance between places; of s between samples, without and with the surflet's travel.
  float Spread;
  float AlongSpread;
  float AlongReach;
  /// t of a sample is at most Rest[0] + Rest[1] |s| + Rest[2] s² from t - λ (its linear change), and at
  /// most Across[...] from t.
  float Rest[3];
  float Across[3];

  /// Bounds, from what places, directions and bends are off the linear change.
  WALK_INLINE void SetBounds(float place, float direction, float bend, float travel)
  {
    float place2 = 0.0f;
    float direction2 = 0.0f;
    float bend2 = 0.0f;
    this->AlongStep = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      place2 += this->PlaceStep[axis] * this->PlaceStep[axis];
      direction2 += this->UStep[axis] * this->UStep[axis];
      bend2 += this->BendStep[axis] * this->BendStep[axis];
      this->AlongStep += this->PlaceStep[axis] * this->U[axis];
    }
    const float along = std::abs(this->AlongStep) + place;
    const float across = std::sqrt(std::max(0.0f, place2 - this->AlongStep * this->AlongStep));
    const float turn = std::sqrt(direction2);
    const float change = std::sqrt(bend2);
    const float kappa = this->BendLength + change + bend;
    const float length = this->HalfLength;
    this->Spread = std::sqrt(place2) + place;
    const float second = (turn + direction) *
      (this->HalfWidth + 0.5f * length * (turn + direction + length * kappa));
    this->AlongSpread = along + second;
    this->AlongReach = this->AlongSpread + travel;
    this->Rest[0] = place + along * turn + second * turn + 0.5f * kappa * this->AlongSpread * this->AlongSpread;
    this->Rest[1] = direction + kappa * second + along * change;
    this->Rest[2] = 0.5f * bend;
    this->Across[0] = this->Rest[0] + across;
    this->Across[1] = this->Rest[1] + turn + kappa * along;
    this->Across[2] = this->Rest[2] + 0.5f * change;
  }
  float GetLength() const { return this->HalfLength + this->AlongReach; }
  float GetLargestWidth() const
  {
    const float s = this->HalfLength + this->AlongReach + this->AlongSpread;
    return this->HalfWidth + this->Across[0] + s * (this->Across[1] + s * this->Across[2]);
  }
  /// Largest |t| for |s| between `least` and `most`, with one of the two bounds above.
  WALK_INLINE V GetWidth(V least, V most, const float (&bound)[3]) const
  {
    V width = Const(this->HalfWidth);
    if (this->Tapers)
    {
      const V s = hn::Mul(
        hn::Max(hn::Sub(least, Const(this->AlongReach)), hn::Zero(DF())), Const(this->InverseLength));
      width = hn::Mul(
        width, hn::Sqrt(hn::Max(hn::NegMulAdd(s, s, Const(1.0f)), hn::Zero(DF()))));
    }
    const V s = hn::Add(most, Const(this->AlongSpread));
    const V more =
      hn::MulAdd(hn::MulAdd(Const(bound[2]), s, Const(bound[1])), s, Const(bound[0]));
    return hn::Add(width, more);
  }
};

/// `Aligned`: the samples have their places on all axes but the first in common.
template <int N, bool Variant, bool Aligned>
class Walk
{
public:
  WALK_INLINE Walk(const NoiseSetup& setup, const OctaveSetup& octave, const Frame<N>& frame,
    const Places<N>& places)
    : Setup(setup)
    , Params(setup.Parameters)
    , Octave(octave)
    , F(frame)
    , P(places)
    , InverseReach(Const(1.0f / (Params.Quality + 1)))
    , RootAlong(hn::Sqrt(frame.Along))
  {
    if constexpr (N == 2)
    {
      const V product = hn::Mul(frame.U[1], places.Fraction[0]);
      this->CrossFraction = hn::Sub(hn::MulSub(frame.U[0], places.Fraction[1], product),
        hn::MulSub(frame.U[1], places.Fraction[0], product));
    }
  }

  /// Noise of the first `count` samples of the register.
  WALK_INLINE V Evaluate(std::size_t count, std::uint64_t& visited)
  {
    Group<N> group;
    for (int axis = 0; axis < N; ++axis)
    {
      this->Cell[axis] = hn::GetLane(this->P.Cell[axis]);
      this->Shift[axis] = hn::Zero(DF());
      if (!Aligned || axis == 0)
      {
        this->Shift[axis] = hn::ConvertTo(DF(),
          hn::BitCast(DI(), hn::Sub(this->P.Cell[axis], hn::Set(DU(), this->Cell[axis]))));
      }
    }
    if (Lanes > 1 && this->SetGroup(group))
    {
      this->AddGroup(group);
      visited += this->Visited * count;
      return Normalized(this->Setup, this->Total);
    }
    Sums all;
    for (std::size_t lane = 0; lane < count; ++lane)
    {
      for (int axis = 0; axis < N; ++axis)
      {
        HWY_ALIGN std::uint32_t cells[Lanes];
        hn::Store(this->P.Cell[axis], DU(), cells);
        this->Cell[axis] = cells[lane];
        this->Shift[axis] = hn::Zero(DF());
      }
      this->SetOne(group, lane);
      this->Total = Sums();
      this->AddGroup(group);
      const auto own = hn::RebindMask(DF(),
        hn::Eq(hn::Iota(DI(), 0), hn::Set(DI(), static_cast<std::int32_t>(lane))));
      all.Noise = hn::IfThenElse(own, this->Total.Noise, all.Noise);
      all.Weight = hn::IfThenElse(own, this->Total.Weight, all.Weight);
      all.Variance = hn::IfThenElse(own, this->Total.Variance, all.Variance);
    }
    visited += this->Visited;
    return Normalized(this->Setup, all);
  }

private:
  static WALK_INLINE float LaneOf(V v, std::size_t lane)
  {
    HWY_ALIGN float lanes[Lanes];
    hn::Store(v, DF(), lanes);
    return lanes[lane];
  }

  // ---- the group --------------------------------------------------------------------------------

  WALK_INLINE V GetLeastAcross() const
  {
    return this->Setup.Biaxial ? hn::Min(this->F.Across, this->F.Second) : this->F.Across;
  }

  /// Half axes of the surflet from the least eigenvalues; returns how far it travels.
  WALK_INLINE float SetAxes(Group<N>& group, float along, float across) const
  {
    const float support = this->Setup.Support;
    const bool streaks = Variant && this->Params.Surflet == Basis::Streaks;
    const float rootAlong = std::sqrt(along);
    // A little more than needed: every sample must see all its own corners, whatever rounding does.
    constexpr float slack = 1e-3f;
    group.HalfLength = (streaks ? 1.0f : std::sqrt(support)) / rootAlong + slack;
    group.HalfWidth = (streaks ? support : std::sqrt(support)) / std::sqrt(across) + slack;
    group.InverseLength = 1.0f / group.HalfLength;
    group.Tapers = !streaks;
    return Variant && this->Params.Motion
      ? 0.5f * std::abs(static_cast<float>(this->Params.Speed)) / rootAlong
      : 0.0f;
  }

  WALK_INLINE void SetOne(Group<N>& group, std::size_t lane) const
  {
    float bend2 = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      group.Place[axis] = LaneOf(this->P.Fraction[axis], lane);
      group.U[axis] = LaneOf(this->F.U[axis], lane);
      group.Bend[axis] = this->Setup.Curved ? LaneOf(this->F.Bend[axis], lane) : 0.0f;
      group.PlaceStep[axis] = group.UStep[axis] = group.BendStep[axis] = 0.0f;
      bend2 += group.Bend[axis] * group.Bend[axis];
    }
    group.BendLength = std::sqrt(bend2);
    const float travel =
      this->SetAxes(group, LaneOf(this->F.Along, lane), LaneOf(this->GetLeastAcross(), lane));
    group.SetBounds(0.0f, 0.0f, 0.0f, travel);
  }

  /// Middle and half the difference of the first and the last lane; returns what is left of v.
  static WALK_INLINE V SplitLinear(V v, V lambda, float& middle, float& step)
  {
    HWY_ALIGN float lanes[Lanes];
    hn::Store(v, DF(), lanes);
    middle = 0.5f * (lanes[0] + lanes[Lanes - 1]);
    step = 0.5f * (lanes[Lanes - 1] - lanes[0]);
    return hn::NegMulAdd(lambda, Const(step), hn::Sub(v, Const(middle)));
  }

  /// False if the samples had better not share a list.
  HWY_NOINLINE bool SetGroup(Group<N>& group) const
  {
    const float travel =
      this->SetAxes(group, LeastLane(this->F.Along), LeastLane(this->GetLeastAcross()));
    const V lambda = hn::MulSub(
      hn::Iota(DF(), 0.0f), Const(2.0f / std::max<float>(1.0f, Lanes - 1.0f)), Const(1.0f));
    // u and -u are the same axis.
    V cosine = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      cosine =
        hn::MulAdd(this->F.U[axis], Const(hn::GetLane(this->F.U[axis])), cosine);
    }
    const V sign = hn::And(cosine, hn::BitCast(DF(), hn::Set(DU(), 0x80000000u)));
    V direction2 = hn::Zero(DF());
    V bend2 = hn::Zero(DF());
    float length2 = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      const V rest = SplitLinear(
        hn::Xor(this->F.U[axis], sign), lambda, group.U[axis], group.UStep[axis]);
      direction2 = hn::MulAdd(rest, rest, direction2);
      group.Bend[axis] = group.BendStep[axis] = 0.0f;
      if (this->Setup.Curved)
      {
        const V change =
          SplitLinear(this->F.Bend[axis], lambda, group.Bend[axis], group.BendStep[axis]);
        bend2 = hn::MulAdd(change, change, bend2);
        length2 += group.Bend[axis] * group.Bend[axis];
      }
    }
    group.BendLength = std::sqrt(length2);
    float place = 0.0f;
    if constexpr (Aligned)
    {
      for (int axis = 1; axis < N; ++axis)
      {
        group.Place[axis] = hn::GetLane(this->P.Fraction[axis]);
        group.PlaceStep[axis] = 0.0f;
      }
      place = GreatestLane(hn::Abs(SplitLinear(
        hn::Add(this->Shift[0], this->P.Fraction[0]), lambda, group.Place[0], group.PlaceStep[0])));
    }
    else
    {
      V index[N];
      V d[N];
      V rest[N];
      for (int axis = 0; axis < N; ++axis)
      {
        float step;
        index[axis] = hn::Add(this->Shift[axis], this->P.Fraction[axis]);
        SplitLinear(index[axis], lambda, group.Place[axis], step);
      }
      this->ToPlace(index, d);
      for (int axis = 0; axis < N; ++axis)
      {
        float middle;
        rest[axis] = SplitLinear(d[axis], lambda, middle, group.PlaceStep[axis]);
      }
      place = std::sqrt(GreatestLane(Dot(rest, rest)));
    }
    group.SetBounds(place, std::sqrt(GreatestLane(direction2)),
      this->Setup.Curved ? std::sqrt(GreatestLane(bend2)) : 0.0f, travel);
    return group.GetLargestWidth() - group.HalfWidth < LargestSpread;
  }

  // ---- listing corners --------------------------------------------------------------------------

  WALK_INLINE bool IsOblique() const
  {
    return Variant && this->Params.Grid == Lattice::Simplicial;
  }

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

  /// How an index of the lattice changes along the group's axis, and with it across.
  struct IndexAxis
  {
    float Along;
    float InverseAlong;
    float Bend;
    float Width;
    float BoxLow;
    float BoxHigh;
  };

  WALK_INLINE IndexAxis GetIndexAxis(const Group<N>& group, int axis) const
  {
    IndexAxis result;
    result.Along = group.U[axis];
    result.Bend = group.Bend[axis];
    float w2 = 1.0f;
    if (this->IsOblique())
    {
      result.Along = result.Bend = w2 = 0.0f;
    }
    for (int i = 0; i < N && this->IsOblique(); ++i)
    {
      const auto w = static_cast<float>(this->Setup.LatticeIndices[axis][i]);
      result.Along += w * group.U[i];
      result.Bend += w * group.Bend[i];
      w2 += w * w;
    }
    const float across2 = std::max(0.0f, w2 - result.Along * result.Along);
    result.Width = (group.GetLargestWidth() + this->GetLooseness(group)) * std::sqrt(across2) +
      this->Setup.JitterRadius * std::abs(result.Along);
    result.InverseAlong =
      1.0f / std::copysign(std::max(std::abs(result.Along), 1e-6f), result.Along);
    // The window is a box of places; oblique indices need √3 times as many to cover it.
    const float reach =
      this->Setup.WindowReach * (this->IsOblique() ? 1.75f : 1.0f) +
      group.Spread * std::sqrt(w2);
    result.BoxLow = group.Place[axis] - reach - this->Setup.JitterUp;
    result.BoxHigh = group.Place[axis] + reach + this->Setup.JitterDown;
    return result;
  }

  /// How much farther across a corner can stand before jitter moves it, the change of its sag included.
  WALK_INLINE float GetLooseness(const Group<N>& group) const
  {
    const float radius = this->Setup.JitterRadius;
    return radius * (1.0f + group.BendLength * (group.GetLength() + radius));
  }

  /// s²/2 on an interval, times a factor: its least and greatest value.
  static WALK_INLINE void GetSag(float factor, V low, V high, V& least, V& greatest)
  {
    const V half = Const(0.5f * factor);
    const V first = hn::Mul(hn::Mul(low, low), half);
    const V last = hn::Mul(hn::Mul(high, high), half);
    const V turn = hn::IfThenElse(
      hn::Lt(hn::Mul(low, high), hn::Zero(DF())), hn::Zero(DF()), first);
    least = hn::Min(hn::Min(first, last), turn);
    greatest = hn::Max(hn::Max(first, last), turn);
  }

  /// Leaves of [low, high] the s at which the index can be `offset` from the group's place.
  WALK_INLINE void Narrow(const IndexAxis& axis, V offset, V& low, V& high) const
  {
    V least = hn::Zero(DF());
    V greatest = hn::Zero(DF());
    for (int round = 0; round < (this->Setup.Curved ? 2 : 1); ++round)
    {
      if (this->Setup.Curved)
      {
        GetSag(axis.Bend, low, high, least, greatest);
      }
      const V a = hn::Mul(
        hn::Sub(hn::Sub(offset, Const(axis.Width)), greatest), Const(axis.InverseAlong));
      const V b =
        hn::Mul(hn::Sub(hn::Add(offset, Const(axis.Width)), least), Const(axis.InverseAlong));
      low = hn::Max(low, hn::Min(a, b));
      high = hn::Min(high, hn::Max(a, b));
    }
  }

  /// Indices that the reach has for s in [low, high].
  WALK_INLINE void GetRange(
    const Group<N>& group, int number, const IndexAxis& axis, V low, V high, V& first, V& last) const
  {
    first = Const(axis.BoxLow);
    last = Const(axis.BoxHigh);
    if (this->Params.AnisotropicWeight)
    {
      V least = hn::Zero(DF());
      V greatest = hn::Zero(DF());
      if (this->Setup.Curved)
      {
        GetSag(axis.Bend, low, high, least, greatest);
      }
      const V a = hn::Mul(low, Const(axis.Along));
      const V b = hn::Mul(high, Const(axis.Along));
      const V place = Const(group.Place[number] - this->Setup.JitterMiddle);
      const V width = Const(axis.Width);
      first = hn::Max(first, hn::Add(place, hn::Sub(hn::Add(hn::Min(a, b), least), width)));
      last = hn::Min(last, hn::Add(place, hn::Add(hn::Add(hn::Max(a, b), greatest), width)));
    }
    first = hn::Ceil(first);
    last = hn::Floor(last);
  }

  HWY_NOINLINE void AddGroup(const Group<N>& group)
  {
    HWY_ALIGN float rowY[ListRoom];
    HWY_ALIGN float rowZ[ListRoom];
    HWY_ALIGN float firsts[Lanes];
    HWY_ALIGN float lasts[Lanes];
    std::size_t rows = 0;
    CornerList<N> list;
    const IndexAxis axisY = this->GetIndexAxis(group, 1);
    const V length = Const(group.GetLength() + this->Setup.JitterRadius);
    V first;
    V last;
    const auto addRows = [&](float y, float lastY, float z) HWY_ATTR
    {
      for (; y <= lastY; y += Lanes)
      {
        hn::StoreU(hn::Iota(DF(), y), DF(), rowY + rows);
        hn::StoreU(Const(z), DF(), rowZ + rows);
        rows += std::min(Lanes, static_cast<std::size_t>(lastY - y) + 1);
        if (rows >= ListSize)
        {
          this->AddRows(group, rowY, rowZ, rows, list);
          rows = 0;
        }
      }
    };
    if constexpr (N == 2)
    {
      this->GetRange(group, 1, axisY, hn::Neg(length), length, first, last);
      addRows(ToCorner(hn::GetLane(first)), ToCorner(hn::GetLane(last)), 0.0f);
    }
    else
    {
      const IndexAxis axisZ = this->GetIndexAxis(group, 2);
      this->GetRange(group, 2, axisZ, hn::Neg(length), length, first, last);
      const int lastZ = ToCorner(hn::GetLane(last));
      for (int z = ToCorner(hn::GetLane(first)); z <= lastZ; z += static_cast<int>(Lanes))
      {
        V low = hn::Neg(length);
        V high = length;
        if (this->Params.AnisotropicWeight)
        {
          const float from = static_cast<float>(z) - group.Place[2] + this->Setup.JitterMiddle;
          this->Narrow(axisZ, hn::Iota(DF(), from), low, high);
        }
        this->GetRange(group, 1, axisY, low, high, first, last);
        last = hn::IfThenElse(hn::Gt(low, high), Const(-1e9f), last);
        hn::Store(first, DF(), firsts);
        hn::Store(last, DF(), lasts);
        for (int i = 0; i < static_cast<int>(Lanes) && z + i <= lastZ; ++i)
        {
          addRows(std::max(firsts[i], -1000.0f), std::min(lasts[i], 1000.0f),
            static_cast<float>(z + i));
        }
      }
    }
    this->AddRows(group, rowY, rowZ, rows, list);
    this->AddCorners(group, list);
  }

  /// Puts the corners of these rows on the list.
  HWY_NOINLINE void AddRows(const Group<N>& group, const float* rowY, const float* rowZ,
    std::size_t rows, CornerList<N>& list)
  {
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    const IndexAxis axis = this->GetIndexAxis(group, 0);
    for (std::size_t i = 0; i < rows; i += Lanes)
    {
      V low = Const(axis.BoxLow);
      V high = Const(axis.BoxHigh);
      if (this->Params.AnisotropicWeight)
      {
        this->CutRows(group, Load(rowY + i), Load(rowZ + i), low, high);
      }
      // Bounds of the loop, whatever the numbers are.
      const V least = Const(-1000.0f);
      const V most = Const(1000.0f);
      hn::Store(hn::ConvertTo(DI(), hn::Ceil(hn::Min(hn::Max(low, least), most))), DI(), firsts);
      hn::Store(hn::ConvertTo(DI(), hn::Floor(hn::Max(hn::Min(high, most), least))), DI(), lasts);
      const std::size_t count = std::min(Lanes, rows - i);
      for (std::size_t lane = 0; lane < count; ++lane)
      {
        for (int x = firsts[lane]; x <= lasts[lane]; x += static_cast<int>(Lanes))
        {
          hn::StoreU(hn::Iota(DF(), static_cast<float>(x)), DF(), list.Offset[0] + list.Count);
          hn::StoreU(Const(rowY[i + lane]), DF(), list.Offset[1] + list.Count);
          if constexpr (N == 3)
          {
            hn::StoreU(Const(rowZ[i + lane]), DF(), list.Offset[2] + list.Count);
          }
          list.Count += static_cast<std::size_t>(
            std::min(static_cast<int>(Lanes), lasts[lane] - x + 1));
          if (list.Count >= ListSize)
          {
            this->AddCorners(group, list);
            list.Count = 0;
          }
        }
      }
    }
  }

  /**
   * Interval of a register of rows: a slab along the flow, then a tube around the parabola, whose sag
   * and width are known within a band once the slab has bounded the distance along the flow.
   */
  WALK_INLINE void CutRows(const Group<N>& group, V rowY, V rowZ, V& low, V& high) const
  {
    V row[N];
    V step[N];
    V index[N];
    index[0] = Const(-group.Place[0]);
    index[1] = hn::Sub(rowY, Const(group.Place[1]));
    if constexpr (N == 3)
    {
      index[2] = hn::Sub(rowZ, Const(group.Place[2]));
    }
    this->ToPlace(index, row);
    float se = 0.0f;
    V s0 = hn::Zero(DF());
    for (int i = 0; i < N; ++i)
    {
      const auto component = static_cast<float>(this->Setup.LatticeSteps[i][0]);
      step[i] = Const(component);
      se += component * group.U[i];
      row[i] = hn::Add(row[i], Const(this->Setup.JitterMiddle));
      s0 = hn::MulAdd(row[i], Const(group.U[i]), s0);
    }
    const float radius = this->Setup.JitterRadius;
    const V inverse = Const(1.0f / std::copysign(std::max(std::abs(se), 1e-6f), se));
    const V middle = hn::Neg(hn::Mul(s0, inverse));
    const V half = hn::Abs(hn::Mul(Const(group.GetLength() + radius), inverse));
    low = hn::Max(low, hn::Sub(middle, half));
    high = hn::Min(high, hn::Add(middle, half));

    const V first = hn::MulAdd(low, Const(se), s0);
    const V last = hn::MulAdd(high, Const(se), s0);
    const V most = hn::Max(hn::Abs(first), hn::Abs(last));
    const V least = hn::IfThenElseZero(hn::Ge(hn::Mul(first, last), hn::Zero(DF())),
      hn::Min(hn::Abs(first), hn::Abs(last)));
    V width = hn::Add(group.GetWidth(hn::Sub(least, Const(radius)),
                        hn::Add(most, Const(radius)), group.Across),
      Const(this->GetLooseness(group)));
    V sag = hn::Zero(DF());
    if (this->Setup.Curved)
    {
      const V quarter = Const(0.25f);
      const V most2 = hn::Mul(most, most);
      const V least2 = hn::Mul(least, least);
      sag = hn::Mul(quarter, hn::Add(most2, least2));
      const V band = hn::Mul(quarter, hn::Sub(most2, least2));
      width = hn::MulAdd(band, Const(group.BendLength), width);
    }
    // |t0 + x te| < width with t the part across the flow, t0 shifted by the sag.
    V B = hn::Zero(DF());
    V C = hn::Neg(hn::Mul(width, width));
    float A = 0.0f;
    for (int i = 0; i < N; ++i)
    {
      const V t0 = hn::NegMulAdd(
        sag, Const(group.Bend[i]), hn::NegMulAdd(s0, Const(group.U[i]), row[i]));
      const float te = static_cast<float>(this->Setup.LatticeSteps[i][0]) - se * group.U[i];
      B = hn::MulAdd(t0, Const(te), B);
      C = hn::MulAdd(t0, t0, C);
      A += te * te;
    }
    A = std::max(A, 1e-6f);
    const V discriminant = hn::NegMulAdd(Const(A), C, hn::Mul(B, B));
    const V inverseA = Const(1.0f / A);
    const V root = hn::Mul(hn::Sqrt(hn::Max(discriminant, hn::Zero(DF()))), inverseA);
    const V center = hn::Neg(hn::Mul(B, inverseA));
    const V slack = Const(1e-3f);
    low = hn::Max(low, hn::Sub(hn::Sub(center, root), slack));
    high = hn::Min(high, hn::Add(hn::Add(center, root), slack));
    high = hn::IfThenElse(hn::Lt(discriminant, hn::Zero(DF())), Const(-1e9f), high);
  }

  // ---- listed corners ---------------------------------------------------------------------------

  WALK_INLINE VU HashCorners(const V (&offset)[N]) const
  {
    VU hash = hn::Set(DU(), this->Octave.Seed);
    for (int axis = 0; axis < N; ++axis)
    {
      VU index = hn::Add(hn::Set(DU(), this->Cell[axis]),
        hn::BitCast(DU(), hn::ConvertTo(DI(), offset[axis])));
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

  /// Which of these corners reach one of the samples.
  WALK_INLINE hn::Mask<DF> GetReaching(
    const Group<N>& group, const V (&offset)[N], VU hash) const
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
    const V sagStep = hn::Mul(s, Const(group.AlongStep));
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
        step = hn::NegMulAdd(sagStep, bend, step);
      }
      t2 = hn::MulAdd(t, t, t2);
      tStep = hn::MulAdd(t, step, tStep);
      step2 = hn::MulAdd(step, step, step2);
    }
    // |t - λ step| at the λ of [-1, 1] where it is least.
    const V one = Const(1.0f);
    const V lambda = hn::Max(hn::Min(hn::Div(tStep, step2), one), hn::Neg(one));
    const V least = hn::MulAdd(hn::MulSub(lambda, step2, hn::Add(tStep, tStep)), lambda, t2);
    const V distance = hn::Abs(s);
    const V width = group.GetWidth(distance, distance, group.Rest);
    return hn::And(hn::Le(least, hn::MulAdd(width, width, Const(1e-5f))),
      hn::Le(distance, Const(group.GetLength())));
  }

  WALK_INLINE void Describe(const V (&offset)[N], VU hash, CornerBatch<N>& batch) const
  {
    V g[N];
    if (!Variant || (this->Params.Surflet == Basis::Gradient &&
                      this->Params.Gradients == GradientSet::Uniform))
    {
      UniformGradient(hash, g);
    }
    else if (this->Params.Surflet == Basis::Gradient)
    {
      PerlinGradient<N>(hash, g);
    }
    else
    {
      g[0] = hn::Mul(HashToSigned(hash), Const(2.0f)); // the value
      for (int axis = 1; axis < N; ++axis)
      {
        g[axis] = hn::Zero(DF());
      }
    }
    V window = Const(1.0f);
    for (int axis = 0; axis < N; ++axis)
    {
      hn::Store(offset[axis], DF(), batch.Offset[axis]);
      hn::Store(g[axis], DF(), batch.Gradient[axis]);
      if (Aligned && !Variant && axis > 0)
      {
        const V v = hn::Sub(offset[axis], this->P.Fraction[axis]);
        hn::Store(v, DF(), batch.FromRow[axis]);
        if (this->Params.LatticeWindow)
        {
          window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v), this->InverseReach)));
        }
      }
    }
    hn::Store(window, DF(), batch.RowWindow);
    if constexpr (Variant)
    {
      this->DescribeVariant(hash, batch);
    }
  }

  WALK_INLINE void DescribeVariant(VU hash, CornerBatch<N>& batch) const
  {
    for (int axis = 0; axis < N && this->Setup.JitterRadius > 0.0f; ++axis)
    {
      hn::Store(this->GetJitter(hash, axis), DF(), batch.Jitter[axis]);
    }
    V amplitude = Const(1.0f);
    if (this->Params.Motion)
    {
      const V clock = hn::Add(HashToUnit(HashStream(hash, 1)),
        Const(static_cast<float>(this->Params.Phase - std::floor(this->Params.Phase))));
      const V tau = hn::Sub(clock, hn::Floor(clock));
      const V centered = hn::Sub(tau, Const(0.5f));
      hn::Store(
        hn::Mul(centered, Const(static_cast<float>(this->Params.Speed))), DF(), batch.Travel);
      const V wave = CosPi(centered); // sin(π τ)
      amplitude = hn::Mul(hn::Mul(wave, wave), Const(1.6329931619f));
    }
    if (this->Params.Surflet == Basis::Streaks)
    {
      const auto on = hn::Lt(
        HashToUnit(HashStream(hash, 2)), Const(static_cast<float>(this->Params.Density)));
      amplitude = hn::IfThenElseZero(on, amplitude);
    }
    hn::Store(amplitude, DF(), batch.Amplitude);
  }

  /// Adds those corners of the list that reach the samples to their sums.
  HWY_NOINLINE void AddCorners(const Group<N>& group, const CornerList<N>& list)
  {
    CornerBatch<N> batch;
    for (std::size_t i = 0; i < list.Count; i += Lanes)
    {
      auto reaching = hn::FirstN(DF(), list.Count - i);
      V offset[N];
      for (int axis = 0; axis < N; ++axis)
      {
        // What stands behind the end of the list is no number.
        offset[axis] = hn::IfThenElseZero(reaching, Load(list.Offset[axis] + i));
      }
      const VU hash = this->HashCorners(offset);
      if (this->Params.AnisotropicWeight)
      {
        reaching = hn::And(reaching, this->GetReaching(group, offset, hash));
      }
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(DF(), reaching, bytes);
      std::uint64_t bits;
      std::memcpy(&bits, bytes, sizeof(bits));
      if (bits != 0)
      {
        this->Describe(offset, hash, batch);
        this->AddSurflets(batch, bits);
      }
    }
  }

  HWY_NOINLINE void AddSurflets(const CornerBatch<N>& batch, std::uint64_t bits)
  {
    for (; bits != 0; bits &= bits - 1)
    {
      this->AddSurflet(batch, hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
      ++this->Visited;
    }
  }

  // ---- surflets ---------------------------------------------------------------------------------

  WALK_INLINE V GetWindow(const CornerBatch<N>& batch, std::size_t corner, const V (&v)[N]) const
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
        return hn::Mul(Const(batch.RowWindow[corner]), window);
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

  WALK_INLINE void AddSurflet(const CornerBatch<N>& batch, std::size_t corner)
  {
    V offset[N];
    V v[N];
    for (int axis = 0; axis < N; ++axis)
    {
      offset[axis] = Const(batch.Offset[axis][corner]);
      if (!Aligned || axis == 0)
      {
        offset[axis] = hn::Sub(offset[axis], this->Shift[axis]);
      }
      v[axis] = Aligned && !Variant && axis > 0 ? Const(batch.FromRow[axis][corner])
                                                : hn::Sub(offset[axis], this->P.Fraction[axis]);
    }
    if constexpr (Variant)
    {
      V index[N];
      for (int axis = 0; axis < N; ++axis)
      {
        index[axis] = v[axis];
      }
      this->ToPlace(index, v);
      for (int axis = 0; axis < N && this->Setup.JitterRadius > 0.0f; ++axis)
      {
        v[axis] = hn::Add(v[axis], Const(batch.Jitter[axis][corner]));
      }
    }

    // Along the flow and across it: s, and t as a vector (in 2D as a number along the normal n).
    V s = Dot(v, this->F.U);
    V t[N];
    if constexpr (N == 2)
    {
      // u x v for a far corner is a small difference of large products. The high parts of u have
      // 16 bits, so their products with corners and the difference are exact.
      t[0] = Variant ? hn::MulSub(this->F.U[0], v[1], hn::Mul(this->F.U[1], v[0]))
                     : hn::Add(hn::NegMulAdd(this->F.UHigh[1], offset[0],
                                 hn::Mul(this->F.UHigh[0], offset[1])),
                         hn::NegMulAdd(this->F.ULow[1], offset[0],
                           hn::MulSub(this->F.ULow[0], offset[1], this->CrossFraction)));
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
    if constexpr (Variant)
    {
      if (this->Params.Motion)
      {
        s = hn::MulAdd(hn::Mul(Const(batch.Travel[corner]), this->F.Sense),
          hn::Div(Const(1.0f), this->RootAlong), s);
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
    V weight = this->GetWindow(batch, corner, v);

    V amplified = weight;
    if constexpr (Variant)
    {
      const V amplitude = Const(batch.Amplitude[corner]);
      if (this->Params.Surflet == Basis::Streaks)
      {
        this->AddStreak(amplitude, weight, s, across2);
        return;
      }
      if (this->Params.AnisotropicWeight)
      {
        weight = hn::Mul(weight, FadeOf(this->Params.Interpolant, q));
      }
      amplified = hn::Mul(amplitude, weight);
      if (this->Params.Surflet == Basis::Value)
      {
        this->Total.Noise =
          hn::MulAdd(amplified, Const(batch.Gradient[0][corner]), this->Total.Noise);
        this->Total.Variance =
          hn::MulAdd(hn::Mul(weight, weight), Const(1.0f / 3.0f), this->Total.Variance);
        this->Total.Weight = hn::Add(this->Total.Weight, weight);
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
    for (int axis = 0; axis < N; ++axis)
    {
      g[axis] = Const(batch.Gradient[axis][corner]);
    }
    this->Total.Noise = hn::MulAdd(amplified, Dot(g, Gv), this->Total.Noise);
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

  WALK_INLINE void AddStreak(V amplitude, V window, V s, V across2)
  {
    const V sigma = hn::Neg(hn::Mul(s, this->RootAlong));
    const V across = hn::Sqrt(hn::Max(across2, Const(0.0f)));
    const V profile = hn::Mul(hn::Mul(window, this->F.Sense),
      hn::Mul(StreakProfile(sigma), FadeOf(this->Params.Interpolant, across)));
    const auto density = static_cast<float>(this->Params.Density);
    this->Total.Noise = hn::MulAdd(amplitude, profile, this->Total.Noise);
    this->Total.Variance =
      hn::MulAdd(hn::Mul(Const(density), profile), profile, this->Total.Variance);
    this->Total.Weight = hn::Add(this->Total.Weight, profile);
  }

  /// Samples that are farther apart than this, as their surflets see it, do not share a batch.
  static constexpr float LargestSpread = 2.0f;

  const NoiseSetup& Setup;
  const NoiseParameters& Params;
  const OctaveSetup& Octave;
  const Frame<N>& F;
  const Places<N>& P;
  V InverseReach;
  V RootAlong;
  V CrossFraction;
  /// The cell that offsets count from, and the samples' own cells from there.
  std::uint32_t Cell[N];
  V Shift[N];
  Sums Total;
  std::uint64_t Visited = 0;
};
