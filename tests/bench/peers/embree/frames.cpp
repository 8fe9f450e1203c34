// Frames by Embree's packets of 4 x 4 rays. Every loop over a packet is vector code, a lane for each ray.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace {

constexpr int LANES = 16, ACROSS = 4;
constexpr uint32_t NONE = ~0u;        // geometry of a ray that hits nothing
constexpr float OFF_SURFACE = 1e-3f;  // offset of shadow rays, and least distance of a hit

using Row = float[LANES];
using Words = uint32_t[LANES];

struct alignas(64) Rays {  // RTCRay16
    Row origin[3], near, direction[3], time, far;
    Words mask, id, flags;
};

struct alignas(64) Hits {  // RTCRayHit16
    Rays rays;
    Row normal[3], u, v;
    Words primitive, geometry, instance[2], later[4];  // versions of Embree have different last rows
};

struct Surface {
    alignas(64) Row point[3], normal[3];  // the point lies off the surface, the normal is on the visible side
};

struct Light {
    float position[3], radiance[3];
};

using Trace = void (*)(const int *valid, void *scene, void *rays, void *arguments);

struct Embree {  // Embree's functions and their arguments
    Trace intersect, occluded;
    void *scene, *arguments;
};

struct View {
    float eye[3], right[3], up[3], forward[3];
};

struct Scene {
    View view;
    float ambient[3];
    int light_count;
    const Light *lights;
    const uint32_t *colours;  // 0xBBGGRR of each sphere, then of each further geometry
    uint32_t sphere_count;
};

// Set what stays the same for all packets of a thread.
void prepare(const Scene &scene, Hits &hits, Rays &shadows) {
    hits = {};
    shadows = {};
    for (int i = 0; i < LANES; i++) {
        hits.rays.mask[i] = shadows.mask[i] = NONE;
        hits.rays.near[i] = OFF_SURFACE;
        for (int k = 0; k < 3; k++) hits.rays.origin[k][i] = scene.view.eye[k];
    }
}

void aim(const View &view, Hits &hits, int x, int y, int width, int height) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        const float right = 2 * (x + i % ACROSS + 0.5f) / width - 1;
        const float up = 1 - 2 * (y + i / ACROSS + 0.5f) / height;
        for (int k = 0; k < 3; k++)
            hits.rays.direction[k][i] = view.forward[k] + right * view.right[k] + up * view.up[k];
        hits.rays.far[i] = std::numeric_limits<float>::infinity();
        hits.geometry[i] = hits.instance[0][i] = NONE;
    }
}

void find_surfaces(const Hits &hits, Surface &surface) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        const float x = hits.normal[0][i], y = hits.normal[1][i], z = hits.normal[2][i];
        const auto &direction = hits.rays.direction;
        const float facing = x * direction[0][i] + y * direction[1][i] + z * direction[2][i];
        const float length = std::sqrt(x * x + y * y + z * z);
        const float scale = (facing > 0 ? -1.0f : 1.0f) / length;
        const bool hit = hits.geometry[i] != NONE;
        for (int k = 0; k < 3; k++) {
            const float normal = scale * hits.normal[k][i];
            const float point = hits.rays.origin[k][i] + hits.rays.far[i] * direction[k][i];
            surface.normal[k][i] = hit ? normal : 0;
            surface.point[k][i] = hit ? point + OFF_SURFACE * normal : 0;
        }
    }
}

// Aim shadow rays at a light; return whether any surface faces it.
bool aim_at(const Light &light, const Surface &surface, Rays &shadows, Row &cosine, int *valid) {
    int some = 0;
#pragma omp simd reduction(| : some)
    for (int i = 0; i < LANES; i++) {
        float way[3];
        for (int k = 0; k < 3; k++) {
            way[k] = light.position[k] - surface.point[k][i];
            shadows.origin[k][i] = surface.point[k][i];
            shadows.direction[k][i] = way[k];
        }
        const float along =
            surface.normal[0][i] * way[0] + surface.normal[1][i] * way[1] + surface.normal[2][i] * way[2];
        cosine[i] = along / std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        shadows.far[i] = 1;
        valid[i] = cosine[i] > 0 ? -1 : 0;
        some |= valid[i];
    }
    return some;
}

void add(const Light &light, const Rays &shadows, const Row &cosine, const int *valid, Row *received) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        const float seen = valid[i] && shadows.far[i] >= 0 ? cosine[i] : 0;  // Embree sets -inf where something is hit
        for (int k = 0; k < 3; k++) received[k][i] += seen * light.radiance[k];
    }
}

void store(const Scene &scene, const Hits &hits, const Row *received, uint32_t *pixels, int width) {
    alignas(64) Words packed;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        const uint32_t geometry = hits.geometry[i];
        const bool hit = geometry != NONE;
        const uint32_t row = geometry == 0 ? hits.primitive[i] : scene.sphere_count - 1 + geometry;
        const uint32_t colour = scene.colours[hit ? row : 0];
        uint32_t pixel = 0xFF000000;
        for (int k = 0; k < 3; k++) {
            const float level = std::min((colour >> 8 * k & 255) * received[k][i], 255.0f);
            pixel |= uint32_t(int(level + 0.5f)) << 8 * k;
        }
        packed[i] = hit ? pixel : 0xFF000000;
    }
    for (int i = 0; i < LANES; i++) pixels[ptrdiff_t(i / ACROSS) * width + i % ACROSS] = packed[i];
}

}  // namespace

// Render a frame of RGBA pixels; width and height are multiples of 4.
extern "C" void render(const Embree *embree, const Scene *scene, uint32_t *pixels, int width, int height, int threads) {
#pragma omp parallel num_threads(threads)
    {
        Hits hits;
        Rays shadows;
        Surface surface;
        alignas(64) int valid[LANES], all[LANES];
        alignas(64) Row cosine, received[3];
        std::fill_n(all, LANES, -1);
        prepare(*scene, hits, shadows);
#pragma omp for schedule(dynamic)
        for (int y = 0; y < height; y += LANES / ACROSS)
            for (int x = 0; x < width; x += ACROSS) {
                aim(scene->view, hits, x, y, width, height);
                embree->intersect(all, embree->scene, &hits, embree->arguments);
                find_surfaces(hits, surface);
                for (int k = 0; k < 3; k++) std::fill_n(received[k], LANES, scene->ambient[k]);
                for (int n = 0; n < scene->light_count; n++) {
                    const Light &light = scene->lights[n];
                    if (!aim_at(light, surface, shadows, cosine, valid)) continue;
                    embree->occluded(valid, embree->scene, &shadows, embree->arguments);
                    add(light, shadows, cosine, valid, received);
                }
                store(*scene, hits, received, pixels + ptrdiff_t(y) * width + x, width);
            }
    }
}
