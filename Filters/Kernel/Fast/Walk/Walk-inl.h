// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The sum over corners for any Quality and any variant: the order of the stages.
 *
 * Neighbouring samples are reached by the same corners. So they are listed once for a tile of
 * several registers of samples, with a register of corners at a time: first the lattice rows, then
 * the corners on them with their gradients. Then each register of samples finds out which of the
 * corners reach it, again for a register of corners at a time, and takes those one by one.
 * Registers that differ too much do not share a list; samples of a register that lie apart have
 * rows in common only and go to their own corners.
 */
#if defined(STEERABLE_FAST_WALK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_INL_H
#undef STEERABLE_FAST_WALK_INL_H
#else
#define STEERABLE_FAST_WALK_INL_H
#endif

#include "Fast/Walk/Surflet-inl.h"
#include "Fast/Walk/View-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
template <int N, WalkKind Kind>
class Walk
{
public:
  STAGE_INLINE Walk(const NoiseSetup& setup, const OctaveSetup& octave, const MetricBlock& block)
    : Setup(setup, octave, block)
  {
  }

  /// Sums up a tile; returns how many corners its samples visited.
  STAGE_INLINE std::uint64_t Evaluate(const Tile& tile)
  {
    this->Visited = 0;
    this->Samples = &tile;
    this->Started = 0;
    // Neighbouring tiles are alike: begin with spans that were small enough for the last one, and
    // after one with room to spare with larger ones.
    this->Splits = 0;
    this->Widest = 0.0f;
    this->AddParts(0, tile.Registers, this->Parts);
    if (this->Splits > 0)
    {
      this->Parts = std::min(2 * this->Parts, TileRegisters);
    }
    else if (this->Widest < 0.4f * LargestSpread)
    {
      this->Parts = std::max<std::size_t>(1, this->Parts / 2);
    }
    return this->Visited;
  }

  STAGE_INLINE V GetNoise(std::size_t r) const
  {
    return Normalized(this->Setup.Setup, N,
      GetSums<N>(this->Setup, this->Samples->First[r], this->GetTotal(r)));
  }

private:
  // ---- which registers share a list -------------------------------------------------------------

  STAGE_INLINE SurfletSums<N> GetTotal(std::size_t r) const
  {
    return (this->Started >> r & 1) != 0 ? SurfletSums<N>(this->Total[r]) : SurfletSums<N>();
  }
  STAGE_INLINE void SetTotal(std::size_t r, const SurfletSums<N>& sums)
  {
    this->Started |= std::uint64_t(1) << r;
    sums.Store(this->Total[r]);
  }

  /// Halves of registers, whole columns if there are several.
  std::size_t GetMiddle(std::size_t begin, std::size_t end) const
  {
    const std::size_t perColumn = this->Samples->PerColumn;
    const std::size_t unit = end - begin > perColumn ? perColumn : 1;
    return begin + (end - begin + unit) / (2 * unit) * unit;
  }

  /// Registers [begin, end) as this many spans, a power of 2.
  STAGE_INLINE void AddParts(std::size_t begin, std::size_t end, std::size_t parts)
  {
    std::size_t ends[TileRegisters + 1] = { begin, end };
    std::size_t count = 1;
    for (; count < parts; count *= 2)
    {
      for (std::size_t i = count; i > 0; --i)
      {
        ends[2 * i] = ends[i];
        ends[2 * i - 1] = this->GetMiddle(ends[i - 1], ends[i]);
      }
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      if (ends[i] < ends[i + 1])
      {
        this->AddSpan(ends[i], ends[i + 1]);
      }
    }
  }

  /// Registers [begin, end): together if they are alike, else half by half.
  HWY_NOINLINE void AddSpan(std::size_t begin, std::size_t end)
  {
    const SpanCorners corners(*this->Samples, begin, end);
    VU origin[N];
    Group<N> group;
    Extent extent;
    FitGroup(this->Setup, *this->Samples, corners, begin, end, origin, group, extent);
    if (hn::GetLane(group.PlaceRest) < LargestSpread) // else it cannot be
    {
      FinishGroup(this->Setup, *this->Samples, corners, begin, end, extent, group);
      const V row = this->Setup.IsOblique() ? hn::Zero(DF()) : hn::Abs(group.PlaceStep[0][0]);
      const Reach<N> reach(group, extent, row);
      const float wider = hn::GetLane(reach.LargestWidth) - extent.HalfWidth;
      if (wider < (end - begin > 1 ? LargestSpread : LargestAlone) &&
        hn::GetLane(reach.Spread) < LargestExtent)
      {
        this->Widest = std::max(this->Widest, wider);
        this->AddTogether(
          Span<N>(*this->Samples, corners, begin, end, group, extent), reach, origin);
        return;
      }
    }
    if (end - begin > 1)
    {
      ++this->Splits;
      const std::size_t middle = this->GetMiddle(begin, end);
      this->AddSpan(begin, middle);
      this->AddSpan(middle, end);
    }
    else
    {
      this->AddApart(begin);
    }
  }

