// SPDX-License-Identifier: MIT
#include "core/expression/parse_formula.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "core/base/limits.hpp"
#include "core/files/nearest_word.hpp"

namespace fettle::core::expression {
namespace {

using base::Dimension;
using base::ErrorCode;

constexpr int deepest = 100;  // parentheses and signs within one another

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool starts_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 128; }
bool is_of_word(char c) { return starts_word(c) || is_digit(c) || c == '.'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
std::string in_quotes(std::string_view text) { return "`" + std::string(text) + "`"; }

// What a function takes and returns.
enum class Kind {
    keeps,      // of the dimension of its operands
    root,       // of the square root of it
    of_angle,   // an angle, or a number in radians, to a number
    to_angle,   // a number to an angle
    of_number,  // a number to a number
    two_to_angle
};
struct Function {
    std::string_view name;
    Operation operation;
    Kind kind;
    int fewest, most;  // operands
};
constexpr int any_count = 1'000'000;
constexpr std::array functions{Function{"min", Operation::minimum, Kind::keeps, 2, any_count},
                               Function{"max", Operation::maximum, Kind::keeps, 2, any_count},
                               Function{"hypot", Operation::hypotenuse, Kind::keeps, 2, any_count},
                               Function{"abs", Operation::absolute, Kind::keeps, 1, 1},
                               Function{"sqrt", Operation::root, Kind::root, 1, 1},
                               Function{"sin", Operation::sine, Kind::of_angle, 1, 1},
                               Function{"cos", Operation::cosine, Kind::of_angle, 1, 1},
                               Function{"tan", Operation::tangent, Kind::of_angle, 1, 1},
                               Function{"asin", Operation::arc_sine, Kind::to_angle, 1, 1},
                               Function{"acos", Operation::arc_cosine, Kind::to_angle, 1, 1},
                               Function{"atan", Operation::arc_tangent, Kind::to_angle, 1, 1},
                               Function{"atan2", Operation::arc_tangent_2, Kind::two_to_angle, 2, 2},
                               Function{"exp", Operation::exponential, Kind::of_number, 1, 1},
                               Function{"log", Operation::logarithm, Kind::of_number, 1, 1}};

// The meaning of a part of a text.
struct Term {
    int node = 0;
    std::optional<DimensionPowers> dimension;  // none: of something that is wrong already
};

// Recursive descent, one function per rank of operators. What stops the reading is thrown as Stop; faults of names and dimensions are
// collected, and the reading goes on.
class Parser {
public:
    Parser(std::string_view text, const Scope& scope, std::string where) : text_(text), scope_(scope), where_(std::move(where)) {}

    base::Result<Formula> run() {
        try {
            take('=');
            const Term term = sum();
            if (!at_end()) stop("an operator is expected" + before_rest());
            if (errors_.empty()) return formula_of(term);
        } catch (const Stop&) {
        }
        return std::move(errors_);
    }

private:
    struct Stop {};

    void fail(ErrorCode code, std::size_t at, const std::string& message) {
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
               (comparison ? "; write comparisons as `if(a < b, x, y)`, and bounds of a relation in `lower` and `upper`" : "");
    }

    bool at_end() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
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

    // A value that no input changes is known while it is read.
    bool is_constant(int node) const { return nodes_[node].operation == Operation::constant; }
    double number_at(int node) const { return nodes_[node].number; }
    int constant(double value) { return add({Operation::constant, {0, 0, 0}, value}); }
    // Nothing is computed twice: variables that use one another would grow without end.
    int add(const Node& node) {
        const auto key = std::tuple(node.operation, node.operands, std::bit_cast<std::uint64_t>(node.number));
        const auto [known, is_new] = known_nodes_.emplace(key, count_of(nodes_));
        if (is_new) nodes_.push_back(node);
        return known->second;
    }
    int emit(Operation operation, int a, int b = -1, int c = -1) {
        const bool known = is_constant(a) && (b < 0 || is_constant(b)) && (c < 0 || is_constant(c));
        if (known) return constant(applied<double>(operation, number_at(a), b < 0 ? 0 : number_at(b), c < 0 ? 0 : number_at(c)));
        return add({operation, {a, std::max(b, 0), std::max(c, 0)}, 0});
    }

    Formula formula_of(const Term& term) const {
        Formula out = expression::formula_of(needed_for(nodes_, term.node), inputs_, *term.dimension);
        out.text = text_;
        return out;
    }

    Term sum() {
        Term left = product_of_factors();
        for (;;) {
            at_end();
            const std::size_t at = at_;
            const bool plus = take('+');
            if (!plus && !take('-')) return left;
            Term right = product_of_factors();
            left.dimension = one_dimension(left, right, at, plus ? "added" : "subtracted");
            left.node = emit(plus ? Operation::add : Operation::subtract, left.node, right.node);
        }
    }

    // A number without a unit takes the unit of the quantity beside it.
    std::optional<DimensionPowers> one_dimension(Term& a, Term& b, std::size_t at, const std::string& done) {
        if (!a.dimension || !b.dimension || same(*a.dimension, *b.dimension)) return a.dimension ? a.dimension : b.dimension;
        if (takes_unit(a, *b.dimension) || takes_unit(b, *a.dimension)) return a.dimension;
        const bool number = a.dimension->is_number() || b.dimension->is_number();
        fail(ErrorCode::wrong_type, at,
             described(*a.dimension) + " and " + described(*b.dimension) + " cannot be " + done +
                 (number ? "; give the number a unit" : ""));
        return std::nullopt;
    }

    bool takes_unit(Term& term, const DimensionPowers& expected) {
        if (!term.dimension->is_number() || !is_constant(term.node)) return false;
        const auto dimension = named_dimension(expected);
        const double unit = !dimension ? 0 : scope_.plain_unit ? scope_.plain_unit(*dimension) : 1;
        if (!(unit > 0)) return false;
        term = {constant(number_at(term.node) * unit), expected};
        return true;
    }

    Term product_of_factors() {
        Term left = factor();
        for (;;) {
            const bool times = take('*');
            if (!times && !take('/')) return left;
            const Term right = factor();
            left.node = emit(times ? Operation::multiply : Operation::divide, left.node, right.node);
            left.dimension = left.dimension && right.dimension ? std::optional(product(*left.dimension, *right.dimension, times ? 1 : -1))
                                                               : std::nullopt;
        }
    }

    Term factor() {
        if (++depth_ > deepest) stop("more than " + std::to_string(deepest) + " parentheses and signs within one another");
        Term term;
        if (take('-')) {
            term = factor();
            term.node = emit(Operation::negate, term.node);
        } else if (take('+')) {
            term = factor();
        } else {
            term = raised();
        }
        --depth_;
        return term;
    }

    Term raised() {
        const Term base = primary();
        if (!take('^')) return base;
        at_end();
        const std::size_t at = at_;
        const Term exponent = factor();
        const int node = emit(Operation::power, base.node, exponent.node);
        if (exponent.dimension && !exponent.dimension->is_number()) {
            fail(ErrorCode::wrong_type, at, "an exponent is a number, not " + described(*exponent.dimension));
            return {node, std::nullopt};
        }
        if (!base.dimension || base.dimension->is_number()) return {node, base.dimension};
        if (is_constant(exponent.node)) return {node, product({}, *base.dimension, number_at(exponent.node))};
        fail(ErrorCode::wrong_type, at, described(*base.dimension) + " can be raised to a constant power only");
        return {node, std::nullopt};
    }

    Term primary() {
        if (at_end()) stop("a number, a " + scope_.what + " or `(` is expected, but the formula ends");
        const char c = text_[at_];
        if (take('(')) {
            const Term term = sum();
            want(')');
            return term;
        }
        if (is_digit(c) || c == '.') return number();
        if (c == '\'') return quoted_name();
        if (starts_word(c)) return word();
        stop("a number, a " + scope_.what + " or `(` is expected" + before_rest());
    }

    Term number() {
        double value = 0;
        const auto [end, code] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (code != std::errc() || !base::is_usable_number(value)) stop("this number cannot be used" + before_rest());
        at_ = static_cast<std::size_t>(end - text_.data());
        const base::Unit* unit = nullptr;
        if (!at_end() && starts_word(text_[at_])) {
            unit = longest_unit();
            if (unit == nullptr) stop("there is no such unit; if a product is meant, write `*`" + before_rest());
            at_ += unit->name.size();
            if (take('^')) stop("is the unit raised, or the number too? write parentheses");
        }
        const double si = unit == nullptr ? value : to_si(value, *unit);
        if (!base::is_usable_number(si)) stop("this number is out of range: at most 1e30 is allowed");
        return {constant(si), powers_of(unit == nullptr ? Dimension::number : unit->dimension)};
    }

    const base::Unit* longest_unit() const {
        const base::Unit* longest = nullptr;
        const std::string_view rest = text_.substr(at_);
        for (const base::Unit& unit : base::units()) {
            const std::size_t length = unit.name.size();
            const bool fits = rest.starts_with(unit.name) && (length == rest.size() || !is_of_word(rest[length]));
            if (fits && (longest == nullptr || length > longest->name.size())) longest = &unit;
        }
        return longest;
    }

    Term quoted_name() {
        const std::size_t begin = at_, end = text_.find('\'', at_ + 1);
        if (end == std::string_view::npos) stop("the closing quote is missing of the name that begins here");
        at_ = end + 1;
        return named(text_.substr(begin + 1, end - begin - 1), begin);
    }

    Term word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_of_word(text_[at_])) ++at_;
        const std::string_view name = text_.substr(begin, at_ - begin);
        if (take('(')) return name == "if" ? choice() : name == "floor" ? whole_number(begin) : call(name, begin);
        if (name == "pi" && scope_.find(name) == nullptr) return {constant(std::numbers::pi), DimensionPowers{}};
        return named(name, begin);
    }

