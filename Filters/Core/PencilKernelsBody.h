// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PencilKernelsBody.h
 * @brief The loops of PencilKernels.cxx, included there once for each instruction set.
 *
 * Expects the vector type Lanes (and its Mask), with the functions used below, and CDM_TARGET, the
 * attribute that lets the compiler use the instructions.
 */

CDM_TARGET int Select(const NearPoints& points, const Pencil& pencil, double heightLimit)
{
  const Lanes nx = Lanes::Set(pencil.Normal[0]);
  const Lanes ny = Lanes::Set(pencil.Normal[1]);
  const Lanes nz = Lanes::Set(pencil.Normal[2]);
  const Lanes hx = Lanes::Set(pencil.Offset[0]);
  const Lanes hy = Lanes::Set(pencil.Offset[1]);
  const Lanes hz = Lanes::Set(pencil.Offset[2]);
  const Lanes limit = Lanes::Set(heightLimit);
  // The best of each lane as a fraction, compared without divisions.
  Lanes bestPower = Lanes::Set(std::numeric_limits<double>::infinity());
  Lanes bestHeight = Lanes::Set(1.0);
  Lanes bestBlock = Lanes::Set(-1.0);
  for (int i = 0; i < points.Count; i += Lanes::Size)
  {
    const Lanes x = Lanes::Load(points.X + i);
    const Lanes y = Lanes::Load(points.Y + i);
    const Lanes z = Lanes::Load(points.Z + i);
    const Lanes height =
      Lanes::Add(Lanes::Add(Lanes::Mul(nx, x), Lanes::Mul(ny, y)), Lanes::Mul(nz, z));
    const Lanes power = Lanes::Sub(Lanes::Load(points.W + i),
      Lanes::Add(Lanes::Add(Lanes::Mul(hx, x), Lanes::Mul(hy, y)), Lanes::Mul(hz, z)));
    const Lanes::Mask isBetter = Lanes::And(Lanes::Less(limit, height),
      Lanes::Less(Lanes::Mul(power, bestHeight), Lanes::Mul(bestPower, height)));
    bestPower = Lanes::Choose(isBetter, power, bestPower);
    bestHeight = Lanes::Choose(isBetter, height, bestHeight);
    bestBlock = Lanes::Choose(isBetter, Lanes::Set(static_cast<double>(i)), bestBlock);
  }
  double powers[Lanes::Size];
  double heights[Lanes::Size];
  double blocks[Lanes::Size];
  Lanes::Store(powers, bestPower);
  Lanes::Store(heights, bestHeight);
  Lanes::Store(blocks, bestBlock);
  int best = -1;
  for (int lane = 0; lane < Lanes::Size; ++lane)
  {
    if (blocks[lane] >= 0.0 &&
      (best < 0 || powers[lane] * heights[best] < powers[best] * heights[lane]))
    {
      best = lane;
    }
  }
  return best < 0 ? -1 : static_cast<int>(blocks[best]) + best;
}

CDM_TARGET int Collect(
  const NearPoints& points, const Pencil& pencil, double powerLimit, int* found)
{
  const Lanes cx = Lanes::Set(pencil.Center[0]);
  const Lanes cy = Lanes::Set(pencil.Center[1]);
  const Lanes cz = Lanes::Set(pencil.Center[2]);
  const Lanes limit = Lanes::Set(powerLimit);
  int count = 0;
  for (int i = 0; i < points.Count; i += Lanes::Size)
  {
    const Lanes x = Lanes::Load(points.X + i);
    const Lanes y = Lanes::Load(points.Y + i);
    const Lanes z = Lanes::Load(points.Z + i);
    const Lanes power = Lanes::Sub(Lanes::Load(points.W + i),
      Lanes::Add(Lanes::Add(Lanes::Mul(cx, x), Lanes::Mul(cy, y)), Lanes::Mul(cz, z)));
    unsigned mask = Lanes::GetBits(Lanes::NotGreater(power, limit));
    while (mask != 0)
    {
      if (count < 64)
      {
        found[count] = i + CountTrailingZeros(mask);
      }
      ++count;
      mask &= mask - 1;
    }
  }
  return count;
}

