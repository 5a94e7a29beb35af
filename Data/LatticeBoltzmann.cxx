// SPDX-FileCopyrightText: Copyright (c) The SteerableNoise authors
// SPDX-License-Identifier: BSD-3-Clause

// Sources, by the names used below:
//  He & Luo      X. He, L.-S. Luo, J. Stat. Phys. 88 (1997): incompressible equilibrium
//  Skordos       P. A. Skordos, Phys. Rev. E 48 (1993): store populations minus their rest value
//  Ginzburg      I. Ginzburg, F. Verhaeghe, D. d'Humieres, Commun. Comput. Phys. 3 (2008): TRT
//  Ladd          A. J. C. Ladd, J. Fluid Mech. 271 (1994): bounce-back at a moving wall, and the
//                force by momentum exchange
//  Bouzidi       M. Bouzidi, M. Firdaouss, P. Lallemand, Phys. Fluids 13 (2001): curved walls
//  Geier         M. Geier et al., Comput. Math. Appl. 70 (2015), appendix F: outflow

#include "LatticeBoltzmann.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace steerable::data
{

namespace
{
// The nine velocities: rest, then pairs of opposite ones.
enum Direction
{
  O,
  E,
  W,
  N,
  S,
  NE,
  SW,
  SE,
  NW
};
constexpr int CX[9] = { 0, 1, -1, 0, 0, 1, -1, 1, -1 };
constexpr int CY[9] = { 0, 0, 0, 1, -1, 1, -1, -1, 1 };
constexpr int Opposite[9] = { O, W, E, S, N, SW, NE, NW, SE };
constexpr float Weight[9] = { 4.f / 9, 1.f / 9, 1.f / 9, 1.f / 9, 1.f / 9, 1.f / 36, 1.f / 36,
  1.f / 36, 1.f / 36 };

constexpr double Pi = 3.14159265358979323846;

// Equilibrium of He & Luo minus the rest value (Skordos). The density multiplies no velocity, so
// that pressure waves do not leak into the divergence; `density` is the deviation from 1.
float Equilibrium(int i, float density, float ux, float uy)
{
  const float cu = CX[i] * ux + CY[i] * uy;
  return Weight[i] * (density + 3.f * cu + 4.5f * cu * cu - 1.5f * (ux * ux + uy * uy));
}
} // namespace

//------------------------------------------------------------------------------
void CylinderWakeParameters::Validate() const
{
  if (this->Diameter < 8)
  {
    throw std::invalid_argument("Diameter must be at least 8 cells to resolve the boundary layer.");
  }
  if (!(this->Reynolds > 0.0) || !(this->LatticeSpeed > 0.0 && this->LatticeSpeed <= 0.2))
  {
    throw std::invalid_argument("Reynolds must be positive and LatticeSpeed in (0, 0.2].");
  }
  if (this->Outflow < 0)
  {
    throw std::invalid_argument("Outflow must not be negative.");
  }
  // Two cells of fluid on every side: a link looks one cell behind itself.
  const double reach = 0.5 + 2.0 / this->Diameter;
  const double width = static_cast<double>(this->Width) / this->Diameter;
  const double height = static_cast<double>(this->Height) / this->Diameter;
  if (!(this->CenterX >= reach && this->CenterX <= width - reach && this->CenterY >= reach &&
        this->CenterY <= height - reach))
  {
    throw std::invalid_argument("The cylinder must lie inside the domain; move it or enlarge it.");
  }
}

//------------------------------------------------------------------------------
CylinderWake::CylinderWake(const CylinderWakeParameters& parameters)
  : Parameters(parameters)
  , LatticeWidth(parameters.Width + parameters.Outflow)
  , Stride(this->LatticeWidth + 2)
{
  this->Parameters.Validate();
  const std::size_t cells = static_cast<std::size_t>(this->Stride) * (parameters.Height + 2);
  for (int i = 0; i < Q; ++i)
  {
    this->Current[i].assign(cells, 0.f);
    this->Next[i].assign(cells, 0.f);
  }
  this->FindCylinder();
  this->Initialize();
}

//------------------------------------------------------------------------------
std::size_t CylinderWake::Index(int x, int y) const
{
  return static_cast<std::size_t>((y + 1) * this->Stride + (x + 1));
}

//------------------------------------------------------------------------------
void CylinderWake::FindCylinder()
{
  const int width = this->Parameters.Width;
  const int height = this->Parameters.Height;
  // Cell centres are at whole numbers here, hence the half.
  const double centerX = this->Parameters.CenterX * this->Parameters.Diameter - 0.5;
  const double centerY = this->Parameters.CenterY * this->Parameters.Diameter - 0.5;
  const double radius = 0.5 * this->Parameters.Diameter;
  auto inside = [&](int x, int y)
  { return (x - centerX) * (x - centerX) + (y - centerY) * (y - centerY) < radius * radius; };

  this->Solid.assign(static_cast<std::size_t>(width) * height, 0);
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      if (inside(x, y))
      {
        this->Solid[static_cast<std::size_t>(y) * width + x] = 1;
        this->SolidCells.push_back(this->Index(x, y));
        continue;
      }
      for (int i = 1; i < Q; ++i)
      {
        if (!inside(x + CX[i], y + CY[i]))
        {
          continue;
        }
        // First root of |(x, y) + q c - center| = radius.
        const double dx = x - centerX;
        const double dy = y - centerY;
        const double a = CX[i] * CX[i] + CY[i] * CY[i];
        const double b = dx * CX[i] + dy * CY[i];
        const double c = dx * dx + dy * dy - radius * radius;
        const double q = (-b - std::sqrt(b * b - a * c)) / a;
        this->Links.push_back({ this->Index(x, y), this->Index(x + CX[i], y + CY[i]),
          this->Index(x - CX[i], y - CY[i]), i, static_cast<float>(q) });
      }
    }
  }
}

