// SPDX-License-Identifier: MIT
#include "design/exports/depth_buffer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fettle::design::exports {

namespace {

constexpr double hatch_share = 0.24;     // of the cut that its lines cover
constexpr double depth_rounding = 1e-6;  // [pixels]

}  // namespace

DepthBuffer::DepthBuffer(int width, int height, const Colour& background, std::optional<Cut> cut) : cut_(cut) {
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    image_.width = width;
    image_.height = height;
    image_.pixels.assign(count, background);
    depth_.assign(count, -std::numeric_limits<double>::infinity());
    if (!cut_) return;
    turns_.assign(count, 0);
    solid_.assign(count, 0);
}

bool DepthBuffer::is_in_cut(int x, int y) const {
    return cut_ && (Vector2(x + 0.5, y + 0.5) - cut_->centre).squaredNorm() <= cut_->radius * cut_->radius;
}

bool DepthBuffer::is_in_material(int x, int y) const {
    return cut_ && x >= 0 && y >= 0 && x < image_.width && y < image_.height && solid_[index(x, y)] != 0;
}

void DepthBuffer::add_triangle(const std::array<Vector3, 3>& corners, const std::array<double, 3>& light, const Colour& colour) {
    const Vector3 &a = corners[0], &b = corners[1], &c = corners[2];
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (!(std::abs(area) > 1e-12)) return;
    const auto first = [](double x) { return std::max(0, static_cast<int>(std::ceil(std::max(x, 0.0) - 0.5))); };
    const auto last = [](double x, int count) { return std::min(count - 1, static_cast<int>(std::floor(std::min(x, count + 1.0) - 0.5))); };
    const int x_end = last(std::max({a.x(), b.x(), c.x()}), image_.width), y_end = last(std::max({a.y(), b.y(), c.y()}), image_.height);
    for (int y = first(std::min({a.y(), b.y(), c.y()})); y <= y_end; ++y) {
        for (int x = first(std::min({a.x(), b.x(), c.x()})); x <= x_end; ++x) {
            const double px = x + 0.5, py = y + 0.5;
            const double wb = ((px - a.x()) * (c.y() - a.y()) - (py - a.y()) * (c.x() - a.x())) / area;
            const double wc = ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / area;
            if (!(wb >= 0 && wc >= 0 && wb + wc <= 1)) continue;
            const double z = a.z() + wb * (b.z() - a.z()) + wc * (c.z() - a.z());
            const std::size_t at = index(x, y);
            if (is_in_cut(x, y)) {
                if (z > cut_->depth) continue;
                turns_[at] = static_cast<short>(turns_[at] + (area > 0 ? 1 : -1));  // y points down: seen from outside, corners turn left
            }
            if (!(z > depth_[at] + depth_rounding)) continue;
            depth_[at] = z;
            image_.pixels[at] = lit(colour, light[0] + wb * (light[1] - light[0]) + wc * (light[2] - light[0]));
        }
    }
}

void DepthBuffer::close_solid(const Colour& colour, const Colour& shared, const Vector2& hatch) {
    ++solids_;
    const std::size_t width = static_cast<std::size_t>(image_.width);
    for (std::size_t at = 0; at < turns_.size(); ++at) {
        if (std::exchange(turns_[at], short{0}) <= 0) continue;
        const double across = hatch.dot(Vector2(static_cast<double>(at % width), static_cast<double>(at / width)));
        const bool is_line = across - std::floor(across) < hatch_share;
        image_.pixels[at] = lit(solid_[at] != 0 ? shared : colour, is_line ? hatch_light : 1);
        depth_[at] = cut_->depth;
        solid_[at] = solids_;
    }
}

void DepthBuffer::outline_cut() {
    if (!cut_) return;
    for (int y = 0; y < image_.height; ++y) {
        for (int x = 0; x < image_.width; ++x) {
            if (!is_in_cut(x, y)) continue;
            for (const auto& [u, v] : {std::array{x + 1, y}, std::array{x, y + 1}}) {
                if (u >= image_.width || v >= image_.height || !is_in_cut(u, v) || solid_[index(u, v)] == solid_[index(x, y)]) continue;
                image_.at(x, y) = image_.at(u, v) = ink;
            }
        }
    }
}

void DepthBuffer::close_open() { std::fill(turns_.begin(), turns_.end(), short{0}); }

// The line may lie on the border of what covers it: the deepest of the pixels round it counts. In a cut nothing is before the material.
bool DepthBuffer::is_visible(const Vector3& point, double tolerance) const {
    const int x = static_cast<int>(std::floor(point.x())), y = static_cast<int>(std::floor(point.y()));
    if (is_in_cut(x, y) && point.z() > cut_->depth + tolerance) return false;
    if (is_in_material(x, y)) return false;
    double deepest = std::numeric_limits<double>::infinity();
    for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
            if (u < 0 || v < 0 || u >= image_.width || v >= image_.height) return true;
            deepest = std::min(deepest, depth_[index(u, v)]);
        }
    }
    return point.z() >= deepest - tolerance;
}

std::vector<std::array<double, 2>> DepthBuffer::visible(const Vector3& from, const Vector3& to, double tolerance) const {
    const double length = (to - from).head<2>().norm();
    if (!(length < 1e6)) return {};
    const int count = std::max(1, static_cast<int>(std::ceil(length)));
    std::vector<std::array<double, 2>> stretches;
    bool open = false;
    for (int i = 0; i < count; ++i) {
        const bool seen = is_visible(from + (i + 0.5) / count * (to - from), tolerance);
        if (seen && !open) stretches.push_back({static_cast<double>(i) / count, 1.0});
        if (!seen && open) stretches.back()[1] = static_cast<double>(i) / count;
        open = seen;
    }
    std::erase_if(stretches, [&](const auto& s) { return (s[1] - s[0]) * length < std::min(3.0, 0.9 * length); });
    return stretches;
}

}  // namespace fettle::design::exports
