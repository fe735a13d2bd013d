#include "picture.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace judge {

namespace {

using Color = std::array<double, 3>;

// Width and height of a picture in pixels. Each pixel has SAMPLES times SAMPLES samples.
constexpr int SIZE = 200, SAMPLES = 2, SIDE = SIZE * SAMPLES;
constexpr Color PAPER{255, 255, 255}, OLD{196, 200, 206}, NEW{240, 150, 50}, INSIDE{110, 120, 140};
// Angle between the view and the normal, in radians: depth is easier to see from the side.
constexpr double TILT = 0.6;

struct Frame {
    Point right, up, toward;
};

Point unit(const Point& p) { return (1.0 / norm(p)) * p; }

Frame frame_of(const View& view) {
    const Point axis = std::abs(view.normal[2]) < 0.9 * norm(view.normal) ? Point{0, 0, 1} : Point{0, 1, 0};
    const Point n = unit(view.normal), right = unit(cross(axis, n)), up = cross(n, right);
    const Point toward = std::cos(TILT) * n + std::sin(TILT) * unit(0.6 * right + (-0.8) * up);
    const Point side = unit(cross(up, toward));
    return {side, cross(toward, side), toward};
}

std::vector<Color> draw(const View& view, const Frame& frame, const Scene& scene) {
    std::vector<Color> image(SIDE * SIDE, PAPER);
    if (!scene.mesh) return image;
    std::vector<double> depth(SIDE * SIDE, -std::numeric_limits<double>::infinity());
    const double scale = 0.5 * SIDE / view.radius;
    for (std::size_t f = 0; f < scene.mesh->triangles.size(); ++f) {
        const Triangle& t = scene.mesh->triangles[f];
        std::array<Point, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point d = scene.mesh->points[t[k]] - view.center;
            p[k] = {0.5 * SIDE + scale * dot(d, frame.right), 0.5 * SIDE - scale * dot(d, frame.up),
                    scale * dot(d, frame.toward)};
        }
        const double twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
        if (twice == 0.0) continue;
        const Point n = area_vector(p[0], p[1], p[2]);
        const double light = 0.35 + 0.65 * std::abs(dot(unit(n), unit({-0.4, -0.5, 1.0})));
        // The second axis of the picture points down, which reverses the orientation of triangles.
        Color color = twice > 0.0 ? INSIDE : f >= scene.first_new ? NEW : OLD;
        for (double& c : color) c *= light;
        const auto range = [&](std::size_t axis) {
            const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
            return std::pair<int, int>(std::max(0, static_cast<int>(std::clamp(std::ceil(low - 0.5), -1.0, 1e6))),
                                       std::min(SIDE - 1, static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, 1e6))));
        };
        const auto [x0, x1] = range(0);
        const auto [y0, y1] = range(1);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double px = x + 0.5, py = y + 0.5;
                const auto share = [&](std::size_t a, std::size_t b) {
                    return ((p[a][0] - px) * (p[b][1] - py) - (p[b][0] - px) * (p[a][1] - py)) / twice;
                };
                const double u = share(1, 2), v = share(2, 0), w = share(0, 1);
                if (u < 0.0 || v < 0.0 || w < 0.0) continue;
                const double z = u * p[0][2] + v * p[1][2] + w * p[2][2];
                const std::size_t at = static_cast<std::size_t>(y * SIDE + x);
                if (z <= depth[at]) continue;
                depth[at] = z;
                image[at] = color;
            }
    }
    return image;
}

void append_number(std::vector<unsigned char>& out, std::size_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<unsigned char>(value >> shift & 255));
}

void append_chunk(std::vector<unsigned char>& out, const std::string& kind, const std::vector<unsigned char>& data) {
    append_number(out, data.size());
    const std::size_t start = out.size();
    out.insert(out.end(), kind.begin(), kind.end());
    out.insert(out.end(), data.begin(), data.end());
    append_number(out, crc32(0, out.data() + start, static_cast<uInt>(out.size() - start)));
}

}  // namespace

View view_of(const Fill& fill) {
    View view;
    const Hole* largest = nullptr;
    for (const Hole& hole : fill.holes)
        if (!hole.kept && (!largest || hole.diameter > largest->diameter)) largest = &hole;
    if (!largest) return view;
    const double share = 1.0 / static_cast<double>(largest->rim.size());
    for (const std::uint32_t v : largest->rim) view.center = view.center + share * fill.output.points[v];
    // The loop has the direction of its triangles: clockwise round the hole, seen from outside.
    for (std::size_t i = 0; i < largest->rim.size(); ++i)
        view.normal = view.normal + area_vector(view.center, fill.output.points[largest->rim[(i + 1) % largest->rim.size()]],
                                                fill.output.points[largest->rim[i]]);
    if (!(norm(view.normal) > 0.0)) view.normal = {0, 0, 1};
    view.radius = 0.75 * largest->diameter;
    return view;
}

void write_row(const std::string& path, const View& view, const std::vector<Scene>& scenes) {
    const Frame frame = frame_of(view);
    const std::size_t width = scenes.size() * SIZE;
    std::vector<unsigned char> pixels(SIZE * (1 + 3 * width), 0);
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        const std::vector<Color> image = draw(view, frame, scenes[s]);
        for (int y = 0; y < SIZE; ++y)
            for (int x = 0; x < SIZE; ++x)
                for (std::size_t k = 0; k < 3; ++k) {
                    double sum = 0.0;
                    for (int j = 0; j < SAMPLES; ++j)
                        for (int i = 0; i < SAMPLES; ++i)
                            sum += image[static_cast<std::size_t>((y * SAMPLES + j) * SIDE + x * SAMPLES + i)][k];
                    pixels[static_cast<std::size_t>(y) * (1 + 3 * width) + 1 + 3 * (s * SIZE + static_cast<std::size_t>(x)) + k] =
                        static_cast<unsigned char>(std::clamp(sum / (SAMPLES * SAMPLES), 0.0, 255.0));
                }
    }
    std::vector<unsigned char> packed(compressBound(pixels.size()));
    uLongf packed_size = packed.size();
    if (compress(packed.data(), &packed_size, pixels.data(), pixels.size()) != Z_OK)
        throw std::runtime_error("cannot compress " + path);
    packed.resize(packed_size);
    std::vector<unsigned char> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
    append_number(header, width);
    append_number(header, SIZE);
    header.insert(header.end(), {8, 2, 0, 0, 0});
    append_chunk(file, "IHDR", header);
    append_chunk(file, "IDAT", packed);
    append_chunk(file, "IEND", {});
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
    out.close();
    if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace judge
