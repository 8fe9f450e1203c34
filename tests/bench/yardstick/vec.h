// Points, directions and colours: of single numbers, of lanes of them, or of both mixed.
#pragma once
#include <cmath>

#ifdef DOUBLE
using Real = double;
#else
using Real = float;
#endif

#if defined(__AVX512F__)
#include "lanes_avx512.h"
#else
#include "lanes_any.h"
#endif

template <class T> struct Vec {
    T x, y, z;
};
using Point = Vec<Real>;
using Rays = Vec<Lanes>;

template <class A, class B> auto operator+(Vec<A> a, Vec<B> b) { return Vec{a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class A, class B> auto operator-(Vec<A> a, Vec<B> b) { return Vec{a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class A, class B> auto operator*(A a, Vec<B> b) { return Vec{a * b.x, a * b.y, a * b.z}; }
template <class A, class B> auto operator*(Vec<A> a, Vec<B> b) { return Vec{a.x * b.x, a.y * b.y, a.z * b.z}; }
template <class A, class B> auto dot(Vec<A> a, Vec<B> b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }

inline Rays where(Mask m, Rays a, Rays b) { return {where(m, a.x, b.x), where(m, a.y, b.y), where(m, a.z, b.z)}; }
inline Rays all(Point a) { return {a.x, a.y, a.z}; }

inline Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Real length(Point a) { return std::sqrt(dot(a, a)); }
inline Point unit(Point a) { return 1 / length(a) * a; }