    Term named(std::string_view name, std::size_t at) {
        const Scope::Name* found = scope_.find(name);
        if (found != nullptr) return {found->meaning ? variable(*found->meaning) : input(found->name), found->dimension};
        std::vector<std::string_view> known;
        for (const Scope::Name& other : scope_.names) known.emplace_back(other.name);
        fail(ErrorCode::out_of_range, at,
             "there is no " + scope_.what + " " + in_quotes(name) +
                 (known.empty() ? std::string("; there are none here") : "; " + files::did_you_mean(name, known, '`')));
        return {constant(1), std::nullopt};  // stands in until the faults are reported
    }

    int input(const std::string& name) {
        const auto known = std::find(inputs_.begin(), inputs_.end(), name);
        const int index = static_cast<int>(known - inputs_.begin());
        if (known == inputs_.end()) inputs_.push_back(name);
        return add({Operation::input, {index, 0, 0}, 0});
    }

    int variable(const Formula& meaning) {
        if (meaning.is_constant()) return constant(value_of<double>(meaning, {}));
        std::vector<int> moved;
        for (Node node : meaning.nodes) {
            if (node.operation == Operation::input) {
                moved.push_back(input(meaning.inputs[node.operands[0]]));
                continue;
            }
            for (int i = 0; i < operand_count(node.operation); ++i) {
                int& operand = node.operands[i];
                operand = moved[operand];
            }
            moved.push_back(add(node));
        }
        return moved.back();
    }

