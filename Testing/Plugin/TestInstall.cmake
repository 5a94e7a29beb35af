# Installs the build, builds a project that finds it, and runs that and the installed Python package.
file(REMOVE_RECURSE "${SCRATCH}")
set(prefix "${SCRATCH}/prefix")
function (run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if (NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif ()
  message(STATUS "${output}")
endfunction ()
# Program, Python package and plugin find their libraries by themselves.
unset(ENV{LD_LIBRARY_PATH})
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
run("${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${SCRATCH}/consumer" -G Ninja
  "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_BUILD_TYPE=Release)
run("${CMAKE_COMMAND}" --build "${SCRATCH}/consumer")
run("${SCRATCH}/consumer/useSteerableNoise")
run("${XVFB_RUN}" -a -s "-screen 0 1280x1024x24 -noreset" "${SCRATCH}/consumer/lookAtSteerableNoise")
set(ENV{PYTHONPATH} "${prefix}/${LIBDIR}/python3/dist-packages")
run("${PVPYTHON}" -c
  "from steerablenoise import vtkSteerableNoiseFilter, vtkSteerableNoiseMapper; print(vtkSteerableNoiseFilter().GetStreakLength(), vtkSteerableNoiseMapper().GetStreakLength())")
run("${PVPYTHON}" -c
  "from paraview.simple import *; LoadPlugin('${prefix}/${LIBDIR}/paraview/plugins/SteerableNoise/SteerableNoise.so', remote=False, ns=globals()); print(SteerableNoise(Input=Wavelet()).Quality)")
