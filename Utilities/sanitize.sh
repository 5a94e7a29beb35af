#!/usr/bin/env bash
# The C++ tests under sanitizers, and the fuzzers: bash Utilities/sanitize.sh [address|thread|fuzz ...]
# FUZZ_SECONDS (default 60) is how long each fuzzer runs, FUZZ_SEED (default 1) where it starts. With SANITIZE_ALL=1 the address sanitizer also
# gets the tests that only repeat much arithmetic; they take a quarter of an hour more.
. "$(dirname "${BASH_SOURCE[0]}")/build.sh"
install_packages clang libclang-rt-dev
vtk=$(dirname "$(ls /usr/lib/*/cmake/paraview-*/vtk/vtk-config.cmake /usr/lib/*/cmake/vtk-*/vtk-config.cmake 2>/dev/null | head -n 1)")
common=(-DSTEERABLENOISE_PLUGIN=OFF -DSTEERABLENOISE_PYTHON=OFF -DSTEERABLENOISE_DATA=OFF
  "-DVTK_DIR=$vtk" -DCMAKE_BUILD_TYPE=RelWithDebInfo)
base=$build

# One SIMD level is enough, and all that an instrumented compiler gets through in a minute or two.
instrumented="-O1 -DSTEERABLENOISE_INSTRUMENTED -DHWY_COMPILE_ONLY_STATIC"
[ "$(uname -m)" = x86_64 ] && registers="-msse4.2 -maes -mpclmul" || registers=

sanitize() { # name, flags: builds the C++ tests there
  build=$base-$1
  build_project "${common[@]}" -DBUILD_TESTING=ON \
    "-DCMAKE_CXX_FLAGS=$2 $instrumented $registers -fno-omit-frame-pointer"
}

for what in "${@:-address thread fuzz}"; do
  for kind in $what; do
    case $kind in
      address)
        targets="SteerableNoiseKernelTests SteerableNoiseFilterTests" \
          sanitize address "-fsanitize=address,undefined -fno-sanitize-recover=undefined"
        # VTK and MPI keep some memory to the end; what is ours is checked for its use, not for leaks. A size
        # that is refused is refused as new (nothrow) refuses it.
        export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
        # Statistics take many samples through code that other tests reach with few.
        long='-*NoiseQuality*:*AloneAnd*:*LatticeHash*:*EqualsTheReference*:*Subband*'
        long_of_filters='-*VarianceIsOne*:*NoiseIsIsotropic*:*AutomaticWavelength:*WavelengthIsInWorldUnits:*GiveWayToProjections'
        [ -z "${SANITIZE_ALL:-}" ] || long='*' long_of_filters='*'
        # One core is enough for these while the other builds what comes next.
        address_log=$build.log
        {
          "$build/bin/SteerableNoiseKernelTests" --gtest_brief=1 "--gtest_filter=$long" &&
            "$build/bin/SteerableNoiseFilterTests" --gtest_brief=1 "--gtest_filter=$long_of_filters"
        } >"$address_log" 2>&1 &
        address_tests=$!
        ;;
      thread)
        targets=SteerableNoiseKernelTests sanitize thread "-fsanitize=thread"
        "$build/bin/SteerableNoiseKernelTests" --gtest_brief=1 --gtest_filter=*Thread*
        ;;
      fuzz)
        build=$base-fuzz
        build_project "${common[@]}" -DBUILD_TESTING=OFF -DSTEERABLENOISE_FUZZERS=ON \
          -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
          "-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=undefined $instrumented"
        export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1
        for fuzzer in "$build"/bin/Fuzz*; do
          [ -x "$fuzzer" ] || continue # the log of an earlier run
          echo "$(basename "$fuzzer")"
          "$fuzzer" -seed="${FUZZ_SEED:-1}" -max_total_time="${FUZZ_SECONDS:-60}" -timeout=20 -max_len=4096 \
            -artifact_prefix="$build/" >"$fuzzer.log" 2>&1 || { tail -n 60 "$fuzzer.log"; exit 1; }
          tail -n 1 "$fuzzer.log"
        done
        ;;
    esac
  done
done
if [ "${address_tests:-}" ]; then
  wait "$address_tests" || { tail -n 100 "$address_log"; exit 1; }
  grep PASSED "$address_log"
fi