//------------------------------------------------------------------------------
void CylinderWake::Initialize()
{
  // Uniform flow sheds only after rounding errors have grown for a hundred D/U. A wave in the wake,
  // about as long as the street's own, shortens that to a few periods. It is made from a stream
  // function, for divergence would start sound that echoes between the sides for long:
  // psi = amplitude / k cos(k x) exp(-y^2) (1 - exp(-x^2)), u += d psi/dy, v -= d psi/dx.
  constexpr double k = 2.0 * Pi / 5.0; // wave number, in 1/D
  constexpr double amplitude = 0.3;    // in U
  const double cell = 1.0 / this->Parameters.Diameter;
  const double speed = this->Parameters.LatticeSpeed;
  for (int y = 0; y < this->Parameters.Height; ++y)
  {
    for (int x = 0; x < this->LatticeWidth; ++x)
    {
      const double dx = std::max((x + 0.5) * cell - this->Parameters.CenterX, 0.0);
      const double dy = (y + 0.5) * cell - this->Parameters.CenterY;
      const double fade = std::exp(-dx * dx);
      const double scale = amplitude / k * std::exp(-dy * dy);
      const double u = -2.0 * dy * scale * std::cos(k * dx) * (1.0 - fade);
      const double v =
        scale * (k * std::sin(k * dx) * (1.0 - fade) - 2.0 * dx * std::cos(k * dx) * fade);
      const float ux = static_cast<float>(speed * (1.0 + u));
      const float uy = static_cast<float>(speed * v);
      for (int i = 0; i < Q; ++i)
      {
        this->Current[i][this->Index(x, y)] = Equilibrium(i, 0.f, ux, uy);
      }
    }
  }
  for (const int i : { W, NW, SW })
  {
    this->Outlet[i].assign(static_cast<std::size_t>(this->Parameters.Height),
      Equilibrium(i, 0.f, static_cast<float>(this->Parameters.LatticeSpeed), 0.f));
  }
}

