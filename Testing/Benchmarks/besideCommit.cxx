// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Times two builds of the kernel in turns: besideCommit EARLIER.so NOW.so [REPETITIONS]. See
/// Utilities/besideCommit.sh.
#include <dlfcn.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv)
{
  using Time = double (*)(const char*, int, int);
  Time builds[2];
  for (int i = 0; i < 2; ++i)
  {
    void* const module = argc > 2 ? dlopen(argv[1 + i], RTLD_NOW | RTLD_LOCAL) : nullptr;
    builds[i] = module ? reinterpret_cast<Time>(dlsym(module, "TimeKernel")) : nullptr;
    if (!builds[i])
    {
      std::fprintf(stderr, "usage: besideCommit EARLIER.so NOW.so [REPETITIONS]\n");
      return 2;
    }
  }
  const int repetitions = argc > 3 ? std::atoi(argv[3]) : 9;
  std::printf("| defaults | earlier, ms | now, ms | times as fast |\n|---|---|---|---|\n");
  for (const char* level : { "AVX2", "AVX3" })
  {
    for (int points = 0; points < 2; ++points)
    {
      for (int dimension = 2; dimension <= 3; ++dimension)
      {
        std::vector<double> seconds[2];
        std::vector<double> ratios;
        for (int i = 0; i < repetitions; ++i)
        {
          for (int build = 0; build < 2; ++build)
          {
            seconds[build].push_back(builds[build](level, dimension, points));
          }
          ratios.push_back(seconds[0].back() / seconds[1].back());
        }
        const auto median = [](std::vector<double>& values)
        {
          std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
          return values[values.size() / 2];
        };
        std::printf("| %s, %s, %dD | %.2f | %.2f | %.2f |\n", level, points ? "points" : "image",
          dimension, 1e3 * median(seconds[0]), 1e3 * median(seconds[1]), median(ratios));
      }
    }
  }
  return 0;
}
