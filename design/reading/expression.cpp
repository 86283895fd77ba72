// SPDX-License-Identifier: MIT
#include "fettle/design/reading/expression.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "fettle/core/base/contract.hpp"
#include "fettle/core/base/limits.hpp"
#include "fettle/core/files/nearest_word.hpp"
#include "fettle/design/shapes/dual.hpp"

namespace fettle::design::reading {

namespace {

using description::Parameter;
using Number = shapes::Dual<>;
using Powers = std::optional<DimensionPowers>;  // none: of something that is wrong already

constexpr int deepest = 100;  // parentheses and signs within one another

struct Function {
    std::string_view name;
    Operation operation;
    bool takes_several;
};
constexpr std::array functions{Function{"min", Operation::minimum, true}, Function{"max", Operation::maximum, true},
                               Function{"sqrt", Operation::root, false},  Function{"abs", Operation::absolute, false},
                               Function{"sin", Operation::sine, false},   Function{"cos", Operation::cosine, false}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool starts_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 128; }
bool is_of_word(char c) { return starts_word(c) || is_digit(c) || c == '.'; }

std::string in_quotes(std::string_view text) { return "`" + std::string(text) + "`"; }

// a^b. A constant exponent needs no logarithm, so its base may be zero or negative.
Number power(const Number& a, const Number& b) {
    const double value = std::pow(a.value, b.value);
    Number result(value);
    if (a.gradient.size() > 0) result += Number(0, a.gradient * (b.value == 0 ? 0 : b.value * std::pow(a.value, b.value - 1)));
    if (b.gradient.size() > 0) result += Number(0, b.gradient * (value * std::log(a.value)));
    return result;
}

Number combined(Operation operation, const Number& a, const Number& b) {
    switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::subtract:
            return a - b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::power:
            return power(a, b);
        case Operation::minimum:
            return b < a ? b : a;
        case Operation::maximum:
            return b > a ? b : a;
        default:
            FETTLE_ASSERT(false, "an operation on two values");
    }
    return {};
}

Number applied(Operation operation, const Number& a) {
    switch (operation) {
        case Operation::negate:
            return -a;
        case Operation::root:
            return sqrt(a);
        case Operation::absolute:
            return a.value < 0 ? -a : a;
        case Operation::sine:
            return sin(a);
        case Operation::cosine:
            return cos(a);
        default:
            FETTLE_ASSERT(false, "an operation on one value");
    }
    return {};
}

bool takes_one(Operation operation) {
    return operation == Operation::negate || operation == Operation::root || operation == Operation::absolute ||
           operation == Operation::sine || operation == Operation::cosine;
}

Number run(const Instruction* begin, const Instruction* end, const VectorX& p) {
    std::vector<Number> stack;
    for (const Instruction* at = begin; at != end; ++at) {
        if (at->operation == Operation::number) {
            stack.emplace_back(at->number);
        } else if (at->operation == Operation::parameter) {
            stack.push_back(Number::variable(p[at->parameter], at->parameter, static_cast<int>(p.size())));
        } else if (takes_one(at->operation)) {
            stack.back() = applied(at->operation, stack.back());
        } else {
            const Number b = std::move(stack.back());
            stack.pop_back();
            stack.back() = combined(at->operation, stack.back(), b);
        }
    }
    FETTLE_ASSERT(stack.size() == 1, "a formula leaves one value");
    return std::move(stack.back());
}

// Recursive descent, one function per rank of operators, which emits the operands' code before the operator's. What stops the reading
// is thrown as Stop; faults of names and dimensions are collected, and the reading goes on.
class Parser {
public:
    Parser(std::string_view text, const std::vector<Parameter>& parameters, std::string where)
        : text_(text), parameters_(parameters), where_(std::move(where)) {}

    Result<Expression> run() {
        try {
            const Powers dimension = sum();
            if (!at_end()) stop("an operator is expected" + before_rest());
            if (dimension) expression_.dimension = *dimension;
        } catch (const Stop&) {
        }
        if (!errors_.empty()) return std::move(errors_);
        return std::move(expression_);
    }

private:
    struct Stop {};