CDM_TARGET int Filter(const double* const* x, const Id* ids, int size, const double* v,
  double limit, double* const* out, Id* outIds)
{
  const Lanes vx = Lanes::Set(v[0]);
  const Lanes vy = Lanes::Set(v[1]);
  const Lanes vz = Lanes::Set(v[2]);
  const Lanes limits = Lanes::Set(limit);
  int count = 0;
  for (int i = 0; i < size; i += Lanes::Size)
  {
    const Lanes dx = Lanes::Sub(Lanes::Load(x[0] + i), vx);
    const Lanes dy = Lanes::Sub(Lanes::Load(x[1] + i), vy);
    const Lanes dz = Lanes::Sub(Lanes::Load(x[2] + i), vz);
    const Lanes square =
      Lanes::Add(Lanes::Add(Lanes::Mul(dx, dx), Lanes::Mul(dy, dy)), Lanes::Mul(dz, dz));
    const Lanes::Mask isIn = Lanes::NotGreater(square, limits);
    if (Lanes::GetBits(isIn) == 0)
    {
      continue;
    }
    Lanes::StoreChosen(isIn, dx, out[0] + count);
    Lanes::StoreChosen(isIn, dy, out[1] + count);
    Lanes::StoreChosen(isIn, dz, out[2] + count);
    Lanes::StoreChosen(isIn, square, out[3] + count);
    count += Lanes::StoreChosen(isIn, ids + i, outIds + count);
  }
  return count;
}

CDM_TARGET unsigned TestBoxes(const double* boxes, const Pencil& pencil, double* bounds)
{
  constexpr int Width = 8;
  const Lanes zero = Lanes::Set(0.0);
  unsigned result = 0;
  for (int i = 0; i < Width; i += Lanes::Size)
  {
    Lanes height = zero;
    Lanes reach = zero;
    Lanes offsetPower = zero;
    Lanes centerPower = zero;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Lanes v = Lanes::Set(pencil.V[axis]);
      const Lanes low = Lanes::Sub(Lanes::Load(boxes + axis * Width + i), v);
      const Lanes high = Lanes::Sub(Lanes::Load(boxes + (axis + 3) * Width + i), v);
      height = Lanes::Add(height,
        Lanes::Mul(Lanes::Set(pencil.Normal[axis]), pencil.Normal[axis] > 0.0 ? high : low));
      reach = Lanes::Add(reach, Lanes::Max(Lanes::Sub(zero, low), high));
      const Lanes offset = Lanes::Set(pencil.Offset[axis]);
      const Lanes half = Lanes::Mul(offset, Lanes::Set(0.5));
      const Lanes x = Lanes::Min(Lanes::Max(half, low), high);
      offsetPower = Lanes::Add(offsetPower, Lanes::Mul(x, Lanes::Sub(x, offset)));
      const Lanes center = Lanes::Set(pencil.Center[axis]);
      const Lanes halfCenter = Lanes::Mul(center, Lanes::Set(0.5));
      const Lanes y = Lanes::Min(Lanes::Max(halfCenter, low), high);
      centerPower = Lanes::Add(centerPower, Lanes::Mul(y, Lanes::Sub(y, center)));
    }
    const Lanes heightHigh = Lanes::Add(height, Lanes::Mul(Lanes::Set(pencil.HeightError), reach));
    const Lanes square = Lanes::Mul(Lanes::Set(SquareError), Lanes::Mul(reach, reach));
    const Lanes offsetLow = Lanes::Sub(
      Lanes::Sub(offsetPower, square), Lanes::Mul(Lanes::Set(pencil.OffsetError), reach));
    const Lanes centerLow = Lanes::Sub(
      Lanes::Sub(centerPower, square), Lanes::Mul(Lanes::Set(pencil.CenterError), reach));
    unsigned mask = Lanes::GetBits(Lanes::NotGreater(zero, heightHigh));
    if (pencil.HasSphere)
    {
      mask &= Lanes::GetBits(Lanes::NotGreater(centerLow, zero));
    }
    result |= mask << i;
    Lanes::Store(bounds + i,
      Lanes::Choose(Lanes::Less(zero, offsetLow), Lanes::Div(offsetLow, heightHigh),
        Lanes::Set(-std::numeric_limits<double>::infinity())));
  }
  return result;
}

