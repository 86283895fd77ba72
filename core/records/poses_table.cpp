// SPDX-License-Identifier: MIT
#include "core/records/poses_table.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/files/nearest_word.hpp"

namespace fettle::core::records {
namespace {

using base::ErrorCode;

constexpr double rotation_tolerance = 1e-4;  // what five printed digits leave
constexpr double rounding = 1e-15;           // a rotation as good as doubles make it stays as it is

std::string shown_defect(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return text;
}

double defect(const Matrix3& r) { return (r.transpose() * r - Matrix3::Identity()).cwiseAbs().maxCoeff(); }

std::optional<Matrix3> from_quaternion(const std::vector<double>& q, const std::string& where, PosesTable& table, base::Errors& errors) {
    const Eigen::Quaterniond given(q[0], q[1], q[2], q[3]);
    const double off = std::abs(given.norm() - 1);
    if (!(off <= rotation_tolerance)) {
        errors.push_back(
            {ErrorCode::out_of_range, where,
             "the quaternion qw qx qy qz has length " + shown_defect(given.norm()) + ", 1 is expected (to 1e-4); normalise it"});
        return std::nullopt;
    }
    table.largest_rotation_error = std::max(table.largest_rotation_error, off);
    return given.normalized().toRotationMatrix();
}

std::optional<Matrix3> from_matrix(const std::vector<double>& m, const std::string& where, PosesTable& table, base::Errors& errors) {
    Matrix3 r;
    for (int i = 0; i < 9; ++i) r(i / 3, i % 3) = m[i];
    const double off = defect(r);
    if (!(off <= rotation_tolerance)) {
        errors.push_back({ErrorCode::out_of_range, where,
                          "the matrix is not a rotation: R^T R is off the identity by " + shown_defect(off) +
                              ", at most 1e-4 is allowed; is it scaled, or printed with too few digits?"});
        return std::nullopt;
    }
    if (r.determinant() < 0) {
        errors.push_back({ErrorCode::out_of_range, where,
                          "the matrix is a reflection (its determinant is -1); a rotation in a right-handed frame is expected"});
        return std::nullopt;
    }
    table.largest_rotation_error = std::max(table.largest_rotation_error, off);
    for (int i = 0; i < 4 && defect(r) > rounding; ++i) r = kinematics::orthonormalised(r);  // converges quadratically
    return r;
}

}  // namespace

const std::vector<std::string_view>& rotation_form_names() {
    static const std::vector<std::string_view> names{"quaternion", "rotation_vector", "matrix"};
    return names;
}

int number_count(RotationForm form) {
    switch (form) {
        case RotationForm::quaternion:
            return 4;
        case RotationForm::rotation_vector:
            return 3;
        case RotationForm::matrix:
            break;
    }
    return 9;
}

std::optional<Matrix3> rotation_from_numbers(RotationForm form, const std::vector<double>& numbers, const std::string& where,
                                             PosesTable& table, base::Errors& errors) {
    FETTLE_ASSERT(count_of(numbers) == number_count(form), "as many numbers as the form has");
    switch (form) {
        case RotationForm::quaternion:
            return from_quaternion(numbers, where, table, errors);
        case RotationForm::rotation_vector:
            return kinematics::orthonormalised(kinematics::rotation({numbers[0], numbers[1], numbers[2]}));
        case RotationForm::matrix:
            break;
    }
    return from_matrix(numbers, where, table, errors);
}

std::optional<int> body_by_name(const model::Model& model, const std::string& name, const std::string& where, base::Errors& errors) {
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < model.bodies.size(); ++i) {
        if (model.bodies[i].name == name) return static_cast<int>(i);
        known.push_back(model.bodies[i].name);
    }
    errors.push_back({ErrorCode::out_of_range, where, "the scene has no body \"" + name + "\"; " + files::did_you_mean(name, known)});
    return std::nullopt;
}

}  // namespace fettle::core::records
