#include "lists.h"
#include <algorithm>
#include <utility>

namespace {

// Slopes of the tangents from the origin to a disc of a radius around (x, z).
std::pair<Real, Real> tangents(Real x, Real z, Real radius) {
    Real below = z * z - radius * radius;
    Real spread = radius * std::sqrt(x * x + below);
    return {(x * z - spread) / below, (x * z + spread) / below};
}

} // namespace

// A cylinder lies in the convex hull of two balls of its radius about its ends.
Rectangle rectangle(const View& view, const Shape& shape) {
    Rectangle found;
    int balls = shape.is_cylinder ? 2 : 1, behind = 0;
    bool around = false;
    for (int i = 0; i < balls; i++) {
        Point place = shape.centre + (i ? -shape.half : shape.half) * shape.axis - view.at;
        Real x = dot(place, view.right), y = dot(place, view.up), z = dot(place, view.forward);
        behind += z <= -shape.radius;
        around |= z <= shape.radius * Real(1.0001);
        if (around) continue;
        auto [left, right] = tangents(x, z, shape.radius);
        auto [bottom, top] = tangents(y, z, shape.radius);
        found = {std::min(found.left, left), std::max(found.right, right), std::min(found.bottom, bottom),
                 std::max(found.top, top)};
    }
    if (behind == balls) return {};
    if (around) return {-INFINITY, INFINITY, -INFINITY, INFINITY};
    return found;
}

std::vector<Seen> all_seen_from(Point point, const std::vector<Shape>& shapes) {
    std::vector<Seen> seen;
    seen.reserve(shapes.size());
    for (size_t i = 0; i < shapes.size(); i++) seen.push_back(seen_from(point, shapes[i], int(i)));
    return seen;
}

std::vector<int> nearest_first(const std::vector<Seen>& shapes) {
    std::vector<std::pair<Real, int>> order;
    order.reserve(shapes.size());
    for (size_t i = 0; i < shapes.size(); i++) order.emplace_back(shapes[i].near, int(i));
    std::sort(order.begin(), order.end());
    std::vector<int> indices;
    indices.reserve(order.size());
    for (auto [near, index] : order) indices.push_back(index);
    return indices;
}

// Counting sort: counts the members of each cell, then writes them in place.
void fill(Lists& lists, const std::vector<Cells>& covered, int across, int cells) {
    auto& start = lists.start;
    start.assign(cells + 1, 0);
    for (const Cells& c : covered)
        for (int y = c.top; y <= c.bottom; y++)
            for (int x = c.left; x <= c.right; x++) start[y * across + x]++;
    for (int i = 0, before = 0; i <= cells; i++) before += std::exchange(start[i], before);
    lists.members.resize(start[cells]);
    for (int index : nearest_first(lists.shapes)) {
        const Cells& c = covered[index];
        for (int y = c.top; y <= c.bottom; y++)
            for (int x = c.left; x <= c.right; x++) lists.members[start[y * across + x]++] = index;
    }
    for (int i = cells; i > 0; i--) start[i] = start[i - 1]; // each had moved to the end of its cell
    start[0] = 0;
}