CDM_TARGET unsigned TestSlabs(const double* boxes, const double* slabs, const Pencil& pencil)
{
  constexpr int Width = 8;
  const Lanes zero = Lanes::Set(0.0);
  const Lanes half = Lanes::Set(0.5);
  unsigned result = 0;
  for (int i = 0; i < Width; i += Lanes::Size)
  {
    // With x = d + q, d the slab's origin and g its slope: |q|^2 - g q is between low and high.
    // 1. |x|^2 - 2 m x is at least |d|^2 - 2 m d + low + min (g + 2 d - 2 m) q.
    Lanes power = Lanes::Load(slabs + 6 * Width + i);
    Lanes reach = zero;
    Lanes size = zero;
    // 2. For any weight w >= 0, 2 n x is at most 2 n d + w high + max ((2 n + w g) q - w |q|^2);
    // the weight that lets the slope vanish across the slab is a good one.
    Lanes across = zero;
    Lanes acrossSquare = zero;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Lanes center = Lanes::Set(pencil.Center[axis]);
      const Lanes origin = Lanes::Load(slabs + axis * Width + i);
      const Lanes slope = Lanes::Load(slabs + (axis + 3) * Width + i);
      const Lanes d = Lanes::Sub(origin, Lanes::Set(pencil.V[axis]));
      power = Lanes::Add(power, Lanes::Mul(d, Lanes::Sub(d, center)));
      const Lanes factor = Lanes::Sub(Lanes::Add(slope, Lanes::Add(d, d)), center);
      const Lanes low = Lanes::Sub(Lanes::Load(boxes + axis * Width + i), origin);
      const Lanes high = Lanes::Sub(Lanes::Load(boxes + (axis + 3) * Width + i), origin);
      power = Lanes::Add(power, Lanes::Min(Lanes::Mul(factor, low), Lanes::Mul(factor, high)));
      const Lanes far = Lanes::Max(Lanes::Sub(zero, low), Lanes::Max(high, zero));
      size = Lanes::Add(size, Lanes::Mul(far, Lanes::Max(slope, Lanes::Sub(zero, slope))));
      reach = Lanes::Add(reach, Lanes::Add(Lanes::Max(d, Lanes::Sub(zero, d)), far));
      const Lanes outward = Lanes::Sub(Lanes::Add(low, high), slope);
      across = Lanes::Add(across, Lanes::Mul(Lanes::Set(pencil.Normal[axis]), outward));
      acrossSquare = Lanes::Add(acrossSquare, Lanes::Mul(outward, outward));
    }
    const Lanes square =
      Lanes::Mul(Lanes::Set(SquareError), Lanes::Add(Lanes::Mul(reach, reach), size));
    unsigned mask = ~0u;
    if (pencil.HasSphere)
    {
      mask = Lanes::GetBits(Lanes::NotGreater(
        power, Lanes::Add(square, Lanes::Mul(Lanes::Set(pencil.CenterError), reach))));
    }
    const Lanes weight =
      Lanes::Choose(Lanes::And(Lanes::Less(zero, across), Lanes::Less(zero, acrossSquare)),
        Lanes::Div(across, acrossSquare), zero);
    Lanes height = Lanes::Mul(weight, Lanes::Load(slabs + 7 * Width + i));
    Lanes heightSize = Lanes::Mul(weight, Lanes::Add(Lanes::Mul(reach, reach), size));
    for (int axis = 0; axis < 3; ++axis)
    {
      const Lanes normal = Lanes::Set(pencil.Normal[axis]);
      const Lanes origin = Lanes::Load(slabs + axis * Width + i);
      const Lanes slope = Lanes::Load(slabs + (axis + 3) * Width + i);
      const Lanes low = Lanes::Sub(Lanes::Load(boxes + axis * Width + i), origin);
      const Lanes high = Lanes::Sub(Lanes::Load(boxes + (axis + 3) * Width + i), origin);
      const Lanes factor = Lanes::Add(normal, Lanes::Mul(weight, slope));
      const Lanes top = Lanes::Div(Lanes::Mul(half, factor),
        Lanes::Choose(Lanes::Less(zero, weight), weight, Lanes::Set(1e-300)));
      const Lanes q = Lanes::Min(Lanes::Max(top, low), high);
      height = Lanes::Add(height, Lanes::Mul(q, Lanes::Sub(factor, Lanes::Mul(weight, q))));
      height =
        Lanes::Add(height, Lanes::Mul(normal, Lanes::Sub(origin, Lanes::Set(pencil.V[axis]))));
    }
    const Lanes heightError = Lanes::Add(Lanes::Mul(Lanes::Set(SquareError), heightSize),
      Lanes::Mul(Lanes::Set(2.0 * pencil.HeightError), reach));
    mask &= Lanes::GetBits(Lanes::NotGreater(zero, Lanes::Add(height, heightError)));
    result |= (mask & ((1u << Lanes::Size) - 1u)) << i;
  }
  return result;
}

