// SPDX-License-Identifier: MIT
#include "design/coupons/stroke_font.hpp"

#include "core/base/contract.hpp"
#include "core/parts/profile_booleans.hpp"

namespace fettle::design::coupons {

namespace {

using core::parts::Profile;

/// Bars of a letter:  a top, g middle, d bottom; f, b upper left and right, e, c lower left and right; m the lower middle; p the point.
std::string bars_of_letter(char letter) {
    switch (letter) {
        case '0':
            return "abcdef";
        case '1':
            return "bc";
        case '2':
            return "abged";
        case '3':
            return "abgcd";
        case '4':
            return "fgbc";
        case '5':
            return "afgcd";
        case '6':
            return "afgedc";
        case '7':
            return "abc";
        case '8':
            return "abcdefg";
        case '9':
            return "abcdfg";
        case 'H':
            return "fegbc";
        case 'P':
            return "abgfe";
        case 'S':
            return "afgcd";
        case 'W':
            return "fedcbm";
        case 'G':
            return "afedc";
        case '.':
            return "p";
        default:
            return "";
    }
}

// Upper and lower bars reach over the middle one.
Bar bar_of(char name, const StrokeFont& font) {
    const double s = font.stroke, w = font.width, h = font.height, middle = (h - s) / 2, half = (h + s) / 2;
    switch (name) {
        case 'a':
            return {0, h - s, w, s};
        case 'g':
            return {0, middle, w, s};
        case 'd':
            return {0, 0, w, s};
        case 'f':
            return {0, middle, s, half};
        case 'b':
            return {w - s, middle, s, half};
        case 'e':
            return {0, 0, s, half};
        case 'c':
            return {w - s, 0, s, half};
        case 'm':
            return {(w - s) / 2, 0, s, half};
        default:
            return {0, 0, s, s};
    }
}

double width_of_letter(char letter, const StrokeFont& font) { return letter == '.' ? font.stroke : font.width; }

}  // namespace

std::vector<Bar> bars_of(const std::string& text, const StrokeFont& font) {
    std::vector<Bar> bars;
    double x = 0;
    for (const char letter : text) {
        const std::string names = bars_of_letter(letter);
        FETTLE_ASSERT(!names.empty(), "a letter that there is");
        for (const char name : names) {
            Bar bar = bar_of(name, font);
            bar.x += x;
            bars.push_back(bar);
        }
        x += width_of_letter(letter, font) + font.space;
    }
    return bars;
}

double width_of(const std::string& text, const StrokeFont& font) {
    double width = text.empty() ? 0 : -font.space;
    for (const char letter : text) width += width_of_letter(letter, font) + font.space;
    return width;
}

Result<Profile> label_profile(const std::string& text, const StrokeFont& font, double x, double y) {
    std::vector<Profile> parts;
    for (const Bar& bar : bars_of(text, font)) {
        const auto part = core::parts::filled(core::parts::rectangle({x + bar.x, y + bar.y}, bar.width, bar.height, "label"));
        if (!part) return part.errors();
        parts.push_back(*part);
    }
    return core::parts::united(parts);
}

}  // namespace fettle::design::coupons
