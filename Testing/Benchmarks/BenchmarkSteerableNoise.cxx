// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Speed of steerable noise beside a plain loop, VTK's Perlin noise and VTK's LIC, all in one run.
 *
 * Figures are points per second of thread CPU time. Compare medians of one run with one another: run
 * with --benchmark_repetitions=9 --benchmark_enable_random_interleaving=true, or through
 * Utilities/benchmark.sh, which prints ratios.
 */
#include "LatticeHash.h"
#include "BenchmarkFlow.h"
#include "SteerableNoise.h"
#include "Surflet.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPerlinNoise.h"
#include "vtkPointData.h"
#include "vtkSMPTools.h"
#include "vtkSampleFunction.h"
#include "vtkSteerableNoiseFilter.h"
#ifdef STEERABLENOISE_HAVE_LIC
#include "vtkImageDataLIC2D.h"
#endif

#include <benchmark/benchmark.h>
#include <hwy/targets.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

using namespace steerable;

namespace
{
/// A swirling field on an image of 1/16 cell per sample.
struct Image
{
  ImageGrid Grid;
  std::vector<float> Vectors;
  std::vector<float> Noise;

  explicit Image(int dimension)
  {
    this->Grid.Dimensions = dimension == 2 ? std::array<std::int64_t, 3>{ 1024, 512, 1 }
                                           : std::array<std::int64_t, 3>{ 96, 80, 64 };
    this->Grid.Spacing = { 1.0, 1.0, 1.0 };
    for (std::int64_t k = 0; k < this->Grid.Dimensions[2]; ++k)
    {
      for (std::int64_t j = 0; j < this->Grid.Dimensions[1]; ++j)
      {
        for (std::int64_t i = 0; i < this->Grid.Dimensions[0]; ++i)
        {
          const auto flow = BenchmarkFlow(dimension, i, j, k);
          this->Vectors.insert(this->Vectors.end(), flow.begin(), flow.end());
        }
      }
    }
    this->Noise.resize(this->Vectors.size() / 3);
  }
  static Image& Get(int dimension)
  {
    static Image images[2] = { Image(2), Image(3) };
    return images[dimension - 2];
  }
};

/// The paper's own model, without normalisation and curvature.
NoiseParameters Plain(int quality)
{
  NoiseParameters p;
  p.FeatureSize = 16.0;
  p.LatticeWindow = true;
  p.EigenvalueSum = 4.0;
  p.Quality = quality;
  p.FollowCurvature = false;
  p.Normalization = Normalization::None;
  return p;
}

NoiseParameters Defaults()
{
  NoiseParameters p;
  p.FeatureSize = 16.0;
  return p;
}

void SetPoints(benchmark::State& state, std::size_t count)
{
  state.counters["points"] = benchmark::Counter(
    static_cast<double>(count) * state.iterations(), benchmark::Counter::kIsRate);
}

void RunImage(benchmark::State& state, const NoiseParameters& parameters, int dimension)
{
  Image& image = Image::Get(dimension);
  const ContiguousReader<float, 3> vectors(image.Vectors.data());
  Field field;
  field.Vectors = &vectors;
  const SteerableNoise noise(parameters, dimension);
  for (auto _ : state)
  {
    noise.EvaluateImage(image.Grid, field, 0, image.Grid.GetNumberOfRows(), image.Noise.data());
    benchmark::ClobberMemory();
  }
  SetPoints(state, image.Noise.size());
}

void RunPoints(benchmark::State& state, const NoiseParameters& parameters, int dimension)
{
  constexpr std::size_t count = 1 << 17;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1000.0, 1000.0);
  std::vector<double> positions(3 * count);
  for (double& x : positions)
  {
    x = place(random);
  }
  const ContiguousReader<double, 3> places(positions.data());
  const ContiguousReader<float, 3> vectors(Image::Get(dimension).Vectors.data());
  Field field;
  field.Vectors = &vectors;
  const SteerableNoise noise(parameters, dimension);
  std::vector<float> result(count);
  for (auto _ : state)
  {
    noise.EvaluatePoints(places, field, 0, count, result.data());
    benchmark::ClobberMemory();
  }
  SetPoints(state, count);
}