CDM_TARGET unsigned TestDistance(const double* boxes, const double* box, double limit)
{
  constexpr int Width = 8;
  const Lanes zero = Lanes::Set(0.0);
  unsigned result = 0;
  for (int i = 0; i < Width; i += Lanes::Size)
  {
    Lanes square = zero;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Lanes low = Lanes::Load(boxes + axis * Width + i);
      const Lanes high = Lanes::Load(boxes + (axis + 3) * Width + i);
      const Lanes gap = Lanes::Max(Lanes::Max(Lanes::Sub(low, Lanes::Set(box[axis + 3])),
                                     Lanes::Sub(Lanes::Set(box[axis]), high)),
        zero);
      square = Lanes::Add(square, Lanes::Mul(gap, gap));
    }
    result |= Lanes::GetBits(Lanes::NotGreater(square, Lanes::Set(limit))) << i;
  }
  return result;
}

CDM_TARGET unsigned ViewLeaf(
  const double* px, const double* py, const double* pz, const Pencil& pencil)
{
  constexpr int Width = 8;
  const Lanes zero = Lanes::Set(0.0);
  unsigned result = 0;
  for (int i = 0; i < Width; i += Lanes::Size)
  {
    const Lanes x = Lanes::Sub(Lanes::Load(px + i), Lanes::Set(pencil.V[0]));
    const Lanes y = Lanes::Sub(Lanes::Load(py + i), Lanes::Set(pencil.V[1]));
    const Lanes z = Lanes::Sub(Lanes::Load(pz + i), Lanes::Set(pencil.V[2]));
    const Lanes square =
      Lanes::Add(Lanes::Add(Lanes::Mul(x, x), Lanes::Mul(y, y)), Lanes::Mul(z, z));
    const auto dot = [&](const double* a) CDM_TARGET_LAMBDA
    {
      return Lanes::Add(
        Lanes::Add(Lanes::Mul(Lanes::Set(a[0]), x), Lanes::Mul(Lanes::Set(a[1]), y)),
        Lanes::Mul(Lanes::Set(a[2]), z));
    };
    const Lanes height = dot(pencil.Normal);
    const Lanes power = Lanes::Sub(square, dot(pencil.Center));
    const Lanes reach =
      Lanes::Add(Lanes::Add(Lanes::Max(x, Lanes::Sub(zero, x)), Lanes::Max(y, Lanes::Sub(zero, y))),
        Lanes::Max(z, Lanes::Sub(zero, z)));
    unsigned mask = Lanes::GetBits(Lanes::NotGreater(
      zero, Lanes::Add(height, Lanes::Mul(Lanes::Set(pencil.HeightError), reach))));
    if (pencil.HasSphere)
    {
      mask &= Lanes::GetBits(Lanes::NotGreater(power,
        Lanes::Add(Lanes::Mul(Lanes::Set(SquareError), square),
          Lanes::Mul(Lanes::Set(pencil.CenterError), reach))));
    }
    result |= mask << i;
  }
  return result;
}
