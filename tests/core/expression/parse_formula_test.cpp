// SPDX-License-Identifier: MIT
#include "core/expression/parse_formula.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/derivative_check.hpp"

namespace fettle::core::expression::parse_formula_test {

namespace {

// a, b, c: lengths; n: a number; phi: an angle; one whose name is no word; two that are called like a function and a unit; a variable of
// others. Numbers without a unit count in millimetres and degrees.
const Scope& scope() {
    static const Scope all = [] {
        Scope out;
        out.what = "parameter";
        const DimensionPowers length = powers_of(Dimension::length);
        out.names = {{"a", length}, {"b", length}, {"c", length}, {"n", {}}, {"phi", powers_of(Dimension::angle)}, {"crank radius", length},
                     {"min", {}},   {"mm", length}};
        out.plain_unit = [](Dimension dimension) {
            return dimension == Dimension::length ? 1e-3 : dimension == Dimension::angle ? std::acos(-1.0) / 180 : 0;
        };
        out.names.push_back({"bore", length, *parse_formula("a + 2 * b", out)});
        return out;
    }();
    return all;
}

VectorX point() {
    VectorX p(8);
    p << 2.5, 4.25, 0.75, 3.5, 0.6, 1.5, 9, 11;
    return p;
}

Formula parsed(const std::string& text) {
    const Result<Formula> formula = parse_formula(text, scope());
    INFO(text);
    for (const Error& error : formula.errors()) UNSCOPED_INFO(error.message);
    REQUIRE(formula);
    return *formula;
}

// At values of all the names' inputs, in the scope's order.
ValueAndGradient evaluate(const Formula& formula, const VectorX& p) {
    std::vector<std::string> names;
    for (const Scope::Name& name : scope().names)
        if (!name.meaning) names.push_back(name.name);
    const std::vector<int> positions = positions_of(formula, names);
    std::vector<double> inputs;
    for (const int position : positions) inputs.push_back(p[position]);
    const ValueAndGradient at = differentiated(formula, inputs);
    ValueAndGradient out{at.value, VectorX::Zero(p.size())};
    for (size_t k = 0; k < positions.size(); ++k) out.gradient[positions[k]] = at.gradient[k];
    return out;
}

double value(const std::string& text) { return evaluate(parsed(text), point()).value; }

struct Fault {
    const char* text;
    ErrorCode code;
    const char* words;
};

}  // namespace

TEST_CASE("formulas have the value that arithmetic gives them") {
    const double a = 2.5, b = 4.25, c = 0.75, n = 3.5, phi = 0.6;
    CHECK(value("a") == a);
    CHECK(value("a + b * c / a - b") == a + b * c / a - b);
    CHECK(value("a - b - c") == (a - b) - c);
    CHECK(value("a / b / c") == (a / b) / c);
    CHECK(value("a - (b - c)") == a - (b - c));
    CHECK(value("-n^2") == -(n * n));
    CHECK(value("(-n)^2") == Approx(n * n));
    CHECK(value("2^-1") == 0.5);
    CHECK(value("2^3^2") == 512);
    CHECK(value("n^n") == Approx(std::pow(n, n)));
    CHECK(value("--n") == n);
    CHECK(value("+n") == n);
    CHECK(value("min(a, b, c)") == c);
    CHECK(value("max(a, b, c)") == b);
    CHECK(value("abs(c - a)") == a - c);
    CHECK(value("sqrt(a^2 + b^2)") == Approx(std::hypot(a, b)));
    CHECK(value("sin(phi)^2 + cos(phi)^2") == Approx(1).epsilon(1e-15));
    CHECK(value("sin(n)") == std::sin(n));
    CHECK(value("a*sin(phi)") == a * std::sin(phi));
    CHECK(value(" 'crank radius'\t/ a\n") == 1.5 / a);
    CHECK(value("min * 2") == 18);  // the parameter: no parenthesis follows
    CHECK(value("min(min, n)") == n);
    CHECK(value("= a") == a);
    CHECK(value("tan(phi)") == std::tan(phi));
    CHECK(value("asin(0.5)") == std::asin(0.5));
    CHECK(value("acos(a / b)") == std::acos(a / b));
    CHECK(value("atan2(a, b)") == std::atan2(a, b));
    CHECK(value("hypot(a, b, c)") == Approx(std::sqrt(a * a + b * b + c * c)));
    CHECK(value("exp(log(n))") == Approx(n));
    CHECK(value("floor(7 / 2)") == 3);
    CHECK(value("2 * pi") == 2 * std::acos(-1.0));
    CHECK(value("if(a < b, n, 2)") == n);
    CHECK(value("if(a > b, n, 2)") == 2);
    CHECK(value("if(a <= a, n, 2)") == n);
    CHECK(value("if(a >= a, n, 2)") == n);
    CHECK(value("if(a < a, n, 2)") == 2);
    CHECK(value("if(a > a, n, 2)") == 2);
    CHECK(value("bore") == a + 2 * b);
}

TEST_CASE("numbers carry units: as much of one as is there") {
    CHECK(value("a + 2mm") == 2.5 + 0.002);
    CHECK(value("a + 2 mm") == 2.5 + 0.002);
    CHECK(value("a * b - 3 mm^2") == Approx(2.5 * 4.25 - 3e-6).epsilon(1e-15));
    CHECK(value("(3 mm)^2 / 1 mm^2") == Approx(9));
    CHECK(value("phi + 90 deg") == Approx(0.6 + std::acos(0.0)));
    CHECK(value("a / (1e-3 m)") == Approx(2500));
    CHECK(value("mm + 1 mm") == 11.001);  // a parameter that is called like a unit
    CHECK(same(parsed("a * b * 1 g/cm^3 * c").dimension, powers_of(Dimension::mass)));
    CHECK(same(parsed("sqrt(a * b)").dimension, powers_of(Dimension::length)));
    CHECK(same(parsed("(a * b * c)^(1/3)").dimension, powers_of(Dimension::length)));
    CHECK(parsed("a / b").dimension.is_number());
    CHECK(value("2 * 15 mm") == 0.03);
}

TEST_CASE("a number without a unit counts in the file's unit of the quantity beside it") {
    CHECK(value("a + 2") == 2.5 + 0.002);
    CHECK(value("2 * (1 + 0.5) - a") == 0.003 - 2.5);
    CHECK(value("phi + 90") == Approx(0.6 + std::acos(0.0)));
    CHECK(value("max(a, 3000)") == 3);
    CHECK(value("if(a < 3000, n, 1)") == 3.5);
    CHECK(value("if(a < b, a, 0)") == 2.5);
    const auto length = [](const char* text) { return parse_formula_of(text, scope(), Dimension::length, 1e-3); };
    CHECK(value_of<double>(*length("3 * 4"), {}) == 0.012);
    CHECK(value_of<double>(*length("3 * 4 m"), {}) == 12);
    CHECK(length("3 * 4")->dimension.is_number() == false);
    CHECK(length("n").errors()[0].message.find("a number, a length is expected; multiply it by a unit, such as `1 m`") !=
          std::string::npos);
    CHECK(length("a * b").errors()[0].message.find("an area, a length is expected") != std::string::npos);
    CHECK(parse_formula_of("a * b", scope(), Dimension::area, 1e-6));
}

TEST_CASE("variables that use one another stay as short as what they compute") {
    Scope chain = scope();
    std::string last = "a";
    for (int k = 0; k < 60; ++k) {
        const std::string name = "v" + std::to_string(k);
        chain.names.push_back(
            {name, powers_of(Dimension::length), *parse_formula(last + " + " + (k > 1 ? "v" + std::to_string(k - 2) : "b"), chain)});
        last = name;
    }
    const Formula formula = *parse_formula(last, chain);
    CHECK(formula.nodes.size() < 100);
    CHECK(formula.inputs == std::vector<std::string>{"a", "b"});
}

TEST_CASE("variables that follow from one another without end are refused, not written out") {
    for (const int count : {1000, 8000}) {
        const auto name_of = [](int k) { return "v" + std::to_string(10000 + k); };  // each after the one that it names
        std::map<std::string, std::string> texts{{name_of(0), "a"}};
        for (int k = 1; k < count; ++k) texts[name_of(k)] = name_of(k - 1) + " + " + std::to_string(k) + " mm";
        Scope chain = scope();
        std::size_t length = 0;
        const auto errors = define_variables(texts, chain, [&](const std::string& name, Formula formula) {
            length += formula.nodes.size();
            return Scope::Name{name, formula.dimension, std::move(formula)};
        });
        CHECK(errors.size() == (count > 1000 ? 1 : 0));
        if (!errors.empty()) CHECK(errors.front().message.find("more than 1000000 operations long") != std::string::npos);
        CHECK(length < 1'100'000);
        CHECK(same(chain.find(name_of(count - 1))->dimension, powers_of(Dimension::length)));
    }
}

TEST_CASE("inputs are replaced by formulas, and stay where they are not") {
    const Formula formula = parsed("a * n + b");
    const Formula replaced = substituted(formula, {{"a", parsed("b + c")}, {"n", constant_formula(2)}});
    CHECK(replaced.inputs == std::vector<std::string>{"b", "c"});
    CHECK(evaluate(replaced, point()).value == (4.25 + 0.75) * 2 + 4.25);
    CHECK(evaluate(replaced, point()).gradient[1] == 3);
    const Formula one = substituted(parsed("a"), {{"a", parsed("b")}});
    CHECK(one.inputs == std::vector<std::string>{"b"});
    CHECK(evaluate(one, point()).value == 4.25);
    // A replacement that names what it replaces is not replaced again.
    CHECK(evaluate(substituted(parsed("a"), {{"a", parsed("2 * a")}}), point()).value == 5);
}

TEST_CASE("how near a kink is") {
    const auto nearest = [](const char* text, std::vector<double> inputs) { return nearest_kink(parsed(text), inputs); };
    CHECK(nearest("min(a, b)", {1, 1.01}) == Approx(0.01 / 1.01));
    CHECK(std::isinf(nearest("a * b", {1, 1.01})));
    CHECK(nearest("if(a < b, a, b)", {2, 2}) == 0);
}

TEST_CASE("gradients of formulas are those of differences") {
    for (const char* text : {"a / b",
                             "a + b - 2 * c",
                             "2 * (min(a, b, c) + max(a, b, c)) - (a + b + c)",
                             "sqrt(a^2 + b * c)",
                             "n^n",
                             "2^n",
                             "n^2.5",
                             "(a / b)^n",
                             "abs(c - a) / b",
                             "a * sin(phi) - b * cos(phi / 2)",
                             "sin(n) / n^-2",
                             "(a - b)^3",
                             "tan(phi) * a",
                             "asin(a / b) * c / 1 rad",
                             "acos(a / b) * b / 1 rad",
                             "atan(n)",
                             "atan2(a, b)",
                             "hypot(a, b, c)",
                             "exp(n / 3)",
                             "log(n * a / b)",
                             "if(a < b, a * n, b)",
                             "if(a >= b, a * n, b * b / c)",
                             "bore^2 / a",
                             "'crank radius' * (a - b) / (c + 1 mm)"}) {
        const Formula expression = parsed(text);
        const auto at = evaluate(expression, point());
        REQUIRE(at.gradient.size() == 8);
        const auto check = tests::support::check_gradient([&](const VectorX& p) { return evaluate(expression, p).value; }, point(),
                                                          at.gradient, {1e-2, 0.25, 10});
        INFO(text << ", parameter " << check.column << ": " << check.analytic << " against " << check.difference);
        CHECK(check.relative_error < 1e-9);
        CHECK(at.gradient.norm() > 0);
    }
}

TEST_CASE("a wrong gradient would be seen") {
    const Formula expression = parsed("a / b");
    VectorX wrong = evaluate(expression, point()).gradient;
    wrong[1] *= 1.001;
    const auto check =
        tests::support::check_gradient([&](const VectorX& p) { return evaluate(expression, p).value; }, point(), wrong, {1e-2, 0.25, 10});
    CHECK(check.relative_error > 1e-4);
}

TEST_CASE("where formulas have a kink the side that is taken is differentiated, at a tie the first") {
    VectorX p = point();
    p[1] = p[0];
    CHECK(evaluate(parsed("min(a, b)"), p).gradient == VectorX::Unit(8, 0));
    CHECK(evaluate(parsed("max(b, a)"), p).gradient == VectorX::Unit(8, 1));
    CHECK(evaluate(parsed("abs(a - b)"), p).gradient == VectorX(VectorX::Unit(8, 0) - VectorX::Unit(8, 1)));
}

TEST_CASE("constant powers need no logarithm; what is not defined is not finite") {
    VectorX p = point();
    p[3] = -2;
    CHECK(evaluate(parsed("n^3"), p).value == -8);
    CHECK(evaluate(parsed("n^3"), p).gradient[3] == 12);
    p[3] = 0;
    CHECK(evaluate(parsed("n^1"), p).gradient[3] == 1);
    CHECK(evaluate(parsed("n^0"), p).gradient[3] == 0);
    CHECK_FALSE(std::isfinite(evaluate(parsed("a / n"), p).value));
    CHECK_FALSE(evaluate(parsed("sqrt(n)"), p).gradient.allFinite());
    CHECK(std::isnan(evaluate(parsed("sqrt(n - 1)"), p).value));
}

TEST_CASE("floor is of what no input changes, also through variables of variables") {
    Scope scope;
    const DimensionPowers number = powers_of(base::Dimension::number);
    const base::Errors faults = define_variables({{"sun", "18"}, {"ring", "= sun + 2 * 17.5"}, {"third", "= floor((sun + ring) / 3)"}},
                                                 scope, [&](const std::string& name, Formula formula) {
                                                     return Scope::Name{name, number, std::move(formula)};
                                                 });
    CHECK(faults.empty());
    const base::Result<Formula> formula = parse_formula("third + floor(ring / 2)", scope);
    REQUIRE(formula);
    CHECK(formula->is_constant());
    CHECK(value_of<double>(*formula, {}) == 23 + 26);
}

TEST_CASE("every fault of a formula is reported with its place") {
    const Fault faults[] = {
        {"", ErrorCode::parse, "the formula ends"},
        {"a +", ErrorCode::parse, "character 4: a number, a parameter or `(` is expected, but the formula ends"},
        {"(a", ErrorCode::parse, "`)` is expected, but the formula ends"},
        {"a b", ErrorCode::parse, "character 3: an operator is expected before `b`"},
        {"a / b <= 0.35", ErrorCode::parse, "in `lower` and `upper`"},
        {"if(a, b, c)", ErrorCode::parse, "takes a comparison"},
        {"floor(n)", ErrorCode::wrong_type, "`floor` jumps"},
        {"asin(a)", ErrorCode::wrong_type, "of a number, not of a length"},
        {"atan2(a)", ErrorCode::parse, "takes two values"},
        {"if(a < n, a, b)", ErrorCode::wrong_type, "cannot be compared"},
        {"a * b + 3 * 2", ErrorCode::wrong_type, "give the number a unit"},
        {"2 a", ErrorCode::parse, "if a product is meant, write `*`"},
        {"2 mmm", ErrorCode::parse, "no such unit"},
        {"2 s^2", ErrorCode::parse, "write parentheses"},
        {"a # b", ErrorCode::parse, "before `# b`"},
        {"1e99 * a", ErrorCode::parse, "this number cannot be used"},
        {"'crank radius / a", ErrorCode::parse, "closing quote"},
        {"min(a)", ErrorCode::parse, "two values or more"},
        {"sqrt(a, b)", ErrorCode::parse, "`)` is expected before `, b)`"},
        {"a / 'crank raduis'", ErrorCode::out_of_range, "character 5: there is no parameter `crank raduis`; did you mean `crank radius`?"},
        {"sqr(a)", ErrorCode::out_of_range, "there is no function `sqr`; did you mean `sqrt`?"},
        {"a + n", ErrorCode::wrong_type, "character 3: a length and a number cannot be added; give the number a unit"},
        {"a - a * b", ErrorCode::wrong_type, "a length and an area cannot be subtracted"},
        {"a - 2 deg", ErrorCode::wrong_type, "a length and an angle cannot be subtracted"},
        {"max(a, n)", ErrorCode::wrong_type, "cannot be compared"},
        {"sin(a)", ErrorCode::wrong_type, "of an angle, or of a number, not of a length"},
        {"2^a", ErrorCode::wrong_type, "an exponent is a number, not a length"},
        {"a^n", ErrorCode::wrong_type, "a constant power only"},
    };
    for (const Fault& fault : faults) {
        const Result<Formula> expression = parse_formula(fault.text, scope(), "a.design.json#/constraints/0/expression");
        INFO(fault.text);
        REQUIRE_FALSE(expression);
        for (const Error& error : expression.errors()) UNSCOPED_INFO(error.message);
        CHECK(expression.errors().size() == 1);
        CHECK(expression.errors()[0].code == fault.code);
        CHECK(expression.errors()[0].where == "a.design.json#/constraints/0/expression");
        CHECK(expression.errors()[0].message.find(fault.words) != std::string::npos);
    }
    CHECK(parse_formula("aa + bb * (a + n)", scope()).errors().size() == 3);  // all at once
}

TEST_CASE("a formula that nests without end is refused, not followed") {
    CHECK_FALSE(parse_formula(std::string(100000, '('), scope()));
    std::string signs(100000, '-');
    signs.push_back('a');
    CHECK_FALSE(parse_formula(signs, scope()));
    std::string tower = "n";
    for (int k = 0; k < 10000; ++k) tower += "^n";
    CHECK_FALSE(parse_formula(tower, scope()));
    std::string sum = "n";
    for (int k = 0; k < 10000; ++k) sum += "+n";
    CHECK(evaluate(parsed(sum), point()).gradient[3] == 10001);
}

}  // namespace fettle::core::expression::parse_formula_test
