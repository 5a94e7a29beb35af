#!/usr/bin/env bash
# Who may include whom (Documentation/architecture.md): the kernel knows no VTK, the filters no ParaView
# and no OpenGL, the representations nothing of the kernel but parameters and hash.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
status=0
forbid() { # what, pattern, folder
  local found
  [ -d "$3" ] || return 0
  if found=$(grep -rnE "#[[:space:]]*include[[:space:]]*[<\"]($2)" "$3"); then
    echo "$1:"
    echo "$found"
    status=1
  fi
}
forbid "The kernel includes VTK or ParaView" "vtk|pq|Qt" Filters/Kernel
forbid "The filters include ParaView or OpenGL" "vtkPV|vtkSM[^P]|vtkSI|pq|Qt|vtkOpenGL|GL/" Filters/Noise
forbid "The mapper includes ParaView" "vtkPV|vtkSM[^P]|vtkSI|pq|Qt" Rendering
forbid "The mappers include more of the kernel than parameters, metrics' constants, hash and tiles" \
  "SteerableNoise(Reference)?\.h|Fast/|Subband/Subband(Weights|Filters|Anisotropy)" Rendering
forbid "The representation includes the kernel" \
  "NoiseParameters|LatticeHash|MetricTensor|SteerableNoise(Reference)?\.h|Fast/|Surflet|Subband/" Plugin/Representations
# SIMD and FFT libraries stay inside the kernel's sources.
if found=$(grep -rnlE '#[[:space:]]*include[[:space:]]*<(hwy|unsupported)/' Filters Plugin 2>/dev/null | grep -v '^Filters/Kernel/.*\(\.cxx\|-inl\.h\)$'); then
  echo "SIMD or FFT headers outside the kernel's sources: $found"
  status=1
fi
[ $status = 0 ] && echo "Layering: every include is allowed."
exit $status
