// SPDX-FileCopyrightText: Copyright (c) The SteerableNoise authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file  LatticeBoltzmann.h
 * @brief Two-dimensional flow past a circular cylinder by the lattice-Boltzmann method.
 *
 * Makes the sample data of this project and nothing else: one geometry, one resolution that shows
 * a von Karman vortex street in a few seconds on one core. No VTK in here.
 *
 * Results are in physical units: the diameter D of the cylinder and the speed U of the inflow
 * are 1, so times are in D/U. Inside, one cell and one step are 1 ("lattice units").
 */
#ifndef steerable_data_LatticeBoltzmann_h
#define steerable_data_LatticeBoltzmann_h

#include <array>
#include <cstddef>
#include <vector>

namespace steerable::data
{

/// What is simulated. The defaults are those of the stored file.
struct CylinderWakeParameters
{
  int Width = 400;             ///< cells along the flow
  int Height = 160;            ///< cells across the flow
  int Outflow = 60;            ///< cells behind Width, not returned: the boundary bends vortices
  int Diameter = 20;           ///< cells across the cylinder
  double Reynolds = 150.0;     ///< U D / viscosity
  double LatticeSpeed = 0.125; ///< U in cells per step; the error of compressibility is its square
  double CenterX = 5.0;        ///< of the cylinder, in D from the left
  double CenterY = 4.0;        ///< of the cylinder, in D from the bottom

  /// Throws std::invalid_argument if the numbers make no stable or no meaningful run.
  void Validate() const;
};

/**
 * D2Q9 lattice with two relaxation times, inflow on the left, outflow on the right, free slip at
 * the bottom and the top. The wake starts with a transverse wave, so that it sheds at once.
 */
class CylinderWake
{
public:
  explicit CylinderWake(const CylinderWakeParameters& parameters = {});

  /// Advance by a number of lattice steps.
  void Advance(int steps);

  /// Advance to the first step at or after a time.
  void AdvanceTo(double time);

  /// Duration of one lattice step, in D/U.
  double GetTimeStep() const;

  /// Time since the start, in D/U.
  double GetTime() const;

  /// Three components (the last is 0) per cell, x fastest, in units of U; 0 in the cylinder.
  std::vector<float> GetVelocity() const;

  /// 1 for the cells whose centre is in the cylinder, else 0; x fastest.
  const std::vector<unsigned char>& GetSolid() const { return this->Solid; }

  /// Coefficients 2 F / (density U^2 D) of the force on the cylinder, one value per step.
  const std::vector<double>& GetLift() const { return this->Lift; }
  const std::vector<double>& GetDrag() const { return this->Drag; }

  /// Mean of density - 1 over the fluid cells, in lattice units: how far mass has drifted.
  double GetMeanDensityDeviation() const;

private:
  static constexpr int Q = 9;

  /// One population array per velocity, each with a frame of ghost cells.
  using Populations = std::array<std::vector<float>, Q>;

  /// A straight piece from the centre of a fluid cell to that of a solid neighbour.
  struct Link
  {
    std::size_t Fluid;  ///< the fluid cell
    std::size_t Solid;  ///< its solid neighbour
    std::size_t Behind; ///< the fluid cell on the other side
    int Direction;      ///< the lattice velocity from Fluid to Solid
    float Fraction;     ///< where the wall cuts the link: 0 at Fluid, 1 at Solid
  };

  std::size_t Index(int x, int y) const;
  void FindCylinder();
  void Initialize();
  void ApplyBoundaries();
  void BounceOffCylinder();
  void StreamAndCollide();

  CylinderWakeParameters Parameters;
  int LatticeWidth;      ///< Width and Outflow
  std::ptrdiff_t Stride; ///< cells in a row of the lattice, ghosts included
  Populations Current;
  Populations Next;
  std::array<std::vector<float>, Q> Outlet; ///< populations that come in from the right
  std::vector<unsigned char> Solid;
  std::vector<std::size_t> SolidCells;
  std::vector<Link> Links;
  std::vector<double> Lift;
  std::vector<double> Drag;
};

/**
 * Mean period of an oscillating series, in samples, from the first to the last upward crossing of
 * its mean, each interpolated linearly. 0 if there are fewer than two crossings. Values before
 * `first` are ignored. `periods` receives the number of whole periods found.
 */
double MeasurePeriod(const std::vector<double>& series, std::size_t first, int* periods = nullptr);

} // namespace steerable::data

#endif
