// Scene of the yardstick: one camera, ambient light, point lights, planes, spheres and cylinders.
#pragma once
#include "vec.h"
#include <string>
#include <vector>

struct Lamp {
    Point at;
    Point light; // colour times brightness
};

struct Plane {
    Point at, normal, colour;
};

struct Shape { // a sphere, or a cylinder with both caps
    Point centre, axis;
    Real radius, half; // of its height; 0 for a sphere
    Point colour;
    bool is_cylinder;
};

struct Scene {
    Point eye{}, forward{0, 0, 1};
    Real slope = 1; // x / z at the right edge of the picture
    Point ambient{};
    std::vector<Lamp> lamps;
    std::vector<Plane> planes;
    std::vector<Shape> shapes;
};

// Throws std::runtime_error for a file that it cannot read.
Scene read_scene(const std::string& path);