//------------------------------------------------------------------------------
// StreamAndCollide pulls the population i of a cell from the neighbour at -c_i, whatever that
// neighbour is. So a boundary condition is a value written into the ghost or solid cell it is
// pulled from, and the inner loop has no branches. Every such slot is read by one fluid cell.
void CylinderWake::ApplyBoundaries()
{
  const int width = this->LatticeWidth;
  const int height = this->Parameters.Height;
  const float speed = static_cast<float>(this->Parameters.LatticeSpeed);
  Populations& f = this->Current;

  // Inflow: bounce-back from a wall half a cell outside that moves with U (Ladd), which fixes the
  // flux. The diagonal slot is pulled one row further up or down, hence the shift.
  for (int y = 0; y < height; ++y)
  {
    f[E][this->Index(-1, y)] = f[W][this->Index(0, y)] + 6.f * Weight[E] * speed;
    f[NE][this->Index(-1, y - 1)] = f[SW][this->Index(0, y)] + 6.f * Weight[NE] * speed;
    f[SE][this->Index(-1, y + 1)] = f[NW][this->Index(0, y)] + 6.f * Weight[SE] * speed;
  }

  // Outflow: populations cross the boundary at the speed of an upstream-going sound wave, which
  // lets waves and vortices leave (Geier).
  const float rate = std::sqrt(1.f / 3.f) - speed;
  for (const int i : { W, NW, SW })
  {
    for (int y = 0; y < height; ++y)
    {
      float& outlet = this->Outlet[i][static_cast<std::size_t>(y)];
      outlet += rate * (f[i][this->Index(width - 1, y)] - outlet);
      f[i][this->Index(width, y)] = outlet;
    }
  }

  // Free slip: mirror the outermost rows, the ghost cells of the outflow included; those of the
  // inflow have their corners already.
  for (int x = 0; x <= width; ++x)
  {
    const std::size_t bottom = this->Index(x, -1);
    const std::size_t top = this->Index(x, height);
    f[N][bottom] = f[S][this->Index(x, 0)];
    f[NE][bottom] = f[SE][this->Index(x, 0)];
    f[NW][bottom] = f[SW][this->Index(x, 0)];
    f[S][top] = f[N][this->Index(x, height - 1)];
    f[SE][top] = f[NE][this->Index(x, height - 1)];
    f[SW][top] = f[NW][this->Index(x, height - 1)];
  }

  this->BounceOffCylinder();
}

//------------------------------------------------------------------------------
void CylinderWake::BounceOffCylinder()
{
  // The inner loop also runs over solid cells; keep them at rest.
  for (const std::size_t cell : this->SolidCells)
  {
    for (int i = 0; i < Q; ++i)
    {
      this->Current[i][cell] = 0.f;
    }
  }

  // A population that leaves towards the wall comes back reversed; where the wall is not half-way,
  // interpolate along the link (Bouzidi, linear).
  double forceX = 0.0;
  double forceY = 0.0;
  for (const Link& link : this->Links)
  {
    const int i = link.Direction;
    const float q = link.Fraction;
    const float leaving = this->Current[i][link.Fluid];
    const float returning = q < 0.5f
      ? 2.f * q * leaving + (1.f - 2.f * q) * this->Current[i][link.Behind]
      : (leaving + (2.f * q - 1.f) * this->Current[Opposite[i]][link.Fluid]) / (2.f * q);
    this->Current[Opposite[i]][link.Solid] = returning;

    // Rest values cancel over the closed surface.
    forceX += CX[i] * (leaving + returning);
    forceY += CY[i] * (leaving + returning);
  }
  const double speed = this->Parameters.LatticeSpeed;
  const double scale = 2.0 / (speed * speed * this->Parameters.Diameter);
  this->Drag.push_back(scale * forceX);
  this->Lift.push_back(scale * forceY);
}

//------------------------------------------------------------------------------
void CylinderWake::StreamAndCollide()
{
  // Two relaxation times (Ginzburg): the even one is the viscosity; the odd one follows from the
  // product of both, 3/16, which puts a straight wall half-way independently of the viscosity.
  const double viscosity =
    this->Parameters.LatticeSpeed * this->Parameters.Diameter / this->Parameters.Reynolds;
  const double evenTime = 3.0 * viscosity;
  const double oddTime = 3.0 / 16.0 / evenTime;
  const float even = static_cast<float>(1.0 / (evenTime + 0.5));
  const float odd = static_cast<float>(1.0 / (oddTime + 0.5));

  const int width = this->LatticeWidth;
  for (int y = 0; y < this->Parameters.Height; ++y)
  {
    const float* __restrict in[Q];
    float* __restrict out[Q];
    for (int i = 0; i < Q; ++i)
    {
      in[i] = this->Current[i].data() + this->Index(-CX[i], y - CY[i]);
      out[i] = this->Next[i].data() + this->Index(0, y);
    }

#pragma omp simd
    for (int x = 0; x < width; ++x)
    {
      const float rest = in[O][x];
      const float e = in[E][x], w = in[W][x], n = in[N][x], s = in[S][x];
      const float ne = in[NE][x], sw = in[SW][x], se = in[SE][x], nw = in[NW][x];

      const float density = rest + ((e + w) + (n + s)) + ((ne + sw) + (se + nw));
      const float ux = (e - w) + (ne - sw) + (se - nw);
      const float uy = (n - s) + (ne - sw) - (se - nw);
      const float isotropic = density - 1.5f * (ux * ux + uy * uy);

      out[O][x] = rest - even * (rest - Weight[O] * isotropic);

      auto relax = [&](int i, float forward, float backward, float cu)
      {
        const float evenPart =
          even * (0.5f * (forward + backward) - Weight[i] * (isotropic + 4.5f * cu * cu));
        const float oddPart = odd * (0.5f * (forward - backward) - Weight[i] * 3.f * cu);
        out[i][x] = forward - evenPart - oddPart;
        out[i + 1][x] = backward - evenPart + oddPart;
      };
      relax(E, e, w, ux);
      relax(N, n, s, uy);
      relax(NE, ne, sw, ux + uy);
      relax(SE, se, nw, ux - uy);
    }
  }
}