  HWY_NOINLINE void AddTogether(
    const Span<N>& span, const Reach<N>& reach, const VU (&origin)[N])
  {
    HWY_ALIGN std::int32_t rowY[ListSize];
    HWY_ALIGN std::int32_t rowZ[ListSize];
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    std::size_t rows = 0;
    CornerList<N> list;
    const IndexAxis axisY = GetIndexAxis(this->Setup, reach, 1);
    const V length = hn::Add(reach.Length, Const(this->Setup.Setup.JitterRadius));
    V first;
    V last;
    const auto addRows = [&](int y, int lastY, int z) HWY_ATTR
    {
      for (; y <= lastY; y += static_cast<int>(Lanes))
      {
        if (rows + Lanes > ListSize)
        {
          this->AddRows(span, reach, origin, rowY, rowZ, rows, list);
          rows = 0;
        }
        hn::StoreU(RampInt(y), DI(), rowY + rows);
        hn::StoreU(hn::Set(DI(), z), DI(), rowZ + rows);
        rows += static_cast<std::size_t>(std::min(static_cast<int>(Lanes), lastY - y + 1));
      }
    };
    if constexpr (N == 2)
    {
      GetRange(this->Setup, reach, 1, axisY, hn::Neg(length), length, first, last);
      addRows(ToCorner(hn::GetLane(first)), ToCorner(hn::GetLane(last)), 0);
    }
    else
    {
      const IndexAxis axisZ = GetIndexAxis(this->Setup, reach, 2);
      GetRange(this->Setup, reach, 2, axisZ, hn::Neg(length), length, first, last);
      const int lastZ = ToCorner(hn::GetLane(last));
      for (int z = ToCorner(hn::GetLane(first)); z <= lastZ; z += static_cast<int>(Lanes))
      {
        V low;
        V high;
        GetInterval(this->Setup, reach, 2, axisZ, Ramp(static_cast<float>(z)), low, high);
        GetRange(this->Setup, reach, 1, axisY, low, high, first, last);
        hn::Store(ToCorners(first), DI(), firsts);
        hn::Store(ToCorners(last), DI(), lasts);
        for (int i = 0; i < static_cast<int>(Lanes) && z + i <= lastZ; ++i)
        {
          addRows(firsts[i], lasts[i], z + i);
        }
      }
    }
    this->AddRows(span, reach, origin, rowY, rowZ, rows, list);
    Sift(this->Setup, span, reach, list);
    this->AddCorners(span, origin, list);
  }

