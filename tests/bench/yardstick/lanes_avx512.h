// Sixteen floats in an AVX-512 register, with bit masks in mask registers.
#pragma once
#include <cstdint>
#include <immintrin.h>

struct Mask {
    __mmask16 bits;

    friend Mask operator&(Mask a, Mask b) { return {__mmask16(a.bits & b.bits)}; }
    friend Mask operator|(Mask a, Mask b) { return {__mmask16(a.bits | b.bits)}; }
    Mask without(Mask b) const { return {__mmask16(bits & ~b.bits)}; }
};

struct Lanes {
    static constexpr int count = 16;
    __m512 v;

    Lanes() = default;
    Lanes(__m512 v) : v(v) {}
    Lanes(float all) : v(_mm512_set1_ps(all)) {}

    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
    friend Mask operator<(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)}; }
    friend Mask operator<=(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)}; }
    friend Mask operator==(Lanes a, Lanes b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_EQ_OQ)}; }
};

inline bool any(Mask m) { return m.bits != 0; }
inline unsigned bits(Mask m) { return m.bits; }
inline Lanes where(Mask m, Lanes a, Lanes b) { return _mm512_mask_blend_ps(m.bits, b.v, a.v); }

// If one operand is NaN, the result is the second operand.
inline Lanes min(Lanes a, Lanes b) { return _mm512_min_ps(a.v, b.v); }
inline Lanes max(Lanes a, Lanes b) { return _mm512_max_ps(a.v, b.v); }
inline Lanes floor(Lanes a) { return _mm512_roundscale_ps(a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
inline Lanes sqrt(Lanes a) { return _mm512_sqrt_ps(a.v); }

// Estimate of 14 bits and one Newton step: 1.5 times as fast as a division.
inline Lanes reciprocal(Lanes a) {
    Lanes y = _mm512_rcp14_ps(a.v);
    return y * (2.0f - a * y);
}

inline Lanes inverse_sqrt(Lanes a) {
    Lanes y = _mm512_rsqrt14_ps(a.v);
    return y * (1.5f - 0.5f * a * y * y);
}

inline Lanes load(const float* from) { return _mm512_loadu_ps(from); }
inline void store(float* to, Lanes a) { _mm512_storeu_ps(to, a.v); }
inline float largest(Mask m, Lanes a) { return _mm512_mask_reduce_max_ps(m.bits, a.v); }

// Converts integers below 2^24 to opaque pixels, 0xff......
inline void store_pixels(uint32_t* to, Lanes a) {
    _mm512_storeu_si512(to, _mm512_or_si512(_mm512_cvtps_epi32(a.v), _mm512_set1_epi32(int(0xff000000u))));
}
