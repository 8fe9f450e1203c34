// Shapes seen from a common origin of many rays, the eye or a light: values that all these rays share, computed once.
#pragma once
#include "scene.h"

constexpr Real AT_LEAST = Real(1e-3); // t of a hit

struct alignas(64) Seen {
    Point from;  // the point relative to the centre; for a cylinder, the part across its axis
    Real power; // |from|^2 - radius^2
    Point axis;  // of a cylinder
    Real along; // the part of the point relative to the centre along it
    Real half;  // of its height
    Real near;  // no point of the shape is nearer
    int index;
    bool is_cylinder;
};

inline Seen seen_from(Point point, const Shape& shape, int index) {
    Point from = point - shape.centre;
    Real along = dot(from, shape.axis);
    Seen seen{from, 0, shape.axis, along, shape.half, 0, index, shape.is_cylinder};
    seen.near = length(from) - std::hypot(shape.radius, shape.half);
    if (shape.is_cylinder) seen.from = from - along * shape.axis;
    seen.power = dot(seen.from, seen.from) - shape.radius * shape.radius;
    return seen;
}

inline bool is_inside(const Seen& seen) {
    return seen.power <= 0 && (!seen.is_cylinder || std::fabs(seen.along) <= seen.half);
}

// Entry distances of rays into a shape: t along `direction`, whose squared length is `squared`.
struct Entry {
    Mask hit;
    Lanes t;
    Mask on_cap;
};

inline Entry enter_sphere(const Seen& sphere, const Rays& direction, Lanes squared, Lanes per_squared, Lanes limit) {
    Lanes b = dot(sphere.from, direction);
    Lanes discriminant = b * b - squared * sphere.power;
    Mask hit = Lanes(0) <= discriminant;
    Lanes t = 0;
    if (any(hit)) {
        t = (Lanes(0) - b - sqrt(discriminant)) * per_squared;
        hit = hit & (Lanes(AT_LEAST) < t) & (t < limit);
    }
    return {hit, t, Mask{}};
}

// A ray is inside of the endless tube for one interval of t and between the planes of the caps for another one.
inline Entry enter_cylinder(const Seen& tube, const Rays& direction, Lanes squared, Lanes limit) {
    Lanes rise = dot(tube.axis, direction);
    Lanes b = dot(tube.from, direction);
    Lanes a = squared - rise * rise;
    Lanes discriminant = b * b - a * tube.power;
    Mask hit = Lanes(0) <= discriminant;
    Lanes t = 0;
    Mask on_cap{};
    if (any(hit)) {
        Lanes root = sqrt(discriminant), per_a = reciprocal(max(a, Real(1e-8))), per_rise = reciprocal(rise);
        Lanes side = (Lanes(0) - b - root) * per_a, other_side = (root - b) * per_a;
        Lanes bottom = (-tube.half - tube.along) * per_rise, top = (tube.half - tube.along) * per_rise;
        Lanes cap = min(bottom, top), other_cap = max(bottom, top);
        on_cap = side < cap;
        t = max(cap, side);
        hit = hit & (t <= min(other_cap, other_side)) & (Lanes(AT_LEAST) < t) & (t < limit);
    }
    return {hit, t, on_cap};
}

inline Entry enter(const Seen& shape, const Rays& direction, Lanes squared, Lanes per_squared, Lanes limit) {
    return shape.is_cylinder ? enter_cylinder(shape, direction, squared, limit)
                             : enter_sphere(shape, direction, squared, per_squared, limit);
}
