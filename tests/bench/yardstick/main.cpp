// The yardstick: a miniRT written by hand with SIMD intrinsics, to show how fast one can be. It renders planes, spheres,
// cylinders and point lights in float32, or with -DDOUBLE in float64, by the same method as the program, and nothing else.
//
//     yardstick scene.rt [--size WxH] [--threads N] [--seconds S] [--ppm picture.ppm]
//
// Prints a JSON object with the times of frames in milliseconds.
#include "render.h"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <omp.h>
#include <stdexcept>

namespace {

constexpr size_t LEAST_FRAMES = 9;

struct Options {
    const char *scene = nullptr, *ppm = nullptr;
    int width = 1280, height = 720, threads = omp_get_max_threads();
    double seconds = 1;
};

Options options(int count, char** words) {
    Options chosen;
    for (int i = 1; i < count; i++) {
        auto is = [&](const char* name) { return strcmp(words[i], name) == 0 && i + 1 < count; };
        if (is("--size")) sscanf(words[++i], "%dx%d", &chosen.width, &chosen.height);
        else if (is("--threads")) chosen.threads = atoi(words[++i]);
        else if (is("--seconds")) chosen.seconds = atof(words[++i]);
        else if (is("--ppm")) chosen.ppm = words[++i];
        else chosen.scene = words[i];
    }
    if (!chosen.scene || chosen.threads < 1) throw std::runtime_error("usage: see the head of main.cpp");
    if (chosen.width < 16 || chosen.width % 16 || chosen.height < 16 || chosen.height % 16)
        throw std::runtime_error("width and height are multiples of 16");
    return chosen;
}

double now() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_time() { return 1e3 * double(std::clock()) / CLOCKS_PER_SEC; }

void save(const char* path, const Picture& picture) {
    FILE* file = fopen(path, "wb");
    if (!file) throw std::runtime_error(std::string(path) + ": cannot write");
    fprintf(file, "P6\n%d %d\n255\n", picture.width, picture.height);
    for (uint32_t pixel : picture.pixels)
        for (int shift : {16, 8, 0}) fputc(int(pixel >> shift & 255), file);
    fclose(file);
}

void run(const Options& chosen) {
    omp_set_num_threads(chosen.threads);
    Scene scene = read_scene(chosen.scene);
    Picture picture(chosen.width, chosen.height);
    Renderer renderer(scene, chosen.width, chosen.height);
    renderer.render(picture);
    std::vector<double> times;
    double start = now(), processors = processor_time();
    while (times.size() < LEAST_FRAMES || now() - start < chosen.seconds * 1e3) {
        double before = now();
        renderer.render(picture);
        times.push_back(now() - before);
    }
    double busy = (processor_time() - processors) / (now() - start);
    std::sort(times.begin(), times.end());
    printf("{\"lanes\": %d, \"threads\": %d, \"frames\": %zu, \"ms_min\": %.3f, \"ms_median\": %.3f, \"busy\": %.3f}\n",
           Lanes::count, chosen.threads, times.size(), times[0], times[times.size() / 2], busy);
    if (chosen.ppm) save(chosen.ppm, picture);
}

} // namespace

int main(int count, char** words) {
    try {
        run(options(count, words));
    } catch (const std::exception& error) {
        fprintf(stderr, "Error\n%s\n", error.what());
        return 1;
    }
}
