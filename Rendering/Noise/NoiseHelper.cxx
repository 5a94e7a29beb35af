// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseHelper.h"

#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkOpenGLHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLVertexBufferObject.h"
#include "vtkOpenGLVertexBufferObjectGroup.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"

#include <algorithm>

bool vtkNoiseHelper::ShowsNoise(vtkRenderer* renderer)
{
  return this->GetDrawn().AnyNoise && !renderer->GetSelector();
}

bool vtkNoiseHelper::GetNeedToRebuildBufferObjects(vtkRenderer* renderer, vtkActor* actor)
{
  return this->Superclass::GetNeedToRebuildBufferObjects(renderer, actor) ||
    this->VBOBuildTime < this->GetDrawn().FieldsTime;
}

bool vtkNoiseHelper::GetNeedToRebuildShaders(
  vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor)
{
  const bool rebuild = this->Superclass::GetNeedToRebuildShaders(cells, renderer, actor);
  return rebuild || cells.ShaderSourceTime < this->GetDrawn().VariantTime;
}

void vtkNoiseHelper::ReplaceShaderValues(
  std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor* actor)
{
  if (this->ShowsNoise(renderer) && !this->DrawingVertices)
  {
    this->AddNoise(shaders);
  }
  this->Superclass::ReplaceShaderValues(shaders, renderer, actor);
}

void vtkNoiseHelper::SetMapperShaderParameters(
  vtkOpenGLHelper& cells, vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::SetMapperShaderParameters(cells, renderer, actor);
  std::array<double, 3> shift = { 0.0, 0.0, 0.0 };
  std::array<double, 3> scale = { 1.0, 1.0, 1.0 };
  vtkOpenGLVertexBufferObject* places = this->VBOs->GetVBO("vertexMC");
  if (places && places->GetCoordShiftAndScaleEnabled())
  {
    std::copy_n(places->GetShift().begin(), 3, shift.begin());
    std::copy_n(places->GetScale().begin(), 3, scale.begin());
  }
  this->SetNoiseUniforms(cells.Program, renderer, actor, shift, scale);
  noise::SetColorUniforms(cells.Program, this->GetDrawn().Color, actor);
}

void vtkNoiseHelper::SetShaderValues(
  vtkShaderProgram* program, BlockData* block, size_t firstPrimitive)
{
  this->Superclass::SetShaderValues(program, block, firstPrimitive);
  this->SetBlockUniforms(program, GetPolyData(block), firstPrimitive);
}

void vtkNoiseHelper::RenderPieceStart(vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::RenderPieceStart(renderer, actor);
  this->ActivateTextures(static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow()));
}

void vtkNoiseHelper::RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor)
{
  if (this->GetDrawn().Color.ColorMode == vtkSurfaceNoiseMapper::OPACITY)
  {
#ifdef STEERABLENOISE_DELEGATOR
    for (auto& entry : this->VTKPolyDataToGLBatchElement)
    {
      entry.second->Parent.IsOpaque = false;
    }
#else
    for (auto& entry : this->Data)
    {
      entry.second->IsOpaque = false;
    }
#endif
  }
  this->Superclass::RenderPieceDraw(renderer, actor);
}

void vtkNoiseHelper::RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor)
{
  this->DeactivateTextures();
  this->Superclass::RenderPieceFinish(renderer, actor);
}

void vtkNoiseHelper::BuildBufferObjects(vtkRenderer* renderer, vtkActor* actor)
{
  this->OwnVertices.clear();
  this->BeginVertices();
  this->Superclass::BuildBufferObjects(renderer, actor);
  this->OwnVertices.clear();
  this->GetDrawn().UploadTime.Modified();
  this->EndVertices(static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow()));
}

void vtkNoiseHelper::AppendOneBufferObject(vtkRenderer* renderer, vtkActor* actor, BlockData* block,
  vtkIdType& offset, std::vector<unsigned char>& colors, std::vector<float>& normals)
{
  vtkPolyData* data = GetPolyData(block);
  if (!data->GetPoints() || data->GetNumberOfPoints() == 0 || !this->GetDrawn().AnyNoise)
  {
    this->Superclass::AppendOneBufferObject(renderer, actor, block, offset, colors, normals);
    return;
  }
  vtkDataArray* places = data->GetPoints()->GetData();
  vtkIdType first = 0;
  vtkIdType before = 0;
  vtkIdType after = 0;
  if (this->VBOs->ArrayExists("vertexMC", places, first, before))
  {
    // Another block has the same points. The superclass would use its vertices, with its vectors and
    // normals: points of its own make it append them again.
    vtkNew<vtkPolyData> own;
    own->ShallowCopy(data);
    vtkSmartPointer<vtkDataArray> copy;
    copy.TakeReference(places->NewInstance());
    copy->ShallowCopy(places);
    vtkNew<vtkPoints> points;
    points->SetData(copy);
    own->SetPoints(points);
    this->OwnVertices.emplace_back(own.Get());
    SetPolyData(block, own);
    this->Superclass::AppendOneBufferObject(renderer, actor, block, offset, colors, normals);
    SetPolyData(block, data);
  }
  else
  {
    this->Superclass::AppendOneBufferObject(renderer, actor, block, offset, colors, normals);
  }
  this->VBOs->ArrayExists("vertexMC", places, first, after);
  this->AppendVertices(data, after - before, actor);
}
