// What a lamp lights. Shadow rays run from the lamp to the points that are shaded, so that they have an origin in
// common: t is 1 at the point. A grid of lists over what the lamp sees (a light buffer: Haines and Greenberg, 1986)
// tells which shapes may be in the way.
#pragma once
#include "lists.h"

constexpr int FEW = 8;              // up to so many shapes it is faster to try each
constexpr float BEFORE = 1 - 1e-4f; // t up to which something is in the way

class Shadows {
public:
    // Works out the lists; throws std::runtime_error for a lamp inside of a shape.
    Shadows(const Scene& scene, const Lamp& lamp);

    // Those of the rays `way`, from the lamp to points, that meet nothing.
    Mask unhidden(Mask asked, const Rays& way, Lanes squared, Lanes per_squared) const;

    Lamp lamp;

private:
    Mask beyond_planes(Mask asked, const Rays& way) const;
    Mask past(const int* first, const int* last, Mask asked, const Rays& way, Lanes squared, Lanes per_squared) const;
    void make_grid(const std::vector<Shape>& shapes);

    struct Side {
        Point normal; // of a plane, to the side of the lamp
        float height; // of the lamp above it
    };
    std::vector<Side> sides;
    Lists lists;
    View view;
    int across = 1;     // cells along an edge of the grid; with a single one every shape is tried
    Rectangle window;   // that the grid covers
    float per_cell_x, per_cell_y;
};
