#include "shadows.h"
#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace {

constexpr Real WIDEST = 50;                                  // slope that a grid may reach to
constexpr Real CELLS = Real(2.56), FEWEST_ACROSS = 64, MOST_ACROSS = 1024; // along an edge, for each sqrt(shape)

// View from the light to the middle of all shapes.
View towards(Point at, const std::vector<Shape>& shapes) {
    Point sum{};
    for (const Shape& shape : shapes) sum = sum + (shape.centre - at);
    Point forward = unit(sum);
    Point right = unit(cross(forward, std::fabs(forward.y) < Real(0.9) ? Point{0, 1, 0} : Point{1, 0, 0}));
    return {at, right, cross(right, forward), forward};
}

} // namespace

Shadows::Shadows(const Scene& scene, const Lamp& lamp) : lamp(lamp) {
    for (const Plane& plane : scene.planes) {
        Real height = dot(plane.normal, lamp.at - plane.at);
        sides.push_back({(height < 0 ? -Real(1.0) : Real(1.0)) * plane.normal, std::fabs(height)});
    }
    lists.shapes = all_seen_from(lamp.at, scene.shapes);
    if (std::any_of(lists.shapes.begin(), lists.shapes.end(), is_inside))
        throw std::runtime_error("a lamp is inside of a shape: the yardstick does not render that");
    if (scene.shapes.size() > FEW) make_grid(scene.shapes);
    if (across == 1) lists.members = nearest_first(lists.shapes);
}

// A light among the shapes cannot have all of them in front: its light buffer stays a single cell.
void Shadows::make_grid(const std::vector<Shape>& shapes) {
    view = towards(lamp.at, shapes);
    std::vector<Rectangle> rectangles;
    for (const Shape& shape : shapes) {
        Rectangle r = rectangle(view, shape);
        rectangles.push_back(r);
        window = {std::min(window.left, r.left), std::max(window.right, r.right), std::min(window.bottom, r.bottom),
                  std::max(window.top, r.top)};
        if (!(-WIDEST < r.left && r.right < WIDEST && -WIDEST < r.bottom && r.top < WIDEST)) return;
    }
    across = int(std::clamp(CELLS * std::sqrt(Real(shapes.size())), FEWEST_ACROSS, MOST_ACROSS));
    per_cell_x = Real(across) / (window.right - window.left) * Real(0.99999);
    per_cell_y = Real(across) / (window.top - window.bottom) * Real(0.99999);
    std::vector<Cells> covered;
    for (const Rectangle& r : rectangles)
        covered.push_back({int((r.left - window.left) * per_cell_x), int((r.right - window.left) * per_cell_x),
                           int((r.bottom - window.bottom) * per_cell_y), int((r.top - window.bottom) * per_cell_y)});
    fill(lists, covered, across, across * across);
}

inline Mask Shadows::beyond_planes(Mask asked, const Rays& way) const {
    for (const Side& side : sides) {
        Lanes height = dot(side.normal, way) + side.height;
        asked = asked.without(height < (BEFORE - 1) * side.height);
    }
    return asked;
}

inline Mask Shadows::past(const int* first, const int* last, Mask asked, const Rays& way, Lanes squared,
                          Lanes per_squared) const {
    Real farthest = std::sqrt(largest(asked, squared));
    for (const int* each = first; each < last; each++) {
        const Seen& shape = lists.shapes[*each];
        if (shape.near > farthest) break;
        asked = asked.without(enter(shape, way, squared, per_squared, BEFORE).hit);
        if (!any(asked)) break;
    }
    return asked;
}

Mask Shadows::unoccluded(Mask asked, const Rays& way, Lanes squared, Lanes per_squared) const {
    asked = beyond_planes(asked, way);
    if (!any(asked)) return asked;
    const int* members = lists.members.data();
    if (across == 1) return past(members, members + lists.members.size(), asked, way, squared, per_squared);
    Lanes depth = dot(view.forward, way), per_depth = reciprocal(depth);
    Lanes x = (dot(view.right, way) * per_depth - window.left) * per_cell_x;
    Lanes y = (dot(view.up, way) * per_depth - window.bottom) * per_cell_y;
    Mask inside = asked & (Lanes(0) < depth) & (Lanes(0) <= x) & (Lanes(0) <= y) & (x < Real(across)) &
                  (y < Real(across));
    if (!any(inside)) return asked;
    Lanes cell = floor(y) * Real(across) + floor(x);
    Real cells[Lanes::count];
    store(cells, cell);
    while (any(inside)) { // a cell after the other, with the rays that pass it
        Real number = cells[__builtin_ctz(bits(inside))];
        Mask together = inside & (cell == number);
        const int* start = &lists.start[int(number)];
        Mask through = past(members + start[0], members + start[1], together, way, squared, per_squared);
        asked = asked.without(together.without(through));
        inside = inside.without(together);
    }
    return asked;
}
