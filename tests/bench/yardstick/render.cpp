#include "render.h"
#include <algorithm>
#include <stdexcept>

namespace {

constexpr int TILE = 16; // pixels along an edge
constexpr int ACROSS = 4, DOWN = Lanes::count / ACROSS;
constexpr Real FAR = Real(1e30);

View view_of(const Scene& scene) {
    bool upright = std::fabs(scene.forward.x) + std::fabs(scene.forward.z) > 0;
    Point right = upright ? unit(cross(scene.forward, {0, 1, 0})) : Point{1, 0, 0};
    return {scene.eye, right, cross(right, scene.forward), scene.forward};
}

struct Surface {
    Lanes t = FAR;
    Rays normal = all({0, 0, 0}), colour = all({0, 0, 0});

    void take(Mask nearer, Lanes new_t, const Rays& new_normal, Point new_colour) {
        t = where(nearer, new_t, t);
        normal = where(nearer, new_normal, normal);
        colour = where(nearer, all(new_colour), colour);
    }
};

inline Rays normal_of(const Seen& shape, const Entry& entry, const Rays& direction, Real per_radius) {
    if (!shape.is_cylinder) return Lanes(per_radius) * (shape.from + entry.t * direction);
    Lanes rise = dot(shape.axis, direction);
    Rays side = Lanes(per_radius) * (shape.from + entry.t * (direction - rise * shape.axis));
    Point cap = (shape.along < 0 ? -Real(1.0) : Real(1.0)) * shape.axis; // the one that is seen
    return where(entry.on_cap, all(cap), side);
}

inline Lanes level(Lanes light) { return floor(min(light, Real(1.0)) * Real(255.0) + Real(0.5)); }

} // namespace

Renderer::Renderer(const Scene& scene, int width, int height)
    : scene(scene), width(width), height(height), across(width / TILE), down(height / TILE), view(view_of(scene)),
      slope_x(scene.slope), slope_y(scene.slope * Real(height) / Real(width)) {
    for (const Plane& plane : scene.planes) heights.push_back(dot(plane.normal, scene.eye - plane.at));
    for (const Lamp& lamp : scene.lamps) shadows.emplace_back(scene, lamp);
    eye.shapes = all_seen_from(scene.eye, scene.shapes);
    if (std::any_of(eye.shapes.begin(), eye.shapes.end(), is_inside))
        throw std::runtime_error("the eye is inside of a shape: the yardstick does not render that");
    Real columns[Lanes::count], rows[Lanes::count];
    for (int i = 0; i < Lanes::count; i++) {
        columns[i] = Real(i % ACROSS) + Real(0.5);
        rows[i] = Real(i / ACROSS) + Real(0.5);
    }
    column = load(columns);
    row = load(rows);
}

void Renderer::find_what_tiles_show() {
    eye.shapes = all_seen_from(scene.eye, scene.shapes);
    std::vector<Cells> covered;
    covered.reserve(scene.shapes.size());
    auto cell = [](Real slope, Real most, int cells) { // slopes from -most to most
        return int(std::floor(std::clamp((slope / most + 1) * Real(0.5) * Real(cells), -Real(1.0), Real(cells))));
    };
    for (const Shape& shape : scene.shapes) {
        Rectangle r = rectangle(view, shape);
        covered.push_back({std::max(cell(r.left, slope_x, across), 0), std::min(cell(r.right, slope_x, across), across - 1),
                           std::max(cell(-r.top, slope_y, down), 0), std::min(cell(-r.bottom, slope_y, down), down - 1)});
    }
    fill(eye, covered, across, across * down);
}

void Renderer::render(Picture& picture) {
    find_what_tiles_show();
#pragma omp parallel for schedule(dynamic, 1)
    for (int tile_row = 0; tile_row < down; tile_row++)
        for (int tile_column = 0; tile_column < across; tile_column++)
            for (int y = tile_row * TILE; y < (tile_row + 1) * TILE; y += DOWN)
                for (int x = tile_column * TILE; x < (tile_column + 1) * TILE; x += ACROSS) {
                    uint32_t words[Lanes::count];
                    store_pixels(words, packet(tile_row * across + tile_column, x, y));
                    for (int i = 0; i < DOWN; i++)
                        std::copy_n(words + i * ACROSS, ACROSS, &picture.pixels[size_t(y + i) * width + x]);
                }
}

// Pixels as numbers 0xRRGGBB. Directions are not normalised: their depth is 1.
inline Lanes Renderer::packet(int tile, int left, int top) const {
    Lanes x = (column + Real(left)) * (2 * slope_x / Real(width)) - slope_x;
    Lanes y = slope_y - (row + Real(top)) * (2 * slope_y / Real(height));
    Rays direction = view.forward + x * view.right + y * view.up;
    Lanes squared = x * x + y * y + Real(1.0), per_squared = reciprocal(squared);
    Surface nearest;
    for (size_t i = 0; i < scene.planes.size(); i++) {
        const Plane& plane = scene.planes[i];
        Lanes t = -heights[i] * reciprocal(dot(plane.normal, direction));
        Mask nearer = (Lanes(AT_LEAST) < t) & (t < nearest.t);
        nearest.take(nearer, t, all((heights[i] < 0 ? -Real(1.0) : Real(1.0)) * plane.normal), plane.colour);
    }
    Real farthest = INFINITY; // that a point of a shape may be and still be seen
    const int* last = eye.members.data() + eye.start[tile + 1];
    for (const int* each = eye.members.data() + eye.start[tile]; each < last; each++) {
        const Seen& shape = eye.shapes[*each];
        if (shape.near > farthest) break;
        Entry entry = enter(shape, direction, squared, per_squared, nearest.t);
        if (!any(entry.hit)) continue;
        const Shape& whole = scene.shapes[shape.index];
        nearest.take(entry.hit, entry.t, normal_of(shape, entry, direction, 1 / whole.radius), whole.colour);
        Lanes distance = min(nearest.t * nearest.t * squared, FAR);
        farthest = std::sqrt(largest(distance == distance, distance));
    }
    Mask hit = nearest.t < FAR;
    if (!any(hit)) return 0;
    Rays light = nearest.colour * light_at(view.at + nearest.t * direction, nearest.normal, hit);
    Lanes pixel = (level(light.x) * Real(256.0) + level(light.y)) * Real(256.0) + level(light.z);
    return where(hit, pixel, 0);
}

inline Rays Renderer::light_at(const Rays& point, const Rays& normal, Mask hit) const {
    Rays light = all(scene.ambient);
    for (const Shadows& each : shadows) {
        Rays way = point - each.lamp.at;
        Lanes squared = dot(way, way), cosine = Lanes(0) - dot(normal, way);
        Mask lit = hit & (Lanes(0) < cosine);
        if (!any(lit)) continue;
        Lanes per_length = inverse_sqrt(squared);
        lit = each.unoccluded(lit, way, squared, per_length * per_length);
        light = light + where(lit, cosine * per_length, 0) * all(each.lamp.light);
    }
    return light;
}
