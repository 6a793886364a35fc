// SPDX-License-Identifier: BSD-3-Clause
#include "PencilKernels.h"

#include <cmath>
#include <limits>

#if (defined(__GNUC__) || defined(__clang__)) && defined(__x86_64__)
#define CDM_HAS_X86_VECTORS
#include <immintrin.h>
#endif

namespace cdm
{
namespace
{
/** Error of sums like |x|^2 - 2 m x in units of |x|^2 (Manhattan norm), the share of m apart. */
constexpr double SquareError = 6.0 * std::numeric_limits<double>::epsilon();

#ifdef CDM_HAS_X86_VECTORS
namespace sse2
{
#define CDM_TARGET
#define CDM_TARGET_LAMBDA
struct Lanes
{
  static constexpr int Size = 2;
  using Mask = Lanes;
  __m128d V;
  static Lanes Load(const double* p) { return { _mm_loadu_pd(p) }; }
  static void Store(double* p, Lanes a) { _mm_storeu_pd(p, a.V); }
  static Lanes Set(double a) { return { _mm_set1_pd(a) }; }
  static Lanes Add(Lanes a, Lanes b) { return { _mm_add_pd(a.V, b.V) }; }
  static Lanes Sub(Lanes a, Lanes b) { return { _mm_sub_pd(a.V, b.V) }; }
  static Lanes Mul(Lanes a, Lanes b) { return { _mm_mul_pd(a.V, b.V) }; }
  static Lanes Div(Lanes a, Lanes b) { return { _mm_div_pd(a.V, b.V) }; }
  static Lanes Min(Lanes a, Lanes b) { return { _mm_min_pd(a.V, b.V) }; }
  static Lanes Max(Lanes a, Lanes b) { return { _mm_max_pd(a.V, b.V) }; }
  static Mask Less(Lanes a, Lanes b) { return { _mm_cmplt_pd(a.V, b.V) }; }
  static Mask NotGreater(Lanes a, Lanes b) { return { _mm_cmple_pd(a.V, b.V) }; }
  static Mask And(Mask a, Mask b) { return { _mm_and_pd(a.V, b.V) }; }
  static Lanes Choose(Mask m, Lanes a, Lanes b)
  {
    return { _mm_or_pd(_mm_and_pd(m.V, a.V), _mm_andnot_pd(m.V, b.V)) };
  }
  static unsigned GetBits(Mask m) { return static_cast<unsigned>(_mm_movemask_pd(m.V)); }
  static void StoreChosen(Mask m, Lanes a, double* to)
  {
    double values[Size];
    Store(values, a);
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      *to++ = values[CountTrailingZeros(bits)];
    }
  }
  static int StoreChosen(Mask m, const Id* ids, Id* to)
  {
    int count = 0;
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      to[count++] = ids[CountTrailingZeros(bits)];
    }
    return count;
  }
};
#include "PencilKernelsBody.h"
#undef CDM_TARGET
#undef CDM_TARGET_LAMBDA
} // namespace sse2