    Term choice() {
        at_end();
        const std::size_t at = at_;
        Term a = sum();
        at_end();
        const char sign = at_ < text_.size() ? text_[at_] : ' ';
        if (sign != '<' && sign != '>') stop("`if` takes a comparison, a < b, then two values: `if(a < b, x, y)`");
        ++at_;
        const bool or_equal = at_ < text_.size() && text_[at_] == '=';
        if (or_equal) ++at_;
        Term b = sum();
        one_dimension(a, b, at, "compared");
        want(',');
        Term x = sum();
        want(',');
        at_end();
        const std::size_t other = at_;
        Term y = sum();
        want(')');
        const auto dimension = one_dimension(x, y, other, "the two values of one `if`");
        // a <= b is not (b < a), and so with the two values exchanged.
        const bool swapped = (sign == '>') != or_equal;
        const int difference = swapped ? emit(Operation::subtract, b.node, a.node) : emit(Operation::subtract, a.node, b.node);
        if (or_equal) std::swap(x, y);
        return {emit(Operation::choose, difference, x.node, y.node), dimension};
    }

    Term whole_number(std::size_t at) {
        const Term term = sum();
        want(')');
        if (term.dimension && !term.dimension->is_number())
            fail(ErrorCode::wrong_type, at, "`floor` is of a number, not of " + described(*term.dimension));
        if (!is_constant(term.node))
            fail(ErrorCode::wrong_type, at, "`floor` jumps, so its value must be one that no " + scope_.what + " changes");
        return {constant(std::floor(is_constant(term.node) ? number_at(term.node) : 0)), DimensionPowers{}};
    }

