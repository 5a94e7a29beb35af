// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Steerable noise at one place, of a fragment or a vertex: the model of Filters/Kernel/SteerableNoiseReference.cxx in GLSL, to be
// read beside it; functions have the names of the reference and of MetricTensor.cxx, Surflet.h, LatticeHash.h.
//
// What differs is the order of the corners. The reference visits a box; here a loop walks the lattice along
// the axis that the flow follows most, and in each section x = i solves for the rows, and in each row for the
// corners, that the bent ellipsoid q < 1 can reach. A corner costs a hash, a gradient and about 60 operations;
// straight streaks of half-length 6 visit some 22 corners a fragment. Motion widens the ellipsoid by half of
// |Speed|, Basis Streaks by sqrt(2) and by its jitter of half a cell.
//
// Range: places up to 2^23 cells from noiseOrigin; the lattice itself has no period below 2^32 cells.
// The mapper defines before this text the constants of LatticeHash.h, Surflet.h and MetricTensor.h that are the same here,
// NOISE_OCTAVES, and, as its options ask, NOISE_TENSORS, NOISE_STREAKS, NOISE_MOTION, NOISE_PIXELS, NOISE_CELLS.

uniform vec3 noiseEye;             // the eye in model coordinates, relative to the origin of places
uniform vec3 noiseView;            // parallel projection: the direction to the eye; perspective: 0
uniform float noisePixel;          // model size of a pixel where gl_FragCoord.w is 1
uniform float noiseFeature;        // World: side of a lattice cell; Pixels: FeaturePixels
uniform int noiseOrigin[3 * NOISE_OCTAVES]; // corner where places begin, one for each octave
uniform float noiseRest[3 * NOISE_OCTAVES]; // what is left of that place, in units of the octave
uniform int noiseOriginLevel;      // noiseOrigin counts cells of 2^this (Pixels), or of noiseFeature (World: 0)
uniform float noiseAlong;          // eigenvalue along the flow, 1 / StreakLength^2
uniform float noiseEigenvalueSum;
uniform float noiseStrength;
uniform float noiseReference;      // StrengthMode Magnitude: length with the full strength; Constant: 0
uniform float noiseMask;           // vectors at or below this length show no noise
uniform float noiseLacunarity;
uniform float noiseGain;
uniform float noiseDensity;        // probability of a streak at a corner
uniform float noisePhase;
uniform float noiseSpeed;
uniform int noiseSeed;
uniform float noiseCurvature;      // 1: follow it, 0: straight
uniform float noiseLongest;        // of this block: length that the vectors were divided by

struct AxialMetric
{
  vec3 Direction;
  vec3 SecondAxis;
  float Along;
  float Across;
  float Second;
  vec3 Bend;
};

uint HashOneAxis(uint coordinate, uint first, uint last)
{
  uint h = coordinate * first;
  h ^= h >> HASH_AXIS_SHIFT;
  return h * last;
}

uint HashJoinAxes(uint h)
{
  h ^= h >> HASH_JOIN_SHIFT;
  h *= HASH_JOIN;
  return h ^ (h >> HASH_JOIN_SHIFT);
}

uint HashOfSeed(uint seed)
{
  return HashOneAxis(seed + 1u, HASH_SEED, HASH_AXIS_FINAL.x);
}

uint HashStream(uint hash, uint stream)
{
  return HashJoinAxes(hash + stream * HASH_SEED);
}

float HashToUnit(uint hash)
{
  return float(hash >> 8) * (1.0 / 16777216.0);
}

