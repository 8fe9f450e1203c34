// A frame: packets of neighbouring pixels, whose rays are traced at once.
#pragma once
#include "shadows.h"
#include <cstdint>

struct Picture {
    int width, height; // multiples of 16
    std::vector<uint32_t> pixels; // 0xffRRGGBB

    Picture(int width, int height) : width(width), height(height), pixels(size_t(width) * height) {}
};

class Renderer {
public:
    // Throws std::runtime_error if the eye or a light is inside a shape.
    Renderer(const Scene& scene, int width, int height);

    // The eye's lists are built for each frame, those of the lights only once.
    void render(Picture& picture);

private:
    void find_what_tiles_show();
    Lanes packet(int tile, int left, int top) const;
    Rays light_at(const Rays& point, const Rays& normal, Mask hit) const;

    const Scene& scene;
    int width, height, across, down; // the picture in pixels and in tiles
    View view;
    Real slope_x, slope_y;       // at the edges of the picture
    std::vector<Real> heights;   // of the eye above the planes
    std::vector<Shadows> shadows; // of every lamp
    Lists eye;
    Lanes column, row; // of the pixels in a packet
};
