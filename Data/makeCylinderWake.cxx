// SPDX-FileCopyrightText: Copyright (c) The SteerableNoise authors
// SPDX-License-Identifier: BSD-3-Clause

// Simulates the cylinder wake and writes one step, or several over one shedding period.
//
//   makeCylinderWake OUTPUT_DIR [--steps N]
//
// N = 1 (the default) writes cylinder_wake.vti, the file stored beside this one. N > 1 writes
// cylinder_wake_<step>.vti and the collection cylinder_wake.pvd; the step after the last would be
// the first again, so that an animation over all steps loops.

#include "LatticeBoltzmann.h"

#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace
{
// In D/U. The sound of the first vortices that leave the domain has died down by then.
constexpr double SpinUp = 70.0;
// At least five periods.
constexpr double Measured = 32.0;

constexpr const char* Usage = "Usage: makeCylinderWake OUTPUT_DIR [--steps N]\n"
                              "  OUTPUT_DIR  where the files go; made if missing\n"
                              "  --steps N   time steps over one shedding period, default 1\n";

// Round to 13 bits of mantissa, far below the error of the simulation: zlib then saves a third.
float Round(float value)
{
  constexpr std::uint32_t dropped = 23 - 13;
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  bits += 1u << (dropped - 1);
  bits &= ~((1u << dropped) - 1u);
  std::memcpy(&value, &bits, sizeof(bits));
  return value;
}

void Write(const steerable::data::CylinderWake& wake,
  const steerable::data::CylinderWakeParameters& parameters, const std::filesystem::path& path)
{
  const std::vector<float> velocity = wake.GetVelocity();
  const std::vector<unsigned char>& solid = wake.GetSolid();

  vtkNew<vtkFloatArray> velocityArray;
  velocityArray->SetName("velocity");
  velocityArray->SetNumberOfComponents(3);
  velocityArray->SetNumberOfTuples(static_cast<vtkIdType>(solid.size()));
  std::transform(velocity.begin(), velocity.end(), velocityArray->GetPointer(0), Round);

  vtkNew<vtkUnsignedCharArray> solidArray;
  solidArray->SetName("solid");
  solidArray->SetNumberOfTuples(static_cast<vtkIdType>(solid.size()));
  std::copy(solid.begin(), solid.end(), solidArray->GetPointer(0));

  const double spacing = 1.0 / parameters.Diameter;
  vtkNew<vtkImageData> image;
  image->SetDimensions(parameters.Width + 1, parameters.Height + 1, 1);
  image->SetSpacing(spacing, spacing, spacing);
  image->GetCellData()->SetVectors(velocityArray);
  image->GetCellData()->AddArray(solidArray);

  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(path.string().c_str());
  writer->SetInputData(image);
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(9);
  // Inline: ParaView 5.11 with Debian 12's libexpat of today cannot read appended data.
  writer->SetDataModeToBinary();
  // One block per array compresses best.
  writer->SetBlockSize(1u << 20);
  if (!writer->Write())
  {
    throw std::runtime_error("Cannot write " + path.string() + ".");
  }
  std::cout << path.string() << ": t = " << wake.GetTime() << ", "
            << std::filesystem::file_size(path) << " bytes\n";
}

void Run(const std::filesystem::path& folder, int steps)
{
  std::filesystem::create_directories(folder);

  const steerable::data::CylinderWakeParameters parameters;
  steerable::data::CylinderWake wake(parameters);
  wake.AdvanceTo(SpinUp);
  const std::size_t first = wake.GetLift().size();
  wake.AdvanceTo(SpinUp + Measured);

  int periods = 0;
  const double period =
    steerable::data::MeasurePeriod(wake.GetLift(), first, &periods) * wake.GetTimeStep();
  if (!(period > 0.0))
  {
    throw std::runtime_error("The wake does not shed vortices.");
  }
  double drag = 0.0;
  for (std::size_t k = first; k < wake.GetDrag().size(); ++k)
  {
    drag += wake.GetDrag()[k] / static_cast<double>(wake.GetDrag().size() - first);
  }
  std::cout << "Reynolds number " << parameters.Reynolds << ", Strouhal number " << 1.0 / period
            << " (period " << period << " D/U, mean of " << periods << "), mean drag coefficient "
            << drag << "\n";

  if (steps == 1)
  {
    Write(wake, parameters, folder / "cylinder_wake.vti");
    return;
  }

  std::ofstream collection(folder / "cylinder_wake.pvd");
  collection << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
             << "  <Collection>\n";
  for (int step = 0; step < steps; ++step)
  {
    const double time = period * step / steps;
    wake.AdvanceTo(SpinUp + Measured + time);
    const std::string name = "cylinder_wake_" + std::to_string(step) + ".vti";
    Write(wake, parameters, folder / name);
    collection << "    <DataSet timestep=\"" << time << "\" part=\"0\" file=\"" << name << "\"/>\n";
  }
  collection << "  </Collection>\n</VTKFile>\n";
  if (!collection.flush())
  {
    throw std::runtime_error("Cannot write " + (folder / "cylinder_wake.pvd").string() + ".");
  }
}
} // namespace

int main(int argc, char* argv[])
{
  std::string folder;
  int steps = 1;
  try
  {
    for (int i = 1; i < argc; ++i)
    {
      const std::string argument = argv[i];
      if (argument == "--steps" && i + 1 < argc)
      {
        steps = std::stoi(argv[++i]);
      }
      else if (folder.empty() && argument.compare(0, 1, "-") != 0)
      {
        folder = argument;
      }
      else
      {
        std::cerr << Usage;
        return 1;
      }
    }
    if (folder.empty() || steps < 1)
    {
      std::cerr << Usage;
      return 1;
    }
  }
  catch (const std::logic_error&) // from stoi: not a number, or one out of range
  {
    std::cerr << Usage;
    return 1;
  }

  try
  {
    Run(folder, steps);
  }
  catch (const std::exception& error)
  {
    std::cerr << "makeCylinderWake: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
