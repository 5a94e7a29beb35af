#!/usr/bin/env bash
# Speed of this machine as a table of ratios: bash Utilities/benchmark.sh [repetitions, default 9]
# Medians of interleaved repetitions, thread CPU time; instructions by callgrind at AVX2.
. "$(dirname "${BASH_SOURCE[0]}")/build.sh"
install_packages valgrind
build=$build-bench
build_project -DSTEERABLENOISE_BENCHMARKS=ON -DBUILD_TESTING=OFF -DSTEERABLENOISE_DATA=OFF \
  -DSTEERABLENOISE_PYTHON=OFF
result=$build/benchmark.json
with_display "$build/bin/SteerableNoiseBenchmarks" --level=AVX2 --benchmark_min_time=0.05 \
  --benchmark_repetitions="${1:-9}" --benchmark_enable_random_interleaving=true \
  --benchmark_report_aggregates_only=true --benchmark_out_format=json --benchmark_out="$result" >/dev/null
python3 "$root/Utilities/benchmark.py" "$result"
echo
echo "| evaluation at AVX2 | instructions per point | corners visited |"
echo "|---|---|---|"
for case in "2 image 0 plain" "2 image 8 plain" "2 image 4 paper" "2 image 0 defaults" "2 image 0 straight" \
  "2 image 0 isotropic" "2 points 0 plain" "2 points 0 defaults" "3 image 0 plain" "3 image 8 plain" \
  "3 image 4 paper" "3 image 0 defaults" "3 image 0 straight" "3 image 0 isotropic" "3 points 0 plain" \
  "3 points 0 defaults"; do
  # shellcheck disable=SC2086
  text=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    --toggle-collect='steerable::SteerableNoise::Evaluate*' "$build/bin/evaluateOnce" AVX2 $case 2>&1)
  points=$(grep -oE '^points [0-9]+' <<<"$text" | cut -d' ' -f2)
  corners=$(grep -oE 'corners [0-9.]+' <<<"$text" | cut -d' ' -f2)
  count=$(grep -oE 'Collected : [0-9]+' <<<"$text" | grep -oE '[0-9]+')
  awk -v c="$case" -v n="$points" -v i="$count" -v k="$corners" \
    'BEGIN { split(c, w); printf "| %sD %s, Quality %s, %s | %.1f | %s |\n", w[1], w[2], w[3], w[4], i / n, k }'
done