/// The paper's listing, in float, one point after the other, over the whole box of corners.
template <int N>
float PaperLoop(const float* place, const float* u, int quality)
{
  float length2 = 0.0f;
  for (int i = 0; i < N; ++i)
  {
    length2 += u[i] * u[i];
  }
  const float k = 0.5f / (quality + 1);
  const float b = (4.0f - k) / (N - 1) - 1e-4f;
  const float c = (k - b) / length2;
  int cell[N];
  float f[N];
  for (int i = 0; i < N; ++i)
  {
    cell[i] = static_cast<int>(std::floor(place[i]));
    f[i] = place[i] - cell[i];
  }
  const auto fade = [](float t)
  {
    t = std::abs(t);
    return t < 1.0f ? 1.0f - ((6.0f * t - 15.0f) * t + 10.0f) * t * t * t : 0.0f;
  };
  const float scale = 1.0f / (quality + 1);
  float sum = 0.0f;
  for (int oz = N == 3 ? -quality : 0; oz <= (N == 3 ? quality + 1 : 0); ++oz)
  {
    for (int oy = -quality; oy <= quality + 1; ++oy)
    {
      for (int ox = -quality; ox <= quality + 1; ++ox)
      {
        const int o[3] = { ox, oy, oz };
        const std::uint32_t hash =
          HashCorner(cell[0] + ox, cell[1] + oy, N == 3 ? cell[N - 1] + oz : 0, 0);
        const Vector<N> g = UniformGradient<N>(hash);
        float v[N];
        float along = 0.0f;
        float weight = 1.0f;
        for (int i = 0; i < N; ++i)
        {
          v[i] = o[i] - f[i];
          along += v[i] * u[i];
          weight *= fade(v[i] * scale);
        }
        float q = 0.0f;
        float dot = 0.0f;
        for (int i = 0; i < N; ++i)
        {
          const float Gv = b * v[i] + c * along * u[i];
          q += v[i] * Gv;
          dot += static_cast<float>(g[i]) * Gv;
        }
        sum += weight * fade(q) * dot;
      }
    }
  }
  return sum;
}

template <int N>
void RunPaperLoop(benchmark::State& state, int quality)
{
  Image& image = Image::Get(N);
  const std::size_t rows = std::min<std::size_t>(image.Grid.GetNumberOfRows(), 64);
  const std::int64_t nx = image.Grid.Dimensions[0];
  for (auto _ : state)
  {
    for (std::size_t row = 0; row < rows; ++row)
    {
      for (std::int64_t i = 0; i < nx; ++i)
      {
        const float place[3] = { i / 16.0f, (row % image.Grid.Dimensions[1]) / 16.0f,
          (row / image.Grid.Dimensions[1]) / 16.0f };
        const std::size_t id = row * nx + i;
        image.Noise[id] = PaperLoop<N>(place, image.Vectors.data() + 3 * id, quality);
      }
    }
    benchmark::ClobberMemory();
  }
  SetPoints(state, rows * nx);
}

vtkSmartPointer<vtkImageData> MakeVtkImage(int nx, int ny, int nz)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(nx, ny, nz);
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("v");
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(image->GetNumberOfPoints());
  float* v = vectors->GetPointer(0);
  for (vtkIdType id = 0; id < image->GetNumberOfPoints(); ++id)
  {
    const int i = id % nx;
    const int j = (id / nx) % ny;
    const int k = static_cast<int>(id / nx / ny);
    const auto flow = BenchmarkFlow(nz == 1 ? 2 : 3, i, j, k);
    std::copy(flow.begin(), flow.end(), v + 3 * id);
  }
  image->GetPointData()->SetVectors(vectors);
  return image;
}

/// Where the output of a filter comes from.
enum class Pages
{
  Used,  // memory that was used before
  Fresh, // the system has to make them first
  Small  // the same where there are no large ones
};