    Term call(std::string_view name, std::size_t at) {
        const Function* function = nullptr;
        std::vector<std::string_view> known{"if", "floor"};
        for (const Function& candidate : functions) {
            known.push_back(candidate.name);
            if (candidate.name == name) function = &candidate;
        }
        if (function == nullptr) {
            fail(ErrorCode::out_of_range, at, "there is no function " + in_quotes(name) + "; " + files::did_you_mean(name, known, '`'));
            throw Stop{};
        }
        Term term = sum();
        if (function->most == 1) {
            term = {emit(function->operation, term.node), of_function(*function, term.dimension, at)};
        } else {
            if (at_end() || text_[at_] != ',')
                stop(in_quotes(name) + (function->most == 2 ? " takes two values, with `,` between them"
                                                            : " takes two values or more, with `,` between them"));
            int count = 1;
            while (count < function->most && take(',')) {
                Term next = sum();
                term.dimension = one_dimension(term, next, at, "compared");
                term.node = emit(function->operation, term.node, next.node);
                ++count;
            }
            if (function->kind == Kind::two_to_angle) term.dimension = powers_of(Dimension::angle);
        }
        want(')');
        return term;
    }

    std::optional<DimensionPowers> of_function(const Function& function, const std::optional<DimensionPowers>& argument, std::size_t at) {
        if (!argument || function.kind == Kind::keeps) return argument;
        if (function.kind == Kind::root) return product({}, *argument, 0.5);
        const bool takes_angle = function.kind == Kind::of_angle && same(*argument, powers_of(Dimension::angle));
        if (argument->is_number() || takes_angle) return function.kind == Kind::to_angle ? powers_of(Dimension::angle) : DimensionPowers{};
        fail(ErrorCode::wrong_type, at,
             in_quotes(function.name) +
                 (function.kind == Kind::of_angle ? " is of an angle, or of a number, not of " : " is of a number, not of ") +
                 described(*argument));
        return std::nullopt;
    }

    std::string_view text_;
    const Scope& scope_;
    std::string where_;
    std::size_t at_ = 0;
    int depth_ = 0;
    Nodes nodes_;
    std::vector<std::string> inputs_;
    std::map<std::tuple<Operation, std::array<int, 3>, std::uint64_t>, int> known_nodes_;
    base::Errors errors_;
};

class Definer {
public:
    Definer(const std::map<std::string, std::string>& texts, Scope& scope,
            const std::function<Scope::Name(const std::string&, Formula)>& define)
        : texts_(texts), scope_(scope), define_(define) {}

    base::Errors run() {
        for (const auto& [name, text] : texts_) add(name);
        return std::move(errors_);
    }

private:
    // After those that it names.
    void add(const std::string& name) {
        if (!done_.insert(name).second) return;
        constexpr std::size_t deepest_chain = 200;
        if (open_.size() > deepest_chain) return fail(name, "variables follow from one another more than 200 deep");
        const std::string& text = texts_.at(name);
        open_.push_back(name);
        for (const std::string& other : names_in(text)) {
            if (std::find(open_.begin(), open_.end(), other) != open_.end()) {
                open_.pop_back();
                return fail(name, "the variable `" + other + "` follows from itself");
            }
            if (texts_.count(other) != 0) add(other);
        }
        open_.pop_back();
        base::Result<Formula> formula = parse_formula(text, scope_);
        for (const base::Error& error : formula.errors()) fail(name, error.message, error.code);
        if (formula && is_too_long(*formula)) {
            if (!is_full_)
                errors_.push_back({ErrorCode::out_of_range, name,
                                   "written out over what they follow from, the variables up to this one are more than 1000000 operations "
                                   "long: let fewer follow from one another"});
            is_full_ = true;
            formula = constant_formula(1, formula->dimension);
        }
        if (formula) scope_.names.push_back(define_(name, std::move(formula).value()));
    }

