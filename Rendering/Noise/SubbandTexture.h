// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The tiles of subband noise in the graphics card's memory (private).
 *
 * Tiles that stand still are one texture, blended before it is uploaded. Once the phase changes, the four realizations
 * of the loop are uploaded too, and from then on the graphics card blends them.
 */
#ifndef SubbandTexture_h
#define SubbandTexture_h

#include "vtkNew.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkTextureObject.h"
#include "vtkType.h"

#include <array>
#include <memory>

class vtkOpenGLRenderWindow;
class vtkWindow;

namespace noise
{
class SubbandAtlas;

class SubbandTexture
{
public:
  /// Brings the texture up to date; returns whether anything was uploaded. `phase` in [0, 1).
  bool Update(vtkOpenGLRenderWindow* window, SubbandAtlas& atlas, bool bytes, bool linear, double phase);

  vtkTextureObject* GetTexture() { return this->Tiles; }
  /// Of graphics memory.
  vtkIdType GetBytes() const { return this->Bytes; }

  void Release(vtkWindow* window);

private:
  void Upload(vtkTextureObject* texture, vtkOpenGLRenderWindow* window, SubbandAtlas& atlas, bool bytes,
    bool linear, const std::array<double, 4>& weights);
  void Blend(vtkOpenGLRenderWindow* window, bool bytes, const std::array<double, 4>& weights);

  vtkNew<vtkTextureObject> Tiles;
  std::array<vtkNew<vtkTextureObject>, 4> Terms;
  vtkNew<vtkOpenGLFramebufferObject> Target;
  std::unique_ptr<vtkOpenGLQuadHelper> Quad;
  int Version = -1;
  double Phase = 0.0;
  bool HasTerms = false;
  bool QuadBytes = false;
  vtkIdType Bytes = 0;
};
} // namespace noise

#endif
