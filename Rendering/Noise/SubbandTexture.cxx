// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandTexture.h"

#include "SubbandAtlas.h"
#include "Subband/SubbandTiles.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <string>

namespace noise
{
namespace
{
/// GL_DEPTH_TEST, GL_BLEND, GL_SCISSOR_TEST and GL_CULL_FACE.
constexpr unsigned int DepthTest = 0x0B71;
constexpr unsigned int Blending = 0x0BE2;
constexpr unsigned int ScissorTest = 0x0C11;
constexpr unsigned int CullFace = 0x0B44;

const char* const BlendShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord; // VTK complains where it is not used
uniform sampler2D term0;
uniform sampler2D term1;
uniform sampler2D term2;
uniform sampler2D term3;
uniform vec4 weights;
void main()
{
  ivec2 texel = ivec2(texCoord * vec2(textureSize(term0, 0)));
  gl_FragData[0] = weights.x * (texelFetch(term0, texel, 0) - ZERO) + weights.y * (texelFetch(term1, texel, 0) - ZERO) +
    weights.z * (texelFetch(term2, texel, 0) - ZERO) + weights.w * (texelFetch(term3, texel, 0) - ZERO) + ZERO;
}
)";
} // namespace

void SubbandTexture::Upload(vtkTextureObject* texture, vtkOpenGLRenderWindow* window, SubbandAtlas& atlas,
  bool bytes, bool linear, const std::array<double, 4>& weights)
{
  const SubbandAtlas::Image image = atlas.Make(weights);
  const int filter = linear ? vtkTextureObject::Linear : vtkTextureObject::Nearest;
  texture->SetContext(window);
  texture->ResetFormatAndType();
  texture->SetMinificationFilter(filter);
  texture->SetMagnificationFilter(filter);
  // Tiles have borders; repeating costs more.
  texture->SetWrapS(vtkTextureObject::ClampToEdge);
  texture->SetWrapT(vtkTextureObject::ClampToEdge);
  texture->Create2DFromRaw(static_cast<unsigned int>(atlas.GetWidth()),
    static_cast<unsigned int>(atlas.GetHeight()), 4, bytes ? VTK_UNSIGNED_CHAR : VTK_FLOAT,
    const_cast<void*>(bytes ? static_cast<const void*>(image.Bytes.data())
                            : static_cast<const void*>(image.Floats.data())));
  this->Bytes += atlas.GetBytes();
}

bool SubbandTexture::Update(
  vtkOpenGLRenderWindow* window, SubbandAtlas& atlas, bool bytes, bool linear, double phase)
{
  const std::array<double, 4> weights = steerable::LoopWeights(phase);
  if (this->Version != atlas.GetVersion())
  {
    this->Version = atlas.GetVersion();
    this->Phase = phase;
    this->HasTerms = false;
    this->Bytes = 0;
    this->Upload(this->Tiles, window, atlas, bytes, linear, weights);
    return true;
  }
  if (phase == this->Phase)
  {
    return false;
  }
  this->Phase = phase;
  const bool uploads = !this->HasTerms;
  for (std::size_t m = 0; m < this->Terms.size() && uploads; ++m)
  {
    std::array<double, 4> one = {};
    one[m] = 1.0;
    this->Upload(this->Terms[m], window, atlas, bytes, linear, one);
  }
  this->HasTerms = true;
  this->Blend(window, bytes, weights);
  return uploads;
}

void SubbandTexture::Blend(
  vtkOpenGLRenderWindow* window, bool bytes, const std::array<double, 4>& weights)
{
  if (!this->Quad || this->QuadBytes != bytes)
  {
    std::string shader = BlendShader;
    vtkShaderProgram::Substitute(shader, "ZERO", bytes ? "0.5" : "0.0");
    this->Quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr, shader.c_str(), nullptr);
    this->QuadBytes = bytes;
  }
  vtkOpenGLState* state = window->GetState();
  vtkOpenGLState::ScopedglViewport viewport(state);
  vtkOpenGLState::ScopedglColorMask colors(state);
  vtkOpenGLState::ScopedglEnableDisable depth(state, DepthTest);
  vtkOpenGLState::ScopedglEnableDisable blending(state, Blending);
  vtkOpenGLState::ScopedglEnableDisable scissor(state, ScissorTest);
  vtkOpenGLState::ScopedglEnableDisable culling(state, CullFace);
  this->Target->SetContext(window);
  this->Target->SaveCurrentBindingsAndBuffers();
  this->Target->Bind();
  this->Target->AddColorAttachment(0, this->Tiles);
  this->Target->ActivateDrawBuffer(0);
  for (const unsigned int test : { DepthTest, Blending, ScissorTest, CullFace })
  {
    state->vtkglDisable(test);
  }
  state->vtkglColorMask(1, 1, 1, 1);
  state->vtkglViewport(
    0, 0, static_cast<int>(this->Tiles->GetWidth()), static_cast<int>(this->Tiles->GetHeight()));
  window->GetShaderCache()->ReadyShaderProgram(this->Quad->Program);
  for (std::size_t m = 0; m < this->Terms.size(); ++m)
  {
    this->Terms[m]->Activate();
    this->Quad->Program->SetUniformi(
      ("term" + std::to_string(m)).c_str(), this->Terms[m]->GetTextureUnit());
  }
  const float four[4] = { static_cast<float>(weights[0]), static_cast<float>(weights[1]),
    static_cast<float>(weights[2]), static_cast<float>(weights[3]) };
  this->Quad->Program->SetUniform4f("weights", four);
  this->Quad->Render();
  for (vtkTextureObject* term : this->Terms)
  {
    term->Deactivate();
  }
  this->Target->RemoveColorAttachment(0);
  this->Target->RestorePreviousBindingsAndBuffers();
}

void SubbandTexture::Release(vtkWindow* window)
{
  this->Tiles->ReleaseGraphicsResources(window);
  for (vtkTextureObject* term : this->Terms)
  {
    term->ReleaseGraphicsResources(window);
  }
  this->Target->ReleaseGraphicsResources(window);
  this->Quad.reset();
  this->Version = -1;
  this->HasTerms = false;
}
} // namespace noise