//------------------------------------------------------------------------------
void CylinderWake::Advance(int steps)
{
  for (int step = 0; step < steps; ++step)
  {
    this->ApplyBoundaries();
    this->StreamAndCollide();
    std::swap(this->Current, this->Next);
  }
}

//------------------------------------------------------------------------------
void CylinderWake::AdvanceTo(double time)
{
  const double step = std::ceil(time / this->GetTimeStep() - 1e-6);
  this->Advance(static_cast<int>(step) - static_cast<int>(this->Lift.size()));
}

//------------------------------------------------------------------------------
double CylinderWake::GetTimeStep() const
{
  return this->Parameters.LatticeSpeed / this->Parameters.Diameter;
}

//------------------------------------------------------------------------------
double CylinderWake::GetTime() const
{
  return static_cast<double>(this->Lift.size()) * this->GetTimeStep();
}

//------------------------------------------------------------------------------
std::vector<float> CylinderWake::GetVelocity() const
{
  std::vector<float> velocity(3 * this->Solid.size(), 0.f);
  const float scale = static_cast<float>(1.0 / this->Parameters.LatticeSpeed);
  std::size_t cell = 0;
  for (int y = 0; y < this->Parameters.Height; ++y)
  {
    for (int x = 0; x < this->Parameters.Width; ++x, ++cell)
    {
      if (this->Solid[cell])
      {
        continue;
      }
      for (int i = 1; i < Q; ++i)
      {
        const float f = this->Current[i][this->Index(x, y)];
        velocity[3 * cell] += scale * CX[i] * f;
        velocity[3 * cell + 1] += scale * CY[i] * f;
      }
    }
  }
  return velocity;
}

//------------------------------------------------------------------------------
double CylinderWake::GetMeanDensityDeviation() const
{
  double sum = 0.0;
  std::size_t cell = 0;
  for (int y = 0; y < this->Parameters.Height; ++y)
  {
    for (int x = 0; x < this->Parameters.Width; ++x, ++cell)
    {
      for (int i = 0; i < Q && !this->Solid[cell]; ++i)
      {
        sum += this->Current[i][this->Index(x, y)];
      }
    }
  }
  return sum / static_cast<double>(this->Solid.size() - this->SolidCells.size());
}

//------------------------------------------------------------------------------
double MeasurePeriod(const std::vector<double>& series, std::size_t first, int* periods)
{
  double mean = 0.0;
  for (std::size_t k = first; k < series.size(); ++k)
  {
    mean += series[k] / static_cast<double>(series.size() - first);
  }

  int crossings = 0;
  double begin = 0.0;
  double end = 0.0;
  for (std::size_t k = first + 1; k < series.size(); ++k)
  {
    const double before = series[k - 1] - mean;
    const double after = series[k] - mean;
    if (before < 0.0 && after >= 0.0)
    {
      end = static_cast<double>(k - 1) + before / (before - after);
      begin = crossings == 0 ? end : begin;
      ++crossings;
    }
  }
  if (periods)
  {
    *periods = std::max(crossings - 1, 0);
  }
  return crossings > 1 ? (end - begin) / (crossings - 1) : 0.0;
}

} // namespace steerable::data