    void fail(ErrorCode code, size_t at, const std::string& message) {
        errors_.push_back({code, where_, "character " + std::to_string(at + 1) + ": " + message});
    }
    [[noreturn]] void stop(const std::string& message) {
        fail(ErrorCode::parse, at_, message);
        throw Stop{};
    }

    std::string before_rest() {
        if (at_end()) return ", but the formula ends";
        const bool comparison = text_[at_] == '<' || text_[at_] == '>' || text_[at_] == '=';
        return " before " + in_quotes(text_.substr(at_, 20)) +
               (comparison ? "; what a relation is compared with stands in `lower` and `upper`" : "");
    }

    bool at_end() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
        return at_ == text_.size();
    }
    bool take(char c) {
        if (at_end() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    void want(char c) {
        if (!take(c)) stop(in_quotes(std::string(1, c)) + " is expected" + before_rest());
    }
    void emit(Operation operation) { expression_.code.push_back({operation, 0, 0}); }

    Powers sum() {
        Powers left = term();
        for (;;) {
            at_end();
            const size_t at = at_;
            const Operation operation = take('+') ? Operation::add : take('-') ? Operation::subtract : Operation::number;
            if (operation == Operation::number) return left;
            const Powers right = term();
            emit(operation);
            left = one_dimension(left, right, at, operation == Operation::add ? "added" : "subtracted");
        }
    }

    Powers one_dimension(const Powers& a, const Powers& b, size_t at, const std::string& done) {
        if (!a || !b || same(*a, *b)) return a ? a : b;
        const bool number = a->is_number() || b->is_number();
        fail(ErrorCode::wrong_type, at,
             described(*a) + " and " + described(*b) + " cannot be " + done + (number ? "; give the number a unit" : ""));
        return std::nullopt;
    }

    Powers term() {
        Powers left = factor();
        for (;;) {
            const bool times = take('*');
            if (!times && !take('/')) return left;
            const Powers right = factor();
            emit(times ? Operation::multiply : Operation::divide);
            left = left && right ? Powers(product(*left, *right, times ? 1 : -1)) : std::nullopt;
        }
    }

    Powers factor() {
        if (++depth_ > deepest) stop("more than " + std::to_string(deepest) + " parentheses and signs within one another");
        Powers dimension;
        if (take('-')) {
            dimension = factor();
            emit(Operation::negate);
        } else if (take('+')) {
            dimension = factor();
        } else {
            dimension = raised();
        }
        --depth_;
        return dimension;
    }

    Powers raised() {
        const Powers base = primary();
        if (!take('^')) return base;
        at_end();
        const size_t at = at_, begin = expression_.code.size();
        const Powers exponent = factor();
        const std::optional<double> constant = value_since(begin);
        emit(Operation::power);
        if (exponent && !exponent->is_number()) {
            fail(ErrorCode::wrong_type, at, "an exponent is a number, not " + described(*exponent));
            return std::nullopt;
        }
        if (!base || base->is_number()) return base;
        if (constant) return product({}, *base, *constant);
        fail(ErrorCode::wrong_type, at, described(*base) + " can be raised to a constant power only");
        return std::nullopt;
    }

    // What the code from `begin` on gives, if no parameter is in it.
    std::optional<double> value_since(size_t begin) const {
        const std::vector<Instruction>& code = expression_.code;
        for (size_t k = begin; k < code.size(); ++k) {
            if (code[k].operation == Operation::parameter) return std::nullopt;
        }
        return reading::run(code.data() + begin, code.data() + code.size(), {}).value;
    }

    Powers primary() {
        if (at_end()) stop("a number, a parameter or `(` is expected, but the formula ends");
        const char c = text_[at_];
        if (take('(')) {
            const Powers dimension = sum();
            want(')');
            return dimension;
        }
        if (is_digit(c) || c == '.') return number();
        if (c == '\'') return quoted_name();
        if (starts_word(c)) return word();
        stop("a number, a parameter or `(` is expected" + before_rest());
    }

    Powers number() {
        double value = 0;
        const auto [end, code] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (code != std::errc() || !core::base::is_usable_number(value)) stop("this number cannot be used" + before_rest());
        at_ = static_cast<size_t>(end - text_.data());
        const Unit* unit = nullptr;
        if (!at_end() && starts_word(text_[at_])) {
            unit = longest_unit();
            if (unit == nullptr) stop("there is no such unit; if a product is meant, write `*`" + before_rest());
            at_ += unit->name.size();
            if (take('^')) stop("is the unit raised, or the number too? write parentheses");
        }
        const double si = unit == nullptr ? value : to_si(value, *unit);
        if (!core::base::is_usable_number(si)) stop("this number is out of range: at most 1e30 is allowed");
        expression_.code.push_back({Operation::number, si, 0});
        return powers_of(unit == nullptr ? Dimension::number : unit->dimension);
    }

    const Unit* longest_unit() const {
        const Unit* longest = nullptr;
        const std::string_view rest = text_.substr(at_);
        for (const Unit& unit : units()) {
            const size_t length = unit.name.size();
            const bool fits = rest.starts_with(unit.name) && (length == rest.size() || !is_of_word(rest[length]));
            if (fits && (longest == nullptr || length > longest->name.size())) longest = &unit;
        }
        return longest;
    }

    Powers quoted_name() {
        const size_t begin = at_, end = text_.find('\'', at_ + 1);
        if (end == std::string_view::npos) stop("the closing quote is missing of the name that begins here");
        at_ = end + 1;
        return parameter(text_.substr(begin + 1, end - begin - 1), begin);
    }

    Powers word() {
        const size_t begin = at_;
        while (at_ < text_.size() && is_of_word(text_[at_])) ++at_;
        const std::string_view name = text_.substr(begin, at_ - begin);
        return take('(') ? call(name, begin) : parameter(name, begin);
    }

    Powers parameter(std::string_view name, size_t at) {
        std::vector<std::string_view> known;
        for (size_t k = 0; k < parameters_.size(); ++k) {
            known.emplace_back(parameters_[k].name);
            if (parameters_[k].name != name) continue;
            expression_.code.push_back({Operation::parameter, 0, static_cast<int>(k)});
            return powers_of(parameters_[k].unit.dimension);
        }
        fail(ErrorCode::out_of_range, at, "there is no parameter " + in_quotes(name) + "; " + core::files::did_you_mean(name, known, '`'));
        expression_.code.push_back({Operation::number, 1, 0});  // stands in until the faults are told
        return std::nullopt;
    }

    Powers call(std::string_view name, size_t at) {
        const Function* function = nullptr;
        std::vector<std::string_view> known;
        for (const Function& candidate : functions) {
            known.push_back(candidate.name);
            if (candidate.name == name) function = &candidate;
        }
        if (function == nullptr) {
            fail(ErrorCode::out_of_range, at,
                 "there is no function " + in_quotes(name) + "; " + core::files::did_you_mean(name, known, '`'));
            throw Stop{};
        }
        Powers dimension = sum();
        if (function->takes_several) {
            if (at_end() || text_[at_] != ',') stop(in_quotes(name) + " takes two values or more, with `,` between them");
            while (take(',')) {
                const Powers next = sum();
                emit(function->operation);
                dimension = one_dimension(dimension, next, at, "compared");
            }
        } else {
            emit(function->operation);
            dimension = of_function(*function, dimension, at);
        }
        want(')');
        return dimension;
    }

    Powers of_function(const Function& function, const Powers& argument, size_t at) {
        if (!argument || function.operation == Operation::absolute) return argument;
        if (function.operation == Operation::root) return product({}, *argument, 0.5);
        if (argument->is_number() || same(*argument, powers_of(Dimension::angle))) return DimensionPowers{};
        fail(ErrorCode::wrong_type, at, in_quotes(function.name) + " is of an angle, or of a number, not of " + described(*argument));
        return std::nullopt;
    }

    std::string_view text_;
    const std::vector<Parameter>& parameters_;
    std::string where_;
    size_t at_ = 0;
    int depth_ = 0;
    Expression expression_;
    Errors errors_;
};

}  // namespace

Result<Expression> parse_expression(std::string_view text, const std::vector<Parameter>& parameters, const std::string& where) {
    return Parser(text, parameters, where).run();
}

description::RelationValue evaluate(const Expression& expression, const VectorX& p) {
    const Number result = run(expression.code.data(), expression.code.data() + expression.code.size(), p);
    return {result.value, result.gradient.size() > 0 ? result.gradient : VectorX(VectorX::Zero(p.size()))};
}

}  // namespace fettle::design::reading
