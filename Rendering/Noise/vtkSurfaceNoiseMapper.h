// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceNoiseMapper
 * @brief   what mappers of noise have in common
 *
 * Draws polygonal data, or a composite of it, as its superclass does, and lays noise of each fragment over the colours.
 * Which noise, subclasses say; here is how it changes the colours. The noise has no pass of its own: translucency,
 * depth peeling, several views, ranks, selection, edges, textures and lights work as without it.
 *
 * @sa
 * vtkSteerableNoiseMapper vtkSubbandNoiseMapper
 */
#ifndef vtkSurfaceNoiseMapper_h
#define vtkSurfaceNoiseMapper_h

#include "SteerableNoiseRenderingModule.h" // For export macro
#include "vtkVersionMacros.h"              // For the superclass

// VTK 9.3 moved what draws blocks into a delegator; before, the mapper had it as a helper.
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 3)
#include "vtkCompositePolyDataMapper.h"
using vtkSurfaceNoiseMapperSuperclass = vtkCompositePolyDataMapper;
#else
#include "vtkCompositePolyDataMapper2.h"
using vtkSurfaceNoiseMapperSuperclass = vtkCompositePolyDataMapper2;
#endif

#include <memory> // For std::unique_ptr

class vtkNoiseHelper;

class STEERABLENOISERENDERING_EXPORT vtkSurfaceNoiseMapper : public vtkSurfaceNoiseMapperSuperclass
{
public:
  vtkTypeMacro(vtkSurfaceNoiseMapper, vtkSurfaceNoiseMapperSuperclass);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum NoiseColorModeType
  {
    MULTIPLY = 0,
    BLEND = 1,
    LIGHTNESS = 2,
    OPACITY = 3
  };
  ///@{
  /**
   * How noise changes the colour of the surface. MULTIPLY, the default: darkens it; BLEND: mixes it with grey
   * (Surface LIC's meaning); LIGHTNESS: changes the lightness only, so that a colour map stays readable;
   * OPACITY: dark places become transparent.
   */
  void SetNoiseColorMode(int mode);
  int GetNoiseColorMode();
  ///@}

  ///@{
  /// 0: no noise, 1: full; default 0.8.
  void SetNoiseIntensity(double intensity);
  double GetNoiseIntensity();
  ///@}

  ///@{
  /// Factor of the noise before it becomes a grey value, 0 to 10, default 1.
  void SetNoiseContrast(double contrast);
  double GetNoiseContrast();
  ///@}

  ///@{
  /// Colour of the places that show no noise, with UseMaskColor; default grey .5.
  void SetMaskColor(double red, double green, double blue);
  void SetMaskColor(const double color[3]) { this->SetMaskColor(color[0], color[1], color[2]); }
  void GetMaskColor(double color[3]);
  ///@}

  ///@{
  /// Default off: places without noise show the surface's own colour.
  void SetUseMaskColor(bool use);
  bool GetUseMaskColor();
  vtkBooleanMacro(UseMaskColor, bool);
  ///@}

  ///@{
  /**
   * For programs that read noise back: the picture holds (noise + 8) / 16 as 24 bits in red, green and blue, without
   * light, and is black where there is no noise. Default off.
   */
  void SetOutputValue(bool value);
  bool GetOutputValue();
  vtkBooleanMacro(OutputValue, bool);
  ///@}

  /**
   * When the vertices, with their vectors, were last uploaded, of all windows; 0: never. Options leave it alone.
   */
  vtkMTimeType GetUploadTime();

  ///@{
  /// The superclass's, but translucent with OPACITY.
  bool HasOpaqueGeometry() override;
  bool HasTranslucentPolygonalGeometry() override;
  ///@}

  /// Time of the picture, for noise that moves with it.
  virtual void SetTime(double time) = 0;

  void ShallowCopy(vtkAbstractMapper* mapper) override;

  struct DrawnState;
  DrawnState& GetDrawn() { return *this->Drawn; }

protected:
  vtkSurfaceNoiseMapper();
  ~vtkSurfaceNoiseMapper() override;

  /// A new helper, which draws the blocks.
  virtual vtkNoiseHelper* MakeHelper() = 0;

#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 3)
  vtkCompositePolyDataMapperDelegator* CreateADelegator() override;
#else
  vtkCompositeMapperHelper2* CreateHelper() override;
#endif

private:
  vtkSurfaceNoiseMapper(const vtkSurfaceNoiseMapper&) = delete;
  void operator=(const vtkSurfaceNoiseMapper&) = delete;

  std::unique_ptr<DrawnState> Drawn;
};

#endif
