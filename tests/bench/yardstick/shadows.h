// Shadow rays of a light. They run from the light to the shaded points, so that they share an origin; t is 1 at the
// point. A light buffer (Haines and Greenberg, 1986) lists the shapes that may be in the way.
#pragma once
#include "lists.h"

constexpr int FEW = 8;              // up to so many shapes it is faster to try each
constexpr Real BEFORE = 1 - Real(1e-4); // t up to which something is in the way

class Shadows {
public:
    // Builds the lists; throws std::runtime_error if the light is inside a shape.
    Shadows(const Scene& scene, const Lamp& lamp);

    // Mask of the rays `way`, from the light to points, that hit nothing.
    Mask unoccluded(Mask asked, const Rays& way, Lanes squared, Lanes per_squared) const;

    Lamp lamp;

private:
    Mask beyond_planes(Mask asked, const Rays& way) const;
    Mask past(const int* first, const int* last, Mask asked, const Rays& way, Lanes squared, Lanes per_squared) const;
    void make_grid(const std::vector<Shape>& shapes);

    struct Side {
        Point normal; // of a plane, to the side of the lamp
        Real height; // of the lamp above it
    };
    std::vector<Side> sides;
    Lists lists;
    View view;
    int across = 1;     // cells along an edge of the grid; with a single one every shape is tried
    Rectangle window;   // that the grid covers
    Real per_cell_x, per_cell_y;
};