/// Quintic, of |t| < 1.
float FadeOf(float t)
{
  return 1.0 - t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/// dot(v, the gradient of a hash), which is even on the sphere.
float GradientDot(uint hash, vec3 v)
{
  float height = (float(int((hash << 1) & 0xFFFE0000u)) + 65536.0) * (1.0 / 2147483648.0);
  float angle = (float(int(hash << 16)) + 32768.0) * (3.14159265 / 4294967296.0);
  float radius = sqrt(1.0 - height * height);
  // Sine and cosine of at most a quarter turn, to 1e-5: fewer operations than the built-in ones.
  float a = angle * angle;
  float sine = angle * (0.999997176 + a * (-0.166649797 + a * (0.00830743921 + a * -0.000183879492)));
  float cosine = 0.99999675 + a * (-0.49992689 + a * (0.04150074 + a * -0.0012744));
  float value = radius * (cosine * v.x + sine * v.y) + height * v.z;
  return (hash >> 31) != 0u ? -value : value;
}

float StreakProfile(float sigma)
{
  return abs(sigma) < 1.0 ? 0.5 * (1.0 + sigma) * min(1.0, (1.0 - sigma) * (1.0 / STREAK_END)) : 0.0;
}

float Blend(float eigenvalue, float strength)
{
  return 1.0 + strength * (eigenvalue - 1.0);
}

float StrengthOf(float magnitude)
{
  return noiseReference > 0.0 ? noiseStrength * min(1.0, magnitude / noiseReference) : noiseStrength;
}

/// Of a unit vector; a normal of 0: not on a surface.
AxialMetric MetricFromVector(vec3 direction, vec3 normal, float strength)
{
  AxialMetric metric;
  bool surface = dot(normal, normal) > 0.0;
  float across = noiseEigenvalueSum - noiseAlong;
  across = surface ? across - SURFACE_NORMAL_EIGENVALUE : 0.5 * across;
  across = Blend(max(noiseAlong, across - 1e-4), strength);
  vec3 axis = abs(direction.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  metric.Direction = direction;
  metric.SecondAxis = surface ? normal : normalize(cross(direction, axis));
  metric.Along = Blend(noiseAlong, strength);
  metric.Across = across;
  metric.Second = surface ? Blend(SURFACE_NORMAL_EIGENVALUE, strength) : across;
  metric.Bend = vec3(0.0);
  return metric;
}

#ifdef NOISE_TENSORS
vec3 TimesSymmetric(vec3 diagonal, vec3 off, vec3 v)
{
  return vec3(diagonal.x * v.x + off.x * v.y + off.z * v.z,
    off.x * v.x + diagonal.y * v.y + off.y * v.z, off.z * v.x + off.y * v.y + diagonal.z * v.z);
}

/// The unit eigenvector of an eigenvalue that stands alone.
vec3 EigenvectorOf(vec3 diagonal, vec3 off, float eigenvalue)
{
  vec3 d = diagonal - eigenvalue;
  vec3 x = vec3(d.x, off.x, off.z);
  vec3 y = vec3(off.x, d.y, off.y);
  vec3 z = vec3(off.z, off.y, d.z);
  vec3 a = cross(x, y);
  vec3 b = cross(y, z);
  vec3 c = cross(z, x);
  float aa = dot(a, a);
  float bb = dot(b, b);
  float cc = dot(c, c);
  vec3 longest = aa >= bb && aa >= cc ? a : bb >= cc ? b : c;
  return normalize(longest);
}

/// XX YY ZZ and XY YZ XZ; false where no direction is the major one.
bool MetricFromTensor(vec3 diagonal, vec3 off, float strength, out AxialMetric metric)
{
  vec3 large = max(abs(diagonal), abs(off));
  float largest = max(large.x, max(large.y, large.z));
  if (!(largest > 0.0))
  {
    return false;
  }
  diagonal /= largest;
  off /= largest;
  float mean = (diagonal.x + diagonal.y + diagonal.z) / 3.0;
  diagonal -= mean;
  float p = sqrt((dot(diagonal, diagonal) + 2.0 * dot(off, off)) / 6.0);
  if (!(p > 1e-6))
  {
    return false;
  }
  float determinant = diagonal.x * (diagonal.y * diagonal.z - off.y * off.y) -
    off.x * (off.x * diagonal.z - off.y * off.z) + off.z * (off.x * off.y - diagonal.y * off.z);
  float angle = acos(clamp(determinant / (2.0 * p * p * p), -1.0, 1.0)) / 3.0;
  // The eigenvalue farthest from the others is found first, the other two in the plane across it: so close
  // eigenvalues cost no precision.
  bool majorFirst = determinant >= 0.0;
  float alone = 2.0 * p * (majorFirst ? cos(angle) : cos(angle + 2.0943951));
  vec3 first = EigenvectorOf(diagonal, off, alone);
  alone = dot(first, TimesSymmetric(diagonal, off, first));
  vec3 axis = abs(first.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
  vec3 s = normalize(cross(first, axis));
  vec3 t = cross(first, s);
  vec3 Ts = TimesSymmetric(diagonal, off, s);
  float ss = dot(s, Ts);
  float st = dot(t, Ts);
  float tt = dot(t, TimesSymmetric(diagonal, off, t));
  float halfGap = sqrt(0.25 * (ss - tt) * (ss - tt) + st * st);
  float larger = 0.5 * (ss + tt) + halfGap;
  float smaller = 0.5 * (ss + tt) - halfGap;
  float turn = 0.5 * atan(2.0 * st, ss - tt);
  vec3 ofLarger = cos(turn) * s + sin(turn) * t;
  float major = majorFirst ? alone : larger;
  float middle = majorFirst ? larger : smaller;
  float minor = majorFirst ? smaller : alone;
  if (!(major - minor > 1e-6))
  {
    return false;
  }
  vec3 middleAxis = majorFirst ? ofLarger : cross(first, ofLarger);
  float along = noiseAlong;
  float across = max(along, 0.5 * (noiseEigenvalueSum - along) - 1e-4);
  metric.Direction = majorFirst ? first : ofLarger;
  metric.SecondAxis = middleAxis;
  metric.Along = Blend(along, strength);
  metric.Across = Blend(across, strength);
  metric.Second =
    Blend(across + (along - across) * (middle - minor) / (major - minor), strength);
  metric.Bend = vec3(0.0);
  return true;
}
#endif

/// `curvature` in 1 / cells.
void ApplyCurvature(inout AxialMetric metric, vec3 curvature)
{
  vec3 turning = curvature - dot(curvature, metric.Direction) * metric.Direction;
  float squared = dot(turning, turning);
  metric.Bend = squared > 1.0 ? turning * inversesqrt(squared) : turning;
  squared = min(squared, 1.0);
  float keeps = 1.0 - squared;
  metric.Along = max(metric.Along, squared);
  metric.Across = Blend(metric.Across, keeps);
  metric.Second = Blend(metric.Second, keeps);
}

/// The axes of the lattice in another order: first the one after `cycle` steps, the others swapped or not.
vec3 Reorder(vec3 v, int cycle, bool swapped)
{
  v = cycle == 0 ? v : cycle == 1 ? v.yzx : v.zxy;
  return swapped ? v.xzy : v;
}

uvec3 Reorder(uvec3 v, int cycle, bool swapped)
{
  v = cycle == 0 ? v : cycle == 1 ? v.yzx : v.zxy;
  return swapped ? v.xzy : v;
}

/// Noise of unit variance at `place`, in cells from the corner `origin`.
float EvaluateOctave(vec3 place, uvec3 origin, uint seed, AxialMetric metric)
{
  vec3 cell = floor(place);
  vec3 f = place - cell;
  uvec3 corner = uvec3(ivec3(cell)) + origin;
  vec3 thirdAxis = cross(metric.SecondAxis, metric.Direction);
  float k = metric.Along;
  float b = metric.Across;
  float e = metric.Second;

  // The ellipsoid that holds all that a corner can add to, where motion and jitter move it.
  float reachAlong = 1.0;
  float reachAcross = 1.0;
  float jitter = 0.0;
#ifdef NOISE_MOTION
  float travel = 0.5 * abs(noiseSpeed);
  reachAlong = 1.0 / ((1.0 + travel) * (1.0 + travel));
  reachAcross = 1.0 / (1.0 + travel);
#endif
#ifdef NOISE_STREAKS
  reachAlong *= 0.5; // a streak is a cylinder, which the ellipsoid has to hold
  reachAcross *= 0.5;
  jitter = 0.5;
#endif
  // Squares of its half-axes: divisions are few and early, they cost the most here.
  float along2 = 1.0 / (k * reachAlong);
  float across2 = 1.0 / (b * reachAcross);
  float second2 = 1.0 / (e * reachAcross);
  float kr = k * reachAlong;

  // From here on x is the axis that the flow follows most, and y of the others the one in which its section
  // is narrower, so that there are few rows. Gradients stay in the axes of the lattice.
  vec3 size = abs(metric.Direction);
  int cycle = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  vec3 width = Reorder(thirdAxis * thirdAxis * across2 + metric.SecondAxis * metric.SecondAxis * second2,
    cycle, false);
  bool swapped = width.z < width.y;
  vec3 u = Reorder(metric.Direction, cycle, swapped);
  vec3 m = Reorder(metric.SecondAxis, cycle, swapped);
  vec3 c = Reorder(thirdAxis, cycle, swapped);
  vec3 d = Reorder(metric.Bend, cycle, swapped);
  f = Reorder(f, cycle, swapped);
  corner = Reorder(corner, cycle, swapped);
  uvec3 first = Reorder(HASH_AXIS, cycle, swapped);
  uvec3 last = Reorder(HASH_AXIS_FINAL, cycle, swapped);
  // Times v: its components along u, c and m, in half-axes of the ellipsoid q < 1.
  vec3 roots = sqrt(vec3(k, b, e));
  mat3 axes = transpose(mat3(roots.x * u, roots.y * c, roots.z * m));
  mat3 metricAxes = mat3(roots.x * metric.Direction, roots.y * thirdAxis, roots.z * metric.SecondAxis);
  vec2 halfBend = vec2(dot(d, c) * roots.y, dot(d, m) * roots.z) * (0.5 / k);

  // With C and M the ellipsoid is kr s^2 + t^2 + h^2 < 1 at s u + t C + h M + s^2 d / 2. It is the same for -s
  // and -u: here streamlines go up in x.
  vec3 C = c * sqrt(across2);
  vec3 M = m * sqrt(second2);
  vec3 up = u.x < 0.0 ? -u : u;
  float thickness = C.x * C.x + M.x * M.x;
  // All of it lies in this box.
  vec3 extent = sqrt(up * up * along2 + C * C + M * M) + jitter;
  vec3 sag = d * (0.5 * along2);
  ivec3 begin = ivec3(ceil(f - extent + min(sag, 0.0)));
  ivec3 end = ivec3(floor(f + extent + max(sag, 0.0)));
  // Where a streak turns within a few cells, the box is small and all of it is visited.
  float strong = dot(d, d) > 0.3 ? 100.0 : 0.0;
  float farthest = sqrt(along2);
  float perTurn = 0.5 * inversesqrt(max(thickness * d.x * d.x, 1e-12));

  float noise = 0.0;
  float variance = 0.0;
  // Loops test at their end, since software OpenGL (llvmpipe) goes through a body once more where a loop ends before
  // it. A row or corner too many adds 0.
  int i = begin.x;
  do
  {
    float x = float(i) - f.x;
    // Where the streamline's parabola has this x, and its direction (1, turn) there. `turns` is 0 where it
    // turns back; beyond, only its thickness reaches x.
    float turns = up.x * up.x + 2.0 * x * d.x;
    float root = sqrt(max(turns, 0.06));
    float inverse = 1.0 / root;
    float s0 = 2.0 * x / (up.x + root);
    s0 = turns < 0.06 ? clamp(s0, -farthest, farthest) : s0;
    vec2 turned = s0 * d.yz;
    vec2 turn = (up.yz + turned) * inverse;
    // To first order the section is the ellipse t^2 + h^2 < left with the sides A and B.
    vec2 A = C.yz - C.x * turn;
    vec2 B = M.yz - M.x * turn;
    float flat2 = thickness * inverse * inverse;
    float yy = A.x * A.x + B.x * B.x;
    float inverseY = 1.0 / yy;
    float skew = (A.x * A.y + B.x * B.y) * inverseY;
    float zz = inverse * inverse * inverseY * (across2 * second2); // of z where y is given
    // To second order it moves on by up to twice this; jitter moves it anywhere.
    vec2 onward = 0.25 * min(flat2, 4.0 * along2) * (d.yz - turn * d.x);
    vec2 slack = abs(vec2(onward.x, onward.y - skew * onward.x)) + strong +
      jitter * vec2(1.0 + abs(turn.x), 1.0 + abs(skew) + abs(turn.y - skew * turn.x));
    float ks0 = kr * s0;
    float beyond = max(-turns, 0.0) * perTurn;
    float left = 1.0 + strong + min(4.0 * max(slack.x, slack.y), 2.0) -
      ks0 * s0 * (1.0 - kr * flat2) - beyond * beyond;
    vec2 middle = f.yz + s0 * (up.yz + 0.5 * turned) + onward +
      ks0 * inverse * (C.x * A + M.x * B);
    float halfY = sqrt(clamp(left, 0.0, 1.0) * yy) + slack.x;
    int beginY = max(begin.y, int(ceil(middle.x - halfY)));
    int endY = left > 0.0 ? min(end.y, int(floor(middle.x + halfY))) : beginY - 1;
    vec3 ofSection = x * axes[0];
    uint hashX = HashOneAxis(corner.x + uint(i), first.x, last.x) ^ seed;
    int j = beginY;
    do
    {
      float y = float(j) - f.y;
      float dy = float(j) - middle.x;
      float leftZ = left - dy * dy * inverseY;
      float halfZ = sqrt(clamp(leftZ, 0.0, 1.0) * zz) + slack.y;
      float middleZ = middle.y + dy * skew;
      int beginZ = max(begin.z, int(ceil(middleZ - halfZ)));
      int endZ = leftZ > 0.0 ? min(end.z, int(floor(middleZ + halfZ))) : beginZ - 1;
      vec3 ofRow = ofSection + y * axes[1];
      uint hashXY = hashX ^ HashOneAxis(corner.y + uint(j), first.y, last.y);
      int l = beginZ;
      do
      {
        uint hash = HashJoinAxes(hashXY ^ HashOneAxis(corner.z + uint(l), first.z, last.z));
        vec3 sth = ofRow + (float(l) - f.z) * axes[2];
#ifdef NOISE_STREAKS
        vec3 shift = vec3(HashToUnit(HashStream(hash, 3u)), HashToUnit(HashStream(hash, 4u)),
                       HashToUnit(HashStream(hash, 5u))) - 0.5;
        sth += axes * Reorder(shift, cycle, swapped);
#endif
        sth.yz -= sth.x * sth.x * halfBend;
        float amplitude = 1.0;
#ifdef NOISE_MOTION
        float clock = fract(noisePhase + HashToUnit(HashStream(hash, 1u)));
        sth.x += (clock - 0.5) * noiseSpeed;
        amplitude = sin(3.14159265 * clock);
        amplitude *= amplitude * MOTION_AMPLITUDE;
#endif
        float across = dot(sth.yz, sth.yz);
#ifdef NOISE_STREAKS
        if (across < 1.0)
        {
          float profile = StreakProfile(-sth.x) * FadeOf(sqrt(across));
          bool on = HashToUnit(HashStream(hash, 2u)) < noiseDensity;
          noise += on ? amplitude * profile : 0.0;
          variance += noiseDensity * profile * profile;
        }
#else
        // 0 where q is 1 and beyond: a branch costs more than it saves.
        vec3 Gv = FadeOf(min(sth.x * sth.x + across, 1.0)) * (metricAxes * sth);
        noise += amplitude * GradientDot(hash, Gv);
        variance += dot(Gv, Gv);
#endif
      } while (++l <= endZ);
    } while (++j <= endY);
  } while (++i <= end.x);
#ifndef NOISE_STREAKS
  variance *= 1.0 / 3.0; // of a gradient along one axis
#endif
  return noise * inversesqrt(variance + VARIANCE_FLOOR);
}

/// Streaks in cells of `size` fade to the mean where on the screen they are narrower than 2 pixels, or their
/// half-length is shorter than 6.
float AntiAliased(float size, float pixel, vec3 place, AxialMetric metric, vec3 normal)
{
  float width = size / pixel;
  float halfLength = width * inversesqrt(metric.Along);
  if (normal != vec3(0.0))
  {
    vec3 view = noiseView == vec3(0.0) ? normalize(noiseEye - place) : noiseView;
    float alongView = dot(metric.Direction, view);
    float foreshortened = sqrt(max(1.0 - alongView * alongView, 1e-6));
    halfLength *= foreshortened;
    width *= min(1.0, abs(dot(normal, view)) / foreshortened);
  }
  return smoothstep(1.0, 2.0, width) * smoothstep(0.5, 6.0, halfLength);
}

/// A corner of cells of 2^-shift as one of cells of 1, and what is left over in those.
uvec3 ScaleOrigin(ivec3 origin, int shift, out vec3 rest)
{
  rest = vec3(0.0);
  if (shift >= 0)
  {
    return shift < 32 ? uvec3(origin) << uint(shift) : uvec3(0u);
  }
  int right = min(-shift, 31);
  ivec3 scaled = origin >> right;
  rest = vec3(origin - (scaled << right)) * exp2(-float(right));
  return uvec3(scaled);
}

/// Fractal sum over lattices of `size`, then finer ones; `level` is log2 of it where sizes come from pixels.
float SteerableNoise(vec3 place, float size, int level, float pixel, AxialMetric metric,
  vec3 curvature, vec3 normal)
{
  float sum = 0.0;
  float power = 0.0;
  float amplitude = 1.0;
  float fineness = 1.0;
  for (int i = 0; i < NOISE_OCTAVES; ++i)
  {
    float octaveSize = size / fineness;
    float share = AntiAliased(octaveSize, pixel, place, metric, normal);
    if (share > 0.0)
    {
      AxialMetric bent = metric;
      ApplyCurvature(bent, curvature * octaveSize);
      ivec3 origin =
        ivec3(noiseOrigin[3 * i], noiseOrigin[3 * i + 1], noiseOrigin[3 * i + 2]);
      vec3 rest = vec3(noiseRest[3 * i], noiseRest[3 * i + 1], noiseRest[3 * i + 2]);
      vec3 restOfOrigin;
      uvec3 corner = ScaleOrigin(origin, noiseOriginLevel - level, restOfOrigin);
      vec3 inLattice = (place * fineness + rest) / size + restOfOrigin;
      uint seed = HashOfSeed(uint(noiseSeed + i) + uint(level) * LEVEL_SEED);
      sum += amplitude * share * EvaluateOctave(inLattice, corner, seed, bent);
    }
    power += amplitude * amplitude;
    amplitude *= noiseGain;
    fineness *= noiseLacunarity;
  }
  return sum * inversesqrt(power);
}

/// `steered` is false where there is no direction, so no noise; a pixel there has `w` times the size of noisePixel.
float NoiseAt(vec3 place, vec3 steering, vec3 steering2, vec3 bend, vec3 normal, float w,
  out bool steered)
{
  steered = false;
  float pixel = noisePixel * w;
  float magnitude = length(steering);
#ifdef NOISE_TENSORS
  magnitude = sqrt(dot(steering, steering) + 2.0 * dot(steering2, steering2));
#endif
  // Longer than 1: a sample that is not finite has been marked so.
  if (!(magnitude * noiseLongest > noiseMask) || magnitude > 2.0 || !(magnitude > 0.0))
  {
    return 0.0;
  }
  float strength = StrengthOf(magnitude * noiseLongest);
  AxialMetric metric;
#ifdef NOISE_TENSORS
  if (!MetricFromTensor(steering, steering2, strength, metric))
  {
    return 0.0;
  }
  normal = normalize(cross(dFdx(place), dFdy(place)));
#else
  vec3 direction = steering / magnitude;
  float length2 = dot(normal, normal);
  if (length2 > 0.0)
  {
    normal *= inversesqrt(length2);
    direction -= dot(direction, normal) * normal;
    float inPlane = length(direction);
    if (!(inPlane > SMALLEST_IN_PLANE))
    {
      return 0.0;
    }
    direction /= inPlane;
  }
  metric = MetricFromVector(direction, normal, strength);
#endif
  steered = true;
  vec3 curvature = noiseCurvature * bend;
#ifdef NOISE_PIXELS
  // Two lattices whose squared weights sum to 1, so that contrast stays; for most sizes one of them is 0.
  float level = log2(max(pixel * noiseFeature, 1e-30));
  float below = floor(level);
  float turn = 1.5707963 * smoothstep(0.33, 0.67, level - below);
  // A loop ends where no fragment of a group goes on; a branch would cost all of them both lattices.
  int i = turn < 1.5707 ? 0 : 1;
  int last = turn > 0.0001 ? 1 : 0;
  float noise = 0.0;
  do
  {
    int l = int(below) + i;
    noise += (i == 0 ? cos(turn) : sin(turn)) *
      SteerableNoise(place, exp2(float(l)), l, pixel, metric, curvature, normal);
  } while (++i <= last);
  return noise;
#else
  return SteerableNoise(place, noiseFeature, 0, pixel, metric, curvature, normal);
#endif
}
