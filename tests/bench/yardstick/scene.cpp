#include "scene.h"
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace {

// Numbers of a line, separated by blanks and commas.
std::vector<Real> numbers(const char* text) {
    std::vector<Real> found;
    for (;;) {
        while (*text == ' ' || *text == '\t' || *text == ',' || *text == '\r') text++;
        if (*text == '\0' || *text == '#') return found;
        char* end;
        found.push_back(Real(strtod(text, &end)));
        if (end == text) throw std::runtime_error("no number at: " + std::string(text));
        text = end;
    }
}

// Takes the numbers of a line from left to right.
struct Fields {
    std::vector<Real> all;
    size_t next = 0;

    bool left() const { return next < all.size(); }
    Real number() { return left() ? all[next++] : throw std::runtime_error("too few numbers"); }
    Point point() {
        Real x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Point direction() { return unit(point()); }
    Point colour() { return 1 / Real(255.0) * point(); }
};

void read_line(Scene& scene, const std::string& code, Fields fields) {
    if (code == "A") {
        Real brightness = fields.number();
        scene.ambient = brightness * fields.colour();
    } else if (code == "C") {
        scene.eye = fields.point();
        scene.forward = fields.direction();
        scene.slope = std::tan(fields.number() * Real(M_PI) / 360);
    } else if (code == "L" || code == "l") {
        Point at = fields.point();
        Real brightness = fields.number();
        scene.lamps.push_back({at, brightness * (fields.left() ? fields.colour() : Point{1, 1, 1})});
    } else if (code == "pl") {
        Point at = fields.point(), normal = fields.direction();
        scene.planes.push_back({at, normal, fields.colour()});
    } else if (code == "sp") {
        Point centre = fields.point();
        Real radius = fields.number() / 2;
        scene.shapes.push_back({centre, {0, 1, 0}, radius, 0, fields.colour(), false});
    } else if (code == "cy") {
        Point centre = fields.point(), axis = fields.direction();
        Real radius = fields.number() / 2, half = fields.number() / 2;
        scene.shapes.push_back({centre, axis, radius, half, fields.colour(), true});
    } else {
        throw std::runtime_error("unknown element");
    }
    if (fields.left()) throw std::runtime_error("too many numbers");
}

} // namespace

Scene read_scene(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    Scene scene;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
        number++;
        size_t start = line.find_first_not_of(" \t\r");
        if (start == std::string::npos || line[start] == '#') continue;
        size_t end = std::min(line.find_first_of(" \t", start), line.size());
        try {
            read_line(scene, line.substr(start, end - start), {numbers(line.c_str() + end)});
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(path + ":" + std::to_string(number) + ": " + error.what());
        }
    }
    return scene;
}
