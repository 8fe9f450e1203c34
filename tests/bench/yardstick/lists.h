// Culling by direction: for every cell of a grid over a view, the shapes that rays through it may hit, nearest first.
#pragma once
#include "seen.h"

struct View { // from a point: an orthonormal frame
    Point at, right, up, forward;
};

struct Rectangle { // of slopes x / z and y / z in a view
    Real left = INFINITY, right = -INFINITY, bottom = INFINITY, top = -INFINITY;
};

struct Cells { // of a grid, both ends included; none where last < first
    int left, right, top, bottom;
};

struct Lists {
    std::vector<Seen> shapes; // as they are seen from the point
    std::vector<int> start;   // of each cell, and the end of the last one
    std::vector<int> members; // indices into `shapes`
};

// Covers all of the shape that lies in front; endless where the shape reaches beside or around the point.
Rectangle rectangle(const View& view, const Shape& shape);

std::vector<Seen> all_seen_from(Point point, const std::vector<Shape>& shapes);

// Indices, by `near`.
std::vector<int> nearest_first(const std::vector<Seen>& shapes);

// `start` and `members` of so many cells, `across` of them in a row.
void fill(Lists& lists, const std::vector<Cells>& covered, int across, int cells);