/// The whole filter, VTK arrays in and out. Every execution allocates its output anew.
void RunFilter(
  benchmark::State& state, int dimension, bool defaults, int threads, Pages pages = Pages::Used)
{
  prctl(PR_SET_THP_DISABLE, pages == Pages::Small, 0, 0, 0);
  // The largest threshold there is: outputs below it come from the heap, which keeps them, others from the system.
  constexpr int threshold = 1 << 25;
  mallopt(M_MMAP_THRESHOLD, threshold);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  const int rows = pages == Pages::Used ? 2048 : threshold / 8192 + 512;
  auto image = dimension == 2 ? MakeVtkImage(2048, rows, 1) : MakeVtkImage(96, 80, 64);
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetInputData(image);
  filter->SetFeatureSize(16.0);
  if (!defaults)
  {
    filter->LatticeWindowOn();
    filter->SetEigenvalueSum(4.0);
    filter->SetQuality(0);
    filter->SetNormalization(vtkSteerableNoiseFilter::NONE);
    filter->FollowCurvatureOff();
  }
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads, "STDThread", false },
    [&]
    {
      for (auto _ : state)
      {
        filter->Modified();
        filter->Update();
      }
    });
  prctl(PR_SET_THP_DISABLE, 0, 0, 0, 0);
  SetPoints(state, image->GetNumberOfPoints());
}

/// First touch of a fresh output, with and without advice to use huge pages.
void RunColdOutput(benchmark::State& state, bool huge)
{
  Image& image = Image::Get(2);
  const ContiguousReader<float, 3> vectors(image.Vectors.data());
  Field field;
  field.Vectors = &vectors;
  const SteerableNoise noise(Plain(0), 2);
  const std::size_t bytes = (image.Noise.size() * sizeof(float) + (1u << 22)) & ~((1u << 21) - 1);
  for (auto _ : state)
  {
    void* fresh = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (huge)
    {
      madvise(fresh, bytes, MADV_HUGEPAGE);
    }
    noise.EvaluateImage(
      image.Grid, field, 0, image.Grid.GetNumberOfRows(), static_cast<float*>(fresh));
    munmap(fresh, bytes);
  }
  SetPoints(state, image.Noise.size());
}

void RunVtkPerlin(benchmark::State& state)
{
  vtkNew<vtkPerlinNoise> perlin;
  perlin->SetFrequency(1.0, 1.0, 1.0);
  vtkNew<vtkSampleFunction> sample;
  sample->SetImplicitFunction(perlin);
  sample->SetSampleDimensions(64, 64, 64);
  sample->SetModelBounds(0, 4, 0, 4, 0, 4);
  sample->ComputeNormalsOff();
  sample->SetOutputScalarTypeToFloat();
  for (auto _ : state)
  {
    sample->Modified();
    sample->Update();
  }
  SetPoints(state, 64 * 64 * 64);
}

#ifdef STEERABLENOISE_HAVE_LIC
void RunLic(benchmark::State& state)
{
  auto image = MakeVtkImage(512, 512, 1);
  vtkNew<vtkImageDataLIC2D> lic;
  lic->SetInputData(image);
  lic->SetSteps(20);
  for (auto _ : state)
  {
    lic->Modified();
    lic->Update();
  }
  SetPoints(state, 512 * 512);
}
#endif

constexpr std::int64_t Levels[] = { HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SCALAR };

/// What --level chose; 0: the machine's best.
std::int64_t ChosenLevel = 0;

