// SPDX-License-Identifier: MIT
/// Reads a URDF file (ROS's unified robot description format) into a Robot: what the table of words (urdf_words.hpp) says is read. All else
/// is passed over, with a warning for each word.
/// By the XML reader that 3MF has and not by ROS's liburdfdom: that reports faults on a console without file and line, and would bring a
/// second XML reader without the limits of the first.
#pragma once

#include <string>
#include <string_view>

#include "design/urdf/robot.hpp"

namespace fettle::design::urdf {

/// @param where  the file, for messages. Errors: parse (XML; numbers that are none, with the line), missing_key (names, a joint's ends),
/// out_of_range (sizes that are not positive, a mass below 0, no axis where the joint has one), not_finite, unsupported (a type of joint
/// that is none).
Result<Robot> parse_urdf(std::string_view text, const std::string& where);

}  // namespace fettle::design::urdf
