/// \file  As many floats as one register holds: eight with AVX, four with SSE2.
/// Host only.
///
/// + - * / come from the compiler and round as their scalar counterparts do. Without SSE2, and
/// under nvcc, RT_HD code tests one triangle at a time instead.
#pragma once

#if defined(__SSE2__) && !defined(__CUDACC__)

#include <cstdint>
#include <immintrin.h>

namespace plumb::lanes {

#ifdef __AVX__
using Lanes = __m256;
inline Lanes load(const float* p) { return _mm256_load_ps(p); }
inline void store(float* p, Lanes x) { _mm256_store_ps(p, x); }
inline Lanes broadcast(float x) { return _mm256_set1_ps(x); }
/// a < b ? a : b, as _mm_min_ps: b where either is NaN.
inline Lanes min(Lanes a, Lanes b) { return _mm256_min_ps(a, b); }
/// a > b ? a : b, as _mm_max_ps: b where either is NaN.
inline Lanes max(Lanes a, Lanes b) { return _mm256_max_ps(a, b); }
inline Lanes exclusive_or(Lanes a, Lanes b) { return _mm256_xor_ps(a, b); }
/// One bit a lane: its sign, or the outcome of a comparison (false where either is NaN).
inline unsigned signs(Lanes x) { return static_cast<unsigned>(_mm256_movemask_ps(x)); }
inline unsigned equal(Lanes a, Lanes b) { return signs(_mm256_cmp_ps(a, b, _CMP_EQ_OQ)); }
inline unsigned less(Lanes a, Lanes b) { return signs(_mm256_cmp_ps(a, b, _CMP_LT_OQ)); }
inline unsigned not_greater(Lanes a, Lanes b) { return signs(_mm256_cmp_ps(a, b, _CMP_LE_OQ)); }
#else
using Lanes = __m128;
inline Lanes load(const float* p) { return _mm_load_ps(p); }
inline void store(float* p, Lanes x) { _mm_store_ps(p, x); }
inline Lanes broadcast(float x) { return _mm_set1_ps(x); }
inline Lanes min(Lanes a, Lanes b) { return _mm_min_ps(a, b); }
inline Lanes max(Lanes a, Lanes b) { return _mm_max_ps(a, b); }
inline Lanes exclusive_or(Lanes a, Lanes b) { return _mm_xor_ps(a, b); }
inline unsigned signs(Lanes x) { return static_cast<unsigned>(_mm_movemask_ps(x)); }
inline unsigned equal(Lanes a, Lanes b) { return signs(_mm_cmpeq_ps(a, b)); }
inline unsigned less(Lanes a, Lanes b) { return signs(_mm_cmplt_ps(a, b)); }
inline unsigned not_greater(Lanes a, Lanes b) { return signs(_mm_cmple_ps(a, b)); }
#endif

inline constexpr std::uint32_t count = sizeof(Lanes) / sizeof(float);

} // namespace plumb::lanes

#endif
