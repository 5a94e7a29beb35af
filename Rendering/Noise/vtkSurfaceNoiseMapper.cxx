// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceNoiseMapper.h"

#include "MapperOptions.h"
#include "NoiseHelper.h"

#include "vtkObjectFactory.h"

#include <algorithm>

#ifdef STEERABLENOISE_DELEGATOR
namespace
{
class vtkNoiseDelegator : public vtkOpenGLCompositePolyDataMapperDelegator
{
public:
  static vtkNoiseDelegator* New();
  vtkTypeMacro(vtkNoiseDelegator, vtkOpenGLCompositePolyDataMapperDelegator);

  /// Takes the reference.
  void SetHelper(vtkNoiseHelper* helper)
  {
    this->GLDelegate = helper;
    this->Delegate = vtk::TakeSmartPointer(this->GLDelegate);
  }
};
vtkStandardNewMacro(vtkNoiseDelegator);
} // namespace

vtkCompositePolyDataMapperDelegator* vtkSurfaceNoiseMapper::CreateADelegator()
{
  auto* delegator = vtkNoiseDelegator::New();
  delegator->SetHelper(this->MakeHelper());
  return delegator;
}
#else
vtkCompositeMapperHelper2* vtkSurfaceNoiseMapper::CreateHelper()
{
  return this->MakeHelper();
}
#endif

vtkSurfaceNoiseMapper::vtkSurfaceNoiseMapper()
  : Drawn(new DrawnState)
{
}

vtkSurfaceNoiseMapper::~vtkSurfaceNoiseMapper() = default;

#define SURFACENOISE_OPTION(name, type, member, value, AFTER)                                      \
  NOISE_OPTION(vtkSurfaceNoiseMapper, name, type, this->Drawn->Color.member, value, AFTER)

SURFACENOISE_OPTION(NoiseIntensity, double, Intensity, noise::Clamp(NoiseIntensity, 0.0, 1.0), )
SURFACENOISE_OPTION(NoiseContrast, double, Contrast, noise::Clamp(NoiseContrast, 0.0, 10.0), )
SURFACENOISE_OPTION(UseMaskColor, bool, UseMaskColor, UseMaskColor, )
SURFACENOISE_OPTION(
  OutputValue, bool, OutputValue, OutputValue, this->Drawn->VariantTime.Modified())
// Decides on which pass the geometry is drawn, too.
SURFACENOISE_OPTION(NoiseColorMode, int, ColorMode, noise::Clamp<int>(NoiseColorMode, MULTIPLY, OPACITY),
  this->Drawn->VariantTime.Modified();
  this->Modified())

void vtkSurfaceNoiseMapper::SetMaskColor(double red, double green, double blue)
{
  this->Drawn->Color.MaskColor = { noise::Clamp(red, 0.0, 1.0), noise::Clamp(green, 0.0, 1.0),
    noise::Clamp(blue, 0.0, 1.0) };
}

void vtkSurfaceNoiseMapper::GetMaskColor(double color[3])
{
  std::copy_n(this->Drawn->Color.MaskColor.begin(), 3, color);
}

vtkMTimeType vtkSurfaceNoiseMapper::GetUploadTime()
{
  return this->Drawn->UploadTime;
}

bool vtkSurfaceNoiseMapper::HasOpaqueGeometry()
{
  return this->Drawn->Color.ColorMode != OPACITY && this->Superclass::HasOpaqueGeometry();
}

bool vtkSurfaceNoiseMapper::HasTranslucentPolygonalGeometry()
{
  return this->Drawn->Color.ColorMode == OPACITY ||
    this->Superclass::HasTranslucentPolygonalGeometry();
}

void vtkSurfaceNoiseMapper::ShallowCopy(vtkAbstractMapper* mapper)
{
  if (auto* other = vtkSurfaceNoiseMapper::SafeDownCast(mapper))
  {
    this->Drawn->Color = other->Drawn->Color;
    this->Drawn->VariantTime.Modified();
  }
  this->Superclass::ShallowCopy(mapper);
}

void vtkSurfaceNoiseMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NoiseColorMode: " << this->GetNoiseColorMode() << "\n"
     << indent << "NoiseIntensity: " << this->GetNoiseIntensity() << "\n"
     << indent << "NoiseContrast: " << this->GetNoiseContrast() << "\n"
     << indent << "UseMaskColor: " << this->GetUseMaskColor() << "\n";
}