/// Keeps to a SIMD level while it lives.
class LevelForNow
{
public:
  explicit LevelForNow(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~LevelForNow() { hwy::SetSupportedTargetsForTest(ChosenLevel); }
};

void Register(const std::string& name, const std::function<void(benchmark::State&)>& run)
{
  benchmark::RegisterBenchmark(name.c_str(), run);
}

void RegisterAll()
{
  for (const int dimension : { 2, 3 })
  {
    const std::string d = std::to_string(dimension) + "D/";
    for (const int quality : { 0, 1, 2, 4, 8 })
    {
      const std::string q = "Quality" + std::to_string(quality);
      Register("Image/" + d + q, [=](auto& s) { RunImage(s, Plain(quality), dimension); });
      Register("Points/" + d + q, [=](auto& s) { RunPoints(s, Plain(quality), dimension); });
    }
    for (const int quality : { 0, 1, 2 })
    {
      Register("PaperLoop/" + d + "Quality" + std::to_string(quality),
        [=](auto& s)
        { dimension == 2 ? RunPaperLoop<2>(s, quality) : RunPaperLoop<3>(s, quality); });
    }
    Register("Image/" + d + "Defaults", [=](auto& s) { RunImage(s, Defaults(), dimension); });
    const std::pair<const char*, std::function<void(NoiseParameters&)>> options[] = {
      { "Isotropic",
        [](NoiseParameters& p)
        {
          p = Plain(0);
          p.Strength = 0.0;
          p.AnisotropicWeight = false;
        } },
      { "UnitVariance", [](NoiseParameters& p) { p.FollowCurvature = false; } },
      { "Curvature", [](NoiseParameters& p) { p.Normalization = Normalization::None; } },
      { "Motion",
        [](NoiseParameters& p)
        {
          p.Motion = true;
          p.Phase = 0.3;
        } },
      { "Streaks", [](NoiseParameters& p) { p.Basis = Basis::Streaks; } },
      { "Value", [](NoiseParameters& p) { p.Basis = Basis::Value; } },
      { "Octaves3", [](NoiseParameters& p) { p.Octaves = 3; } },
      { "Wide", [](NoiseParameters& p) { p.Fade = Fade::Wide; } },
      { "Jittered", [](NoiseParameters& p) { p.Lattice = Lattice::Jittered; } },
      { "Simplicial", [](NoiseParameters& p) { p.Lattice = Lattice::Simplicial; } },
      { "Radial", [](NoiseParameters& p) { p.Falloff = Falloff::Radial; } },
      { "Perlin", [](NoiseParameters& p) { p.GradientSet = GradientSet::Perlin; } },
    };
    for (const auto& option : options)
    {
      NoiseParameters p = Defaults();
      option.second(p);
      Register("Option/" + d + option.first, [=](auto& s) { RunImage(s, p, dimension); });
    }
    for (const int threads : { 1, 2 })
    {
      const std::string t = "Threads" + std::to_string(threads);
      for (const bool defaults : { false, true })
      {
        benchmark::RegisterBenchmark(
          ("Filter/" + d + (defaults ? "Defaults" : "Quality0") + "/" + t).c_str(),
          [=](benchmark::State& s) { RunFilter(s, dimension, defaults, threads); })
          ->UseRealTime()
          ->MinTime(0.3); // one execution of two threads says little about the next
      }
    }
  }
  for (const Pages pages : { Pages::Fresh, Pages::Small })
  {
    benchmark::RegisterBenchmark(
      pages == Pages::Fresh ? "Filter/2D/Quality0/Cold" : "Filter/2D/Quality0/ColdSmallPages",
      [=](benchmark::State& s) { RunFilter(s, 2, false, 1, pages); })
      ->UseRealTime()
      ->MinTime(0.3);
  }
  for (const std::int64_t target : Levels)
  {
    if ((hwy::SupportedTargets() & target) != 0)
    {
      for (const int dimension : { 2, 3 })
      {
        Register("Level/" + std::to_string(dimension) + "D/Quality0/" + hwy::TargetName(target),
          [=](auto& s)
          {
            const LevelForNow level(target);
            RunImage(s, Plain(0), dimension);
          });
      }
    }
  }
  Register("Cold/2D/Plain", [](auto& s) { RunColdOutput(s, false); });
  Register("Cold/2D/HugePages", [](auto& s) { RunColdOutput(s, true); });
  Register("Vtk/PerlinNoise", [](auto& s) { RunVtkPerlin(s); });
#ifdef STEERABLENOISE_HAVE_LIC
  // Its renderer works with threads of its own.
  benchmark::RegisterBenchmark("Vtk/ImageDataLIC2D", RunLic)->MeasureProcessCPUTime();
#endif
}
} // namespace

int main(int argc, char** argv)
{
  // --level=AVX2 keeps to that level, so that figures compare between machines.
  for (int i = 1; i < argc; ++i)
  {
    if (std::strncmp(argv[i], "--level=", 8) == 0)
    {
      for (std::int64_t target : Levels)
      {
        if (std::string(hwy::TargetName(target)) == argv[i] + 8)
        {
          ChosenLevel = target;
        }
      }
      std::memmove(argv + i, argv + i + 1, (argc - i) * sizeof(char*));
      --argc;
      break;
    }
  }
  RegisterAll();
  hwy::SetSupportedTargetsForTest(ChosenLevel);
  benchmark::AddCustomContext(
    "simd", hwy::TargetName(hwy::SupportedTargets() & -hwy::SupportedTargets()));
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
