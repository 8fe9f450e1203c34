// Eight floats, or four doubles, in the compiler's vector types (GCC, Clang), for any processor.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>
#ifdef __AVX__
#include <immintrin.h>
#ifdef DOUBLE
using Register = __m256d;
#define AVX(name) _mm256_##name##_pd
#else
using Register = __m256;
#define AVX(name) _mm256_##name##_ps
#endif
#endif

using Whole = std::conditional_t<sizeof(Real) == 8, int64_t, int32_t>;
typedef Real Floats __attribute__((vector_size(32)));
typedef Whole Ints __attribute__((vector_size(32)));
typedef int32_t Words __attribute__((vector_size(128 / sizeof(Real))));

struct Mask {
    Ints all; // -1 or 0 each

    friend Mask operator&(Mask a, Mask b) { return {a.all & b.all}; }
    friend Mask operator|(Mask a, Mask b) { return {a.all | b.all}; }
    Mask without(Mask b) const { return {all & ~b.all}; }
};

struct Lanes {
    static constexpr int count = 32 / sizeof(Real);
    Floats v;

    Lanes() = default;
    Lanes(Floats v) : v(v) {}
    Lanes(Real all) : v(all - Floats{}) {}

    friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
    friend Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
    friend Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
    friend Mask operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
};

inline unsigned bits(Mask m) {
#ifdef __AVX__
    return unsigned(AVX(movemask)(Register(m.all)));
#else
    unsigned found = 0;
    for (int i = 0; i < Lanes::count; i++) found |= unsigned(m.all[i] & 1) << i;
    return found;
#endif
}

inline bool any(Mask m) {
#ifdef __AVX__
    return bits(m) != 0;
#else
    int64_t words[sizeof m / 8], all = 0;
    memcpy(words, &m.all, sizeof words);
    for (int64_t word : words) all |= word;
    return all != 0;
#endif
}

inline Lanes where(Mask m, Lanes a, Lanes b) { return m.all ? a.v : b.v; }

// If one operand is NaN, the result is the second operand.
inline Lanes min(Lanes a, Lanes b) { return a.v < b.v ? a.v : b.v; }
inline Lanes max(Lanes a, Lanes b) { return a.v > b.v ? a.v : b.v; }
inline Lanes reciprocal(Lanes a) { return Real(1) / a.v; }

inline Lanes floor(Lanes a) {
    for (int i = 0; i < Lanes::count; i++) a.v[i] = std::floor(a.v[i]);
    return a;
}

inline Lanes sqrt(Lanes a) {
#ifdef __AVX__
    return Floats(AVX(sqrt)(Register(a.v)));
#else
    for (int i = 0; i < Lanes::count; i++) a.v[i] = std::sqrt(a.v[i]);
    return a;
#endif
}

inline Lanes inverse_sqrt(Lanes a) { return reciprocal(sqrt(a)); }

inline Lanes load(const Real* from) {
    Lanes a;
    memcpy(&a.v, from, sizeof a.v);
    return a;
}

inline void store(Real* to, Lanes a) { memcpy(to, &a.v, sizeof a.v); }

inline Real largest(Mask m, Lanes a) {
    a = where(m, a, -INFINITY);
    Real most = a.v[0];
    for (int i = 1; i < Lanes::count; i++) most = a.v[i] > most ? a.v[i] : most;
    return most;
}

// Converts integers below 2^24 to opaque pixels, 0xff......
inline void store_pixels(uint32_t* to, Lanes a) {
    Words words = __builtin_convertvector(a.v, Words) | int32_t(0xff000000u);
    memcpy(to, &words, sizeof words);
}
