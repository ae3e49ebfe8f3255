// Little frames and questions about pictures that the tests share.
#pragma once

#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "grainray/render.hpp"

namespace grainray::test {

inline void add(Frame& frame, const Vec3d& position, float radius, std::uint32_t material = 0, const Vec3f& velocity = {}) {
    frame.id.push_back(static_cast<std::uint32_t>(frame.size()));
    frame.material.push_back(material);
    frame.coordination.push_back(material);
    frame.position.push_back(position);
    frame.radius.push_back(radius);
    frame.mass.push_back(radius);
    frame.contact_force.push_back(radius);
    frame.velocity.push_back(velocity);
    frame.angular_velocity.push_back(velocity);
}

/// What a refusal says; empty where there was none.
inline std::string message(const std::function<void()>& act) {
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// n x n x n spheres of radius 0.1, the faster the farther to +x.
inline Frame block(int n) {
    Frame frame;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                add(frame, {0.2 * i, 0.2 * j, 0.1 + 0.2 * k}, 0.1f, 0, {static_cast<float>(i), 0, 0});
    return frame;
}

inline Plane plane(const Vec3d& point, const Vec3d& normal) {
    Plane p;
    p.point = point;
    p.normal = normal;
    return p;
}

/// Too small for text; the camera looks along +y at the origin.
inline RenderSettings small(const char* color_by = "material") {
    RenderSettings settings;
    settings.width = 64;
    settings.height = 48;
    settings.color_by = color_by;
    settings.camera.eye = Vec3d{0, -10, 0};
    settings.camera.target = Vec3d{};
    return settings;
}

struct Rgb {
    int r, g, b;
    bool white() const { return r == 255 && g == 255 && b == 255; }
};
inline Rgb pixel(const Image& image, int x, int y) {
    const std::uint8_t* p = &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x))];
    return {p[0], p[1], p[2]};
}
inline Rgb centre(const Image& image) { return pixel(image, image.width / 2, image.height / 2); }

/// Share of the pixels that are not background.
inline double filled(const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) count += !pixel(image, x, y).white();
    return static_cast<double>(count) / (image.width * image.height);
}

/// Mean difference of the channels, 0 to 255.
inline double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
    return sum / static_cast<double>(a.rgb.size());
}

}  // namespace grainray::test
