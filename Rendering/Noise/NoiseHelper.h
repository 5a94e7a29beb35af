// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What draws all blocks of a mapper of noise (private): adds the noise to the vertices and the shader of its superclass.
 * A mapper's own helper says what that is.
 */
#ifndef NoiseHelper_h
#define NoiseHelper_h

#include "NoiseColor.h"

#include "vtkSurfaceNoiseMapper.h"

#include "vtkHardwareSelector.h" // vtkCompositeMapperHelper2.h wants it first
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"

#include <array>
#include <map>
#include <string>
#include <vector>

// VTK 9.3 gave the helper that draws all blocks another name and its own class for what belongs to a block.
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 3)
#include "vtkOpenGLBatchedPolyDataMapper.h"
#include "vtkOpenGLCompositePolyDataMapperDelegator.h"
using NoiseHelperSuperclass = vtkOpenGLBatchedPolyDataMapper;
#define STEERABLENOISE_DELEGATOR
#else
#include "vtkCompositeMapperHelper2.h"
using NoiseHelperSuperclass = vtkCompositeMapperHelper2;
#endif


class vtkOpenGLRenderWindow;
class vtkPolyData;

/// What a mapper and its helpers both know.
struct vtkSurfaceNoiseMapper::DrawnState
{
  noise::ColorOptions Color;
  bool AnyNoise = false;
  /// When something changed that the source of the shader depends on.
  vtkTimeStamp VariantTime;
  /// When something that is uploaded changed.
  vtkTimeStamp FieldsTime;
  vtkTimeStamp UploadTime;
};

class vtkNoiseHelper : public NoiseHelperSuperclass
{
public:
  vtkTypeMacro(vtkNoiseHelper, NoiseHelperSuperclass);

protected:
  ///@{
  /// To the templates of shaders, before they are filled.
  virtual void AddNoise(std::map<vtkShader::Type, vtkShader*>& shaders) = 0;
  /// Those that are the same for all blocks, of a program with or without noise; vertices are (place - `shift`) * `scale`.
  virtual void SetNoiseUniforms(vtkShaderProgram* program, vtkRenderer* renderer, vtkActor* actor,
    const std::array<double, 3>& shift, const std::array<double, 3>& scale) = 0;
  virtual void SetBlockUniforms(vtkShaderProgram*, vtkPolyData*, size_t) {}
  /// Before the first block's vertices, after `count` ones of a block were appended, and after the last one's.
  virtual void BeginVertices() {}
  virtual void AppendVertices(vtkPolyData* data, vtkIdType count, vtkActor* actor) = 0;
  virtual void EndVertices(vtkOpenGLRenderWindow*) {}
  /// Around the drawing of all blocks.
  virtual void ActivateTextures(vtkOpenGLRenderWindow*) {}
  virtual void DeactivateTextures() {}
  ///@}

  vtkSurfaceNoiseMapper* GetMapper()
  {
    return static_cast<vtkSurfaceNoiseMapper*>(static_cast<vtkObjectBase*>(this->Parent));
  }
  vtkSurfaceNoiseMapper::DrawnState& GetDrawn() { return this->GetMapper()->GetDrawn(); }

#ifdef STEERABLENOISE_DELEGATOR
  using BlockData = GLBatchElement;
  static vtkPolyData* GetPolyData(const BlockData* block) { return block->Parent.PolyData; }
  static void SetPolyData(BlockData* block, vtkPolyData* data) { block->Parent.PolyData = data; }
#else
  using BlockData = vtkCompositeMapperHelperData;
  static vtkPolyData* GetPolyData(const BlockData* block) { return block->Data; }
  static void SetPolyData(BlockData* block, vtkPolyData* data) { block->Data = data; }
#endif

  bool GetNeedToRebuildBufferObjects(vtkRenderer* renderer, vtkActor* actor) override;
  bool GetNeedToRebuildShaders(vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) override;
  void ReplaceShaderValues(
    std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void SetMapperShaderParameters(
    vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor) override;
  void SetShaderValues(vtkShaderProgram* program, BlockData* block, size_t firstPrimitive) override;
  void RenderPieceStart(vtkRenderer* renderer, vtkActor* actor) override;
  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override;
  void RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) override;
  void BuildBufferObjects(vtkRenderer* renderer, vtkActor* actor) override;
  void AppendOneBufferObject(vtkRenderer* renderer, vtkActor* actor, BlockData* block,
    vtkIdType& offset, std::vector<unsigned char>& colors, std::vector<float>& normals) override;

private:
  /// Not on picks.
  bool ShowsNoise(vtkRenderer* renderer);

  std::vector<vtkSmartPointer<vtkPolyData>> OwnVertices;
};

#endif
