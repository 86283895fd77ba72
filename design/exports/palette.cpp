// SPDX-License-Identifier: MIT
#include "design/exports/palette.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace fettle::design::exports {

namespace {

// Number `index` of a list that begins anew, each time paler.
template <std::size_t count>
Colour of_list(const std::array<Colour, count>& list, int index) {
    Colour colour = list[static_cast<std::size_t>(index) % count];
    for (int round = index / static_cast<int>(count); round % 4 > 0; --round)
        for (unsigned char& c : colour) c = static_cast<unsigned char>(c + (255 - c) / 3);
    return colour;
}

Colour fixed_colour(int index) {
    constexpr std::array<Colour, 6> stones{
        {{203, 198, 186}, {180, 192, 205}, {208, 182, 168}, {184, 196, 164}, {198, 183, 204}, {218, 205, 159}}};
    return of_list(stones, index);
}

}  // namespace

Colour part_colour(int index) {
    constexpr std::array<Colour, 8> colours{{{74, 134, 184},
                                             {224, 160, 64},
                                             {70, 160, 127},
                                             {201, 138, 178},
                                             {140, 196, 228},
                                             {168, 102, 60},
                                             {226, 213, 102},
                                             {107, 108, 117}}};
    return of_list(colours, index);
}

std::vector<Colour> part_colours(const core::model::Model& model) {
    const auto is_fixed = [](const core::model::Body& body) { return body.type == core::scene::BodyType::static_body; };
    const bool nothing_moves = std::all_of(model.bodies.begin(), model.bodies.end(), is_fixed);
    std::vector<Colour> colours;
    int fixed = 0, moving = 0;
    for (const core::model::Body& body : model.bodies)
        if (body.mesh.colour) {
            colours.push_back(*body.mesh.colour);
        } else {
            colours.push_back(is_fixed(body) && !nothing_moves ? fixed_colour(fixed++) : part_colour(moving++));
        }
    return colours;
}

std::string css_colour(const Colour& colour) {
    char text[40];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", colour[0], colour[1], colour[2]);
    return text;
}

}  // namespace fettle::design::exports
