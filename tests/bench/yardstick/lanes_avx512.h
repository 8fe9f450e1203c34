// Sixteen floats, or eight doubles, in an AVX-512 register, with bit masks in mask registers.
#pragma once
#include <cstdint>
#include <immintrin.h>

#ifdef DOUBLE
using Register = __m512d;
using Bits = __mmask8;
#define AVX512(name) _mm512_##name##pd
#define AVX512_MASK(name) _mm512_##name##pd_mask
#else
using Register = __m512;
using Bits = __mmask16;
#define AVX512(name) _mm512_##name##ps
#define AVX512_MASK(name) _mm512_##name##ps_mask
#endif

struct Mask {
    Bits bits;

    friend Mask operator&(Mask a, Mask b) { return {Bits(a.bits & b.bits)}; }
    friend Mask operator|(Mask a, Mask b) { return {Bits(a.bits | b.bits)}; }
    Mask without(Mask b) const { return {Bits(bits & ~b.bits)}; }
};

struct Lanes {
    static constexpr int count = 64 / sizeof(Real);
    Register v;

    Lanes() = default;
    Lanes(Register v) : v(v) {}
    Lanes(Real all) : v(AVX512(set1_)(all)) {}

    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
    friend Mask operator<(Lanes a, Lanes b) { return {AVX512_MASK(cmp_)(a.v, b.v, _CMP_LT_OQ)}; }
    friend Mask operator<=(Lanes a, Lanes b) { return {AVX512_MASK(cmp_)(a.v, b.v, _CMP_LE_OQ)}; }
    friend Mask operator==(Lanes a, Lanes b) { return {AVX512_MASK(cmp_)(a.v, b.v, _CMP_EQ_OQ)}; }
};

inline bool any(Mask m) { return m.bits != 0; }
inline unsigned bits(Mask m) { return m.bits; }
inline Lanes where(Mask m, Lanes a, Lanes b) { return AVX512(mask_blend_)(m.bits, b.v, a.v); }

// If one operand is NaN, the result is the second operand.
inline Lanes min(Lanes a, Lanes b) { return AVX512(min_)(a.v, b.v); }
inline Lanes max(Lanes a, Lanes b) { return AVX512(max_)(a.v, b.v); }
inline Lanes floor(Lanes a) { return AVX512(roundscale_)(a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
inline Lanes sqrt(Lanes a) { return AVX512(sqrt_)(a.v); }

// Estimate of 14 bits and a Newton step for floats, two for doubles: 1.5 times as fast as a division of floats.
inline Lanes reciprocal(Lanes a) {
    Lanes y = AVX512(rcp14_)(a.v);
    for (size_t step = 0; step < sizeof(Real) / 4; step++) y = y * (Real(2) - a * y);
    return y;
}

inline Lanes inverse_sqrt(Lanes a) {
    Lanes y = AVX512(rsqrt14_)(a.v);
    for (size_t step = 0; step < sizeof(Real) / 4; step++) y = y * (Real(1.5) - Real(0.5) * a * y * y);
    return y;
}

inline Lanes load(const Real* from) { return AVX512(loadu_)(from); }
inline void store(Real* to, Lanes a) { AVX512(storeu_)(to, a.v); }
inline Real largest(Mask m, Lanes a) { return AVX512(mask_reduce_max_)(m.bits, a.v); }

// Converts integers below 2^24 to opaque pixels, 0xff......
inline void store_pixels(uint32_t* to, Lanes a) {
#ifdef DOUBLE
    _mm256_storeu_si256((__m256i*)to, _mm256_or_si256(_mm512_cvtpd_epi32(a.v), _mm256_set1_epi32(int(0xff000000u))));
#else
    _mm512_storeu_si512(to, _mm512_or_si512(_mm512_cvtps_epi32(a.v), _mm512_set1_epi32(int(0xff000000u))));
#endif
}