    // A chain of n variables is n^2 / 2 operations long.
    bool is_too_long(const Formula& formula) {
        constexpr std::size_t most = 1'000'000;
        length_ += formula.nodes.size();
        return length_ > most;
    }

    void fail(const std::string& name, const std::string& message, ErrorCode code = ErrorCode::inconsistent) {
        errors_.push_back({code, name, message});
        if (scope_.find(name) == nullptr) scope_.names.push_back({name, {}, constant_formula(1)});
    }

    const std::map<std::string, std::string>& texts_;
    Scope& scope_;
    const std::function<Scope::Name(const std::string&, Formula)>& define_;
    std::set<std::string> done_;
    std::vector<std::string> open_;
    std::size_t length_ = 0;
    bool is_full_ = false;
    base::Errors errors_;
};

}  // namespace

base::Errors define_variables(const std::map<std::string, std::string>& texts, Scope& scope,
                              const std::function<Scope::Name(const std::string&, Formula)>& define) {
    return Definer(texts, scope, define).run();
}

std::function<double(Dimension)> plain_units(double length_unit, double mass_unit) {
    return [=](Dimension dimension) {
        switch (dimension) {
            case Dimension::length:
            case Dimension::speed:
                return length_unit;
            case Dimension::area:
                return length_unit * length_unit;
            case Dimension::mass:
                return mass_unit;
            case Dimension::angle:
            case Dimension::angular_speed:
            case Dimension::angular_acceleration:
                return std::numbers::pi / 180;
            default:
                return 1.0;
        }
    };
}

const Scope::Name* Scope::find(std::string_view name) const {
    const auto found = std::find_if(names.begin(), names.end(), [&](const Name& other) { return other.name == name; });
    return found == names.end() ? nullptr : &*found;
}

base::Result<Formula> parse_formula(std::string_view text, const Scope& scope, const std::string& where) {
    return Parser(text, scope, where).run();
}

base::Result<Formula> parse_formula_of(std::string_view text, const Scope& scope, Dimension dimension, double si_per_number,
                                       const std::string& where) {
    base::Result<Formula> formula = parse_formula(text, scope, where);
    if (!formula || same(formula->dimension, powers_of(dimension))) return formula;
    if (formula->dimension.is_number() && formula->is_constant()) {
        Formula out = constant_formula(formula->nodes.back().number * si_per_number, powers_of(dimension));
        out.text = text;
        return out;
    }
    const base::Unit* unit = base::find_unit(base::si_unit(dimension));
    const std::string remedy =
        formula->dimension.is_number() && unit != nullptr ? "; multiply it by a unit, such as `1 " + std::string(unit->name) + "`" : "";
    return base::Error{ErrorCode::wrong_type, where,
                       "this is " + described(formula->dimension) + ", " + described(powers_of(dimension)) + " is expected" + remedy};
}

std::vector<std::string> names_in(std::string_view text) {
    std::vector<std::string> out;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t begin = at;
        if (text[at] == '\'') {
            const std::size_t end = std::min(text.find('\'', at + 1), text.size());
            out.emplace_back(text.substr(at + 1, end - at - 1));
            at = end + 1;
        } else if (starts_word(text[at])) {
            while (at < text.size() && is_of_word(text[at])) ++at;
            out.emplace_back(text.substr(begin, at - begin));
        } else if (is_digit(text[at])) {  // with the unit behind it
            while (at < text.size() && (is_of_word(text[at]) || is_space(text[at]))) ++at;
        } else {
            ++at;
        }
    }
    return out;
}

std::string quoted_if_needed(std::string_view name) {
    const bool is_word = !name.empty() && starts_word(name.front()) && std::all_of(name.begin(), name.end(), is_of_word);
    return is_word ? std::string(name) : "'" + std::string(name) + "'";
}

bool is_possible_name(std::string_view name) { return !name.empty() && name.find('\'') == std::string_view::npos; }

}  // namespace fettle::core::expression