namespace avx2
{
#define CDM_TARGET __attribute__((target("avx2")))
#define CDM_TARGET_LAMBDA __attribute__((target("avx2")))
#define CDM_INLINE __attribute__((target("avx2"), always_inline)) static inline
struct Lanes
{
  static constexpr int Size = 4;
  using Mask = Lanes;
  __m256d V;
  CDM_INLINE Lanes Load(const double* p) { return { _mm256_loadu_pd(p) }; }
  CDM_INLINE void Store(double* p, Lanes a) { _mm256_storeu_pd(p, a.V); }
  CDM_INLINE Lanes Set(double a) { return { _mm256_set1_pd(a) }; }
  CDM_INLINE Lanes Add(Lanes a, Lanes b) { return { _mm256_add_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Sub(Lanes a, Lanes b) { return { _mm256_sub_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Mul(Lanes a, Lanes b) { return { _mm256_mul_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Div(Lanes a, Lanes b) { return { _mm256_div_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Min(Lanes a, Lanes b) { return { _mm256_min_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Max(Lanes a, Lanes b) { return { _mm256_max_pd(a.V, b.V) }; }
  CDM_INLINE Mask Less(Lanes a, Lanes b) { return { _mm256_cmp_pd(a.V, b.V, _CMP_LT_OQ) }; }
  CDM_INLINE Mask NotGreater(Lanes a, Lanes b) { return { _mm256_cmp_pd(a.V, b.V, _CMP_LE_OQ) }; }
  CDM_INLINE Mask And(Mask a, Mask b) { return { _mm256_and_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Choose(Mask m, Lanes a, Lanes b) { return { _mm256_blendv_pd(b.V, a.V, m.V) }; }
  CDM_INLINE unsigned GetBits(Mask m) { return static_cast<unsigned>(_mm256_movemask_pd(m.V)); }
  CDM_INLINE void StoreChosen(Mask m, Lanes a, double* to)
  {
    double values[Size];
    Store(values, a);
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      *to++ = values[CountTrailingZeros(bits)];
    }
  }
  CDM_INLINE int StoreChosen(Mask m, const Id* ids, Id* to)
  {
    int count = 0;
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      to[count++] = ids[CountTrailingZeros(bits)];
    }
    return count;
  }
};
#include "PencilKernelsBody.h"
#undef CDM_TARGET
#undef CDM_TARGET_LAMBDA
#undef CDM_INLINE
} // namespace avx2

namespace avx512
{
#define CDM_TARGET __attribute__((target("avx512f,popcnt")))
#define CDM_TARGET_LAMBDA __attribute__((target("avx512f,popcnt")))
#define CDM_INLINE __attribute__((target("avx512f,popcnt"), always_inline)) static inline
struct Lanes
{
  static constexpr int Size = 8;
  using Mask = __mmask8;
  __m512d V;
  CDM_INLINE Lanes Load(const double* p) { return { _mm512_loadu_pd(p) }; }
  CDM_INLINE void Store(double* p, Lanes a) { _mm512_storeu_pd(p, a.V); }
  CDM_INLINE Lanes Set(double a) { return { _mm512_set1_pd(a) }; }
  CDM_INLINE Lanes Add(Lanes a, Lanes b) { return { _mm512_add_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Sub(Lanes a, Lanes b) { return { _mm512_sub_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Mul(Lanes a, Lanes b) { return { _mm512_mul_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Div(Lanes a, Lanes b) { return { _mm512_div_pd(a.V, b.V) }; }
  CDM_INLINE Lanes Min(Lanes a, Lanes b) { return { _mm512_maskz_min_pd(0xff, a.V, b.V) }; }
  CDM_INLINE Lanes Max(Lanes a, Lanes b) { return { _mm512_maskz_max_pd(0xff, a.V, b.V) }; }
  CDM_INLINE Mask Less(Lanes a, Lanes b) { return _mm512_cmp_pd_mask(a.V, b.V, _CMP_LT_OQ); }
  CDM_INLINE Mask NotGreater(Lanes a, Lanes b) { return _mm512_cmp_pd_mask(a.V, b.V, _CMP_LE_OQ); }
  CDM_INLINE Mask And(Mask a, Mask b) { return static_cast<Mask>(a & b); }
  CDM_INLINE Lanes Choose(Mask m, Lanes a, Lanes b)
  {
    return { _mm512_mask_blend_pd(m, b.V, a.V) };
  }
  CDM_INLINE unsigned GetBits(Mask m) { return m; }
  CDM_INLINE void StoreChosen(Mask m, Lanes a, double* to)
  {
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(m, a.V));
  }
  CDM_INLINE int StoreChosen(Mask m, const Id* ids, Id* to)
  {
    _mm512_mask_storeu_epi32(
      to, 0xff, _mm512_maskz_compress_epi32(m, _mm512_maskz_loadu_epi32(0xff, ids)));
    return __builtin_popcount(m);
  }
};
#include "PencilKernelsBody.h"
#undef CDM_TARGET
#undef CDM_TARGET_LAMBDA
#undef CDM_INLINE
} // namespace avx512
#else
namespace scalar
{
#define CDM_TARGET
#define CDM_TARGET_LAMBDA
struct Lanes
{
  static constexpr int Size = 1;
  using Mask = bool;
  double V;
  static Lanes Load(const double* p) { return { *p }; }
  static void Store(double* p, Lanes a) { *p = a.V; }
  static Lanes Set(double a) { return { a }; }
  static Lanes Add(Lanes a, Lanes b) { return { a.V + b.V }; }
  static Lanes Sub(Lanes a, Lanes b) { return { a.V - b.V }; }
  static Lanes Mul(Lanes a, Lanes b) { return { a.V * b.V }; }
  static Lanes Div(Lanes a, Lanes b) { return { a.V / b.V }; }
  static Lanes Min(Lanes a, Lanes b) { return { a.V < b.V ? a.V : b.V }; }
  static Lanes Max(Lanes a, Lanes b) { return { a.V > b.V ? a.V : b.V }; }
  static Mask Less(Lanes a, Lanes b) { return a.V < b.V; }
  static Mask NotGreater(Lanes a, Lanes b) { return a.V <= b.V; }
  static Mask And(Mask a, Mask b) { return a && b; }
  static Lanes Choose(Mask m, Lanes a, Lanes b) { return m ? a : b; }
  static unsigned GetBits(Mask m) { return m ? 1u : 0u; }
  static void StoreChosen(Mask m, Lanes a, double* to)
  {
    double values[Size];
    Store(values, a);
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      *to++ = values[CountTrailingZeros(bits)];
    }
  }
  static int StoreChosen(Mask m, const Id* ids, Id* to)
  {
    int count = 0;
    for (unsigned bits = GetBits(m); bits != 0; bits &= bits - 1)
    {
      to[count++] = ids[CountTrailingZeros(bits)];
    }
    return count;
  }
};
#include "PencilKernelsBody.h"
#undef CDM_TARGET
#undef CDM_TARGET_LAMBDA
} // namespace scalar
#endif
} // namespace

const PencilKernels& GetPencilKernels()
{
#ifdef CDM_HAS_X86_VECTORS
#define CDM_KERNELS(set)                                                                           \
  PencilKernels                                                                                    \
  {                                                                                                \
    set::Select, set::Collect, set::Filter, set::TestBoxes, set::TestSlabs, set::TestDistance,     \
      set::ViewLeaf                                                                                \
  }
  static const PencilKernels Kernels = __builtin_cpu_supports("avx512f") ? CDM_KERNELS(avx512)
    : __builtin_cpu_supports("avx2")                                     ? CDM_KERNELS(avx2)
                                                                         : CDM_KERNELS(sse2);
#undef CDM_KERNELS
#else
  static const PencilKernels Kernels{ scalar::Select, scalar::Collect, scalar::Filter,
    scalar::TestBoxes, scalar::TestSlabs, scalar::TestDistance, scalar::ViewLeaf };
#endif
  return Kernels;
}
} // namespace cdm
