// SPDX-License-Identifier: MIT
// Taylor models of random formulas against samples in extended precision; what they lose of smooth ones is of second order.
#include "core/certificate/taylor_model.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "core/expression/parse_formula.hpp"

namespace fettle::core::certificate::taylor_model_test {

namespace {

using expression::Formula;
using expression::Scope;

Formula formula(const std::string& text) {
    Scope scope;
    for (const char* name : {"x", "y", "z"}) scope.names.push_back({name, {}});
    auto read = expression::parse_formula(text, scope);
    for (const base::Error& error : read.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(read);
    return *read;
}

struct Box {
    std::array<double, 3> low, high;
};

// In the order of the formula's inputs.
TaylorModel modelled(const Formula& f, const Box& box) {
    std::vector<TaylorModel> inputs;
    for (const std::string& name : f.inputs) {
        const int k = name[0] - 'x';
        inputs.push_back(TaylorModel::variable(k, box.low[static_cast<std::size_t>(k)], box.high[static_cast<std::size_t>(k)]));
    }
    return expression::value_of<TaylorModel>(f, inputs);
}

// How far beyond its rest a formula's samples leave its model, and how near they come to it.
struct Found {
    double beyond = -1, reached = 0;
};
Found sampled(const Formula& f, const Box& box, const TaylorModel& model, std::mt19937& random, int samples) {
    Found out;
    for (int i = 0; i < samples; ++i) {
        std::array<double, most_variables> t{};
        std::array<double, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double share = i < 8 ? (i >> k & 1) : std::uniform_real_distribution<double>(0, 1)(random);
            at[k] = std::clamp(box.low[k] + share * (box.high[k] - box.low[k]), box.low[k], box.high[k]);
            const TaylorModel variable = TaylorModel::variable(static_cast<int>(k), box.low[k], box.high[k]);
            t[k] = variable.slopes[k] > 0 ? (at[k] - variable.center) / variable.slopes[k] : 0;
        }
        std::vector<long double> inputs;
        for (const std::string& name : f.inputs) inputs.push_back(at[static_cast<std::size_t>(name[0] - 'x')]);
        const long double exact = expression::value_of<long double>(f, inputs);
        const double off = static_cast<double>(std::abs(exact - static_cast<long double>(linear_value(model, t))));
        out.beyond = std::max(out.beyond, off - model.rest);
        out.reached = std::max(out.reached, off);
    }
    return out;
}

const char* const smooth[] = {"x * y + z",
                              "sqrt(x) * sin(y) - cos(z) / x",
                              "hypot(x, y) - z",
                              "atan2(y - 2, x) * z",
                              "atan2(y, x - 4)",
                              "atan2(x, y - 1.2)",
                              "exp(x - y) + log(z)",
                              "x^3 - 2 * y^2 + x^0.5 + y^z",
                              "acos(x / 5) + asin(y / 4) - atan(x)",
                              "tan(z / 3) * y",
                              "(x + y) / (y * z)",
                              "x - x + y"};

}  // namespace

TEST_CASE("A Taylor model encloses its formula", "[taylor model]") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.9, 1.8);
    for (const double half : {0.3, 1e-2, 1e-5, 0.0})
        for (const char* text : smooth) {
            const Formula f = formula(text);
            for (int i = 0; i < 20; ++i) {
                Box box{};
                for (std::size_t k = 0; k < 3; ++k) {
                    const double at = place(random);
                    box.low[k] = at - half;
                    box.high[k] = at + half;
                }
                const TaylorModel model = modelled(f, box);
                INFO(text << " half " << half << " rest " << model.rest);
                REQUIRE(model.is_bounded());
                // The samples' own rounding is that of places and of the linear function in doubles.
                CHECK(sampled(f, box, model, random, 60).beyond <= 1e-14);
            }
        }
}

TEST_CASE("What a Taylor model loses of a smooth formula is of second order", "[taylor model]") {
    for (const char* text : smooth) {
        const Formula f = formula(text);
        const auto rest = [&](double half) {
            return modelled(f, {{1.3 - half, 1.5 - half, 1.1 - half}, {1.3 + half, 1.5 + half, 1.1 + half}}).rest;
        };
        INFO(text);
        CHECK(rest(1e-3) <= 1.1e-2 * rest(1e-2) + 1e-14);
        CHECK(rest(1e-2) < 1e-2);
    }
}

TEST_CASE("Kinks are enclosed, and what is not defined is unknown", "[taylor model]") {
    std::mt19937 random(5);
    const Box box{{-1, -0.5, 0.2}, {0.7, 1.5, 2}};
    for (const char* text :
         {"abs(x) + y", "min(x, y) - z", "max(x, y * z)", "if(x < y, x, z)", "abs(x - x) + z", "hypot(x, y)", "sin(5 * x)"}) {
        const Formula f = formula(text);
        const TaylorModel model = modelled(f, box);
        INFO(text);
        REQUIRE(model.is_bounded());
        CHECK(sampled(f, box, model, random, 2000).beyond <= 1e-14);
    }
    for (const char* text : {"1 / x", "sqrt(x)", "log(x)", "asin(3 * z)", "atan2(y, x)", "x^y", "tan(2 * y)", "x^0.5"}) {
        INFO(text);
        CHECK_FALSE(modelled(formula(text), box).is_bounded());
    }
    CHECK_FALSE((TaylorModel::unknown() * TaylorModel(0)).is_bounded());
}

TEST_CASE("A rotation about an axis", "[taylor model]") {
    const Model3 axis{TaylorModel(0.6), TaylorModel(0), TaylorModel(0.8)};
    const ModelMatrix turned = turned_about(axis, TaylorModel::variable(0, 0.3, 0.5));
    const ModelMatrix square = product(transposed(turned), turned);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            INFO(i << j);
            CHECK(square[i][j].interval().contains(i == j ? 1 : 0));
            CHECK(square[i][j].radius() < 0.05);
        }
    // About its own axis nothing turns.
    const Model3 same = times(turned, axis);
    for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(same[i].center - axis[i].center) < 1e-2);
}

}  // namespace fettle::core::certificate::taylor_model_test