  /// Puts the corners of these rows on the list.
  HWY_NOINLINE void AddRows(const Span<N>& span, const Reach<N>& reach, const VU (&origin)[N],
    std::int32_t* rowY, std::int32_t* rowZ, std::size_t rows, CornerList<N>& list)
  {
    HWY_ALIGN std::int32_t firsts[Lanes];
    HWY_ALIGN std::int32_t lasts[Lanes];
    const IndexAxis axis = GetIndexAxis(this->Setup, reach, 0);
    const IndexAxis axisLast = GetIndexAxis(this->Setup, reach, N - 1);
    RowCutter<N, WalkSetup<N, Kind>> cutter(this->Setup, reach);
    for (std::size_t i = rows; i % Lanes != 0; ++i)
    {
      rowY[i] = rowZ[i] = 0; // lanes that nobody looks at
    }
    for (std::size_t i = 0; i < rows; i += Lanes)
    {
      V low = axis.BoxLow;
      V high = axis.BoxHigh;
      if (this->Setup.Params.AnisotropicWeight)
      {
        const V y = hn::ConvertTo(DF(), hn::LoadU(DI(), rowY + i));
        const V z = hn::ConvertTo(DF(), hn::LoadU(DI(), rowZ + i));
        V begin;
        V end;
        GetInterval(this->Setup, reach, N - 1, axisLast, N == 2 ? y : z, begin, end);
        cutter.SetLayer(z, begin, end);
        cutter.Cut(y, low, high);
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
            Sift(this->Setup, span, reach, list);
            if (2 * list.Count > ListSize)
            {
              this->AddCorners(span, origin, list);
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

  // ---- samples apart ----------------------------------------------------------------------------

  /// Rows that samples apart have in common.
  struct RowsApart
  {
    std::size_t Count = 0;
    /// The first corner of each lane, the bits of its row, and the corners of the lane that has
    /// most.
    HWY_ALIGN float First[ListSize][Lanes];
    HWY_ALIGN std::uint32_t Hash[ListSize][Lanes];
    float Y[ListSize];
    float Z[ListSize];
    int Corners[ListSize];
  };

  /// Every sample of a register goes along the same rows, counted from its own cell, by itself.
  HWY_NOINLINE void AddApart(std::size_t r)
  {
    const std::size_t from = this->Samples->First[r];
    VU origin[N];
    for (int axis = 0; axis < N; ++axis)
    {
      origin[axis] = hn::LoadU(DU(), this->Setup.Block.Cell[axis] + from);
    }
    const Reach<N> reach = GetReachApart<N>(this->Setup, from);
    const IndexAxis axisX = GetIndexAxis(this->Setup, reach, 0);
    const IndexAxis axisY = GetIndexAxis(this->Setup, reach, 1);
    const V length = hn::Add(reach.Length, Const(this->Setup.Setup.JitterRadius));
    RowCutter<N, WalkSetup<N, Kind>> cutter(this->Setup, reach);
    RowsApart rows;
    // The rows of a layer from the least of `first` to the greatest of `last`.
    const auto addRows = [&](V low, V high, int z, VU hashZ) HWY_ATTR
    {
      V first;
      V last;
      GetRange(this->Setup, reach, 1, axisY, low, high, first, last);
      if (this->Setup.Params.AnisotropicWeight)
      {
        cutter.SetLayer(Const(static_cast<float>(z)), low, high);
      }
      const auto none = hn::Gt(first, last);
      const int lastY = ToCorner(GreatestLane(hn::IfThenElse(none, Const(-1e9f), last)));
      for (int y = ToCorner(LeastLane(hn::IfThenElse(none, Const(1e9f), first))); y <= lastY; ++y)
      {
        V begin = axisX.BoxLow;
        V end = axisX.BoxHigh;
        if (this->Setup.Params.AnisotropicWeight)
        {
          cutter.Cut(Const(static_cast<float>(y)), begin, end);
        }
        begin = hn::Max(hn::Ceil(begin), Const(-FarthestCorner));
        end = hn::Min(hn::Floor(end), Const(FarthestCorner));
        if (rows.Count == ListSize)
        {
          this->AddRowsApart(r, origin, rows);
        }
        const std::size_t row = rows.Count++;
        hn::Store(begin, DF(), rows.First[row]);
        hn::Store(HashAxis(this->Setup, origin, 1, hn::Set(DI(), y), hashZ), DU(), rows.Hash[row]);
        rows.Y[row] = static_cast<float>(y);
        rows.Z[row] = static_cast<float>(z);
        rows.Corners[row] = static_cast<int>(GreatestLane(hn::Sub(end, begin))) + 1;
      }
    };
    const VU seed = hn::Set(DU(), this->Setup.Octave.Seed);
    if constexpr (N == 2)
    {
      addRows(hn::Neg(length), length, 0, seed);
    }
    else
    {
      const IndexAxis axisZ = GetIndexAxis(this->Setup, reach, 2);
      V first;
      V last;
      GetRange(this->Setup, reach, 2, axisZ, hn::Neg(length), length, first, last);
      const int lastZ = ToCorner(GreatestLane(last));
      for (int z = ToCorner(LeastLane(first)); z <= lastZ; ++z)
      {
        V low;
        V high;
        GetInterval(this->Setup, reach, 2, axisZ, Const(static_cast<float>(z)), low, high);
        addRows(low, high, z, HashAxis(this->Setup, origin, 2, hn::Set(DI(), z), seed));
      }
    }
    this->AddRowsApart(r, origin, rows);
  }

  /// Adds the corners of these rows, and forgets them.
  HWY_NOINLINE void AddRowsApart(std::size_t r, const VU (&origin)[N], RowsApart& rows)
  {
    this->WithKind([&](auto kind) HWY_ATTR
      { this->template AddSurfletsApart<decltype(kind)>(r, origin, rows); });
    rows.Count = 0;
  }

  template <class SurfletsKind>
  HWY_NOINLINE void AddSurfletsApart(std::size_t r, const VU (&origin)[N], const RowsApart& rows)
  {
    const Sample<N> sample(
      this->Setup.Setup, this->Setup.Block, this->Samples->First[r], origin);
    SurfletSums<N> sums = this->GetTotal(r);
    for (std::size_t row = 0; row < rows.Count; ++row)
    {
      V offset[N];
      offset[0] = hn::Load(DF(), rows.First[row]);
      offset[1] = Const(rows.Y[row]);
      if constexpr (N == 3)
      {
        offset[2] = Const(rows.Z[row]);
      }
      const VU hash = hn::Load(DU(), rows.Hash[row]);
      for (int i = 0; i < rows.Corners[row]; ++i)
      {
        // A sample that has no corner here any more is too far from this one.
        const VU bits = HashJoinAxes(HashAxis(this->Setup, origin, 0, ToCorners(offset[0]), hash));
        AddSurflet<SurfletsKind>(this->Setup, sample, Describe(this->Setup, offset, bits), sums);
        offset[0] = hn::Add(offset[0], Const(1.0f));
      }
      this->Visited += static_cast<std::size_t>(std::max(rows.Corners[row], 0)) *
        this->Samples->GetCount(r);
    }
    this->SetTotal(r, sums);
  }

  /// Adds those corners of the list that reach the samples of a span to their sums.
  HWY_NOINLINE void AddCorners(
    const Span<N>& span, const VU (&origin)[N], CornerList<N>& list)
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
      const VU hash = HashCorners(this->Setup, origin, corner);
      Put(this->Setup, Describe(this->Setup, offset, hash), list, i);
    }
    ListBits reaching[TileRegisters];
    SetReaching(this->Setup, span, list, reaching);
    for (std::size_t r = span.Begin; r < span.End; ++r)
    {
      for (std::uint64_t bits : reaching[r])
      {
        this->Visited += this->Samples->GetCount(r) * hwy::PopCount(bits);
      }
      this->WithKind([&](auto kind) HWY_ATTR
        { this->template AddSurflets<decltype(kind)>(r, origin, list, reaching[r]); });
    }
  }

  /// Calls `work` with the kind of surflets that there are.
  template <class Work>
  STAGE_INLINE void WithKind(Work&& work) const
  {
    if constexpr (Kind == WalkKind::Variant)
    {
      return this->template WithSums<true, false>(work); // not worth more code
    }
    else if constexpr (N == 3)
    {
      if (this->Setup.Setup.Biaxial)
      {
        return this->template WithBends<true>(work);
      }
    }
    this->template WithBends<false>(work);
  }

  template <bool Biaxial, class Work>
  STAGE_INLINE void WithBends(Work&& work) const
  {
#ifdef STEERABLENOISE_INSTRUMENTED
    constexpr bool straight = true; // bends of 0
#else
    constexpr bool straight = false;
#endif
    return this->Setup.Setup.Curved ? this->template WithSums<true, Biaxial>(work)
                                    : this->template WithSums<straight, Biaxial>(work);
  }

  template <bool Curved, bool Biaxial, class Work>
  STAGE_INLINE void WithSums(Work&& work) const
  {
    switch (this->Setup.Params.Normalization)
    {
      case Normalization::UnitVariance:
        return work(SurfletKind<Curved, Normalization::UnitVariance, Biaxial>());
      case Normalization::WeightSum:
        return work(SurfletKind<Curved, Normalization::WeightSum, Biaxial>());
      case Normalization::None:
      default:
        return work(SurfletKind<Curved, Normalization::None, Biaxial>());
    }
  }

  /// Adds the corners whose bits are set to register `r`.
  template <class SurfletsKind>
  HWY_NOINLINE void AddSurflets(
    std::size_t r, const VU (&origin)[N], const CornerList<N>& list, const ListBits& reaching)
  {
    const Sample<N> sample(
      this->Setup.Setup, this->Setup.Block, this->Samples->First[r], origin);
    SurfletSums<N> sums = this->GetTotal(r);
    for (std::size_t word = 0; word < ListWords; ++word)
    {
      for (std::uint64_t bits = reaching[word]; bits != 0; bits &= bits - 1)
      {
        const std::size_t i = 64 * word + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
        AddSurflet<SurfletsKind>(this->Setup, sample, Corner<N>(list, i), sums);
      }
    }
    this->SetTotal(r, sums);
  }

  /// Samples that are farther apart than this, as their surflets see it, do not share a list.
  static constexpr float LargestSpread = N == 2 && Kind == WalkKind::Plain ? 2.5f : 1.5f;

  /// A register alone shares its list with no other: from here on its samples are faster apart.
  static constexpr float LargestAlone = std::min(LargestSpread, 0.5f);

  /// Nor do samples this many cells from their middle: distances of corners must keep their
  /// precision.
  static constexpr float LargestExtent = 16.0f;

  const WalkSetup<N, Kind> Setup;
  const Tile* Samples = nullptr;
  std::uint64_t Visited = 0;
  /// Spans that a tile begins with, how often spans were split, and by how much the widest is wider
  /// than a surflet.
  std::size_t Parts = 1;
  std::size_t Splits = 0;
  float Widest = 0.0f;
  /// A bit for each register that any corner was added to.
  std::uint64_t Started = 0;
  typename SurfletSums<N>::Stored Total[TileRegisters];
};
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
