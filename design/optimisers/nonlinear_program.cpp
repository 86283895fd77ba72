// SPDX-License-Identifier: MIT
#include "design/optimisers/nonlinear_program.hpp"

#include <algorithm>
#include <memory>
#include <mutex>

#include "core/base/contract.hpp"
#include "design/optimisers/ipopt_library.hpp"

namespace fettle::design::optimisers {

namespace {

// One thread computes at a time.
class Turn {
public:
    Turn() : lock_(mutex()) {}

    // Gives the turn up for as long as it lives.
    class Pause {
    public:
        explicit Pause(Turn& turn) : turn_(turn) { turn_.lock_.unlock(); }
        ~Pause() { turn_.lock_.lock(); }
        Pause(const Pause&) = delete;
        Pause& operator=(const Pause&) = delete;

    private:
        Turn& turn_;
    };

private:
    static std::mutex& mutex() {
        static std::mutex one;
        return one;
    }
    std::unique_lock<std::mutex> lock_;
};

struct Conversation {
    NonlinearProgram& program;
    Turn turn = {};
    int iterations = 0;
};

// @return the answer of one of the program's functions, asked while other threads may compute.
template <class Question>
Bool asked(UserDataPtr data, const Question& question) {
    Conversation& conversation = *static_cast<Conversation*>(data);
    const Turn::Pause pause(conversation.turn);
    return question(conversation.program) ? TRUE : FALSE;
}

// NOLINTBEGIN(readability-function-size): Ipopt's parameters
Bool ask_value(Index, Number* x, Bool, Number* value, UserDataPtr data) {
    return asked(data, [&](NonlinearProgram& p) { return p.value(x, *value); });
}

Bool ask_gradient(Index, Number* x, Bool, Number* gradient, UserDataPtr data) {
    return asked(data, [&](NonlinearProgram& p) { return p.gradient(x, gradient); });
}

Bool ask_rows(Index, Number* x, Bool, Index, Number* values, UserDataPtr data) {
    return asked(data, [&](NonlinearProgram& p) { return p.row_values(x, values); });
}

Bool ask_jacobian(Index, Number* x, Bool, Index, Index, Index* row, Index* column, Number* values, UserDataPtr data) {
    return asked(data, [&](NonlinearProgram& p) { return p.jacobian(x, row, column, values); });
}

Bool ask_hessian(Index, Number*, Bool, Number factor, Index, Number*, Bool, Index, Index* row, Index* column, Number* values,
                 UserDataPtr data) {
    return asked(data, [&](NonlinearProgram& p) { return p.hessian(factor, row, column, values); });
}

Bool ask_going_on(Index, Index, Number, Number, Number, Number, Number, Number, Number, Number, Index, UserDataPtr data) {
    ++static_cast<Conversation*>(data)->iterations;
    return asked(data, [](NonlinearProgram& p) { return p.goes_on(); });
}
// NOLINTEND(readability-function-size)

using IpoptHandle = std::unique_ptr<IpoptProblemInfo, void (*)(IpoptProblem)>;

void set_options(const IpoptLibrary& ipopt, IpoptProblem problem, IpoptOptions options) {
    options.words.insert(options.words.begin(), {{"option_file_name", ""}, {"sb", "yes"}});
    options.integers.insert(options.integers.begin(), {"print_level", 0});
    for (auto& [name, value] : options.words)
        FETTLE_ASSERT(ipopt.add_string_option(problem, name.data(), value.data()) != FALSE, "Ipopt has the option");
    for (auto& [name, value] : options.numbers)
        FETTLE_ASSERT(ipopt.add_number_option(problem, name.data(), value) != FALSE, "Ipopt has the option");
    for (auto& [name, value] : options.integers)
        FETTLE_ASSERT(ipopt.add_integer_option(problem, name.data(), value) != FALSE, "Ipopt has the option");
}

VectorX within_ipopts_infinity(const VectorX& bounds) {
    constexpr double no_bound = 1e20;  // beyond 1e19 Ipopt takes a bound as none
    return bounds.cwiseMax(-no_bound).cwiseMin(no_bound);
}

}  // namespace

IpoptResult run_ipopt(NonlinearProgram& program, const VectorX& start, const IpoptOptions& options) {
    const IpoptLibrary& ipopt = ipopt_library();
    core::linear::take_blas_buffer(ipopt.threads);
    const NonlinearProgram::Bounds bounds = program.bounds();
    VectorX lower = within_ipopts_infinity(bounds.lower), upper = within_ipopts_infinity(bounds.upper);
    VectorX row_lower = within_ipopts_infinity(bounds.row_lower), row_upper = within_ipopts_infinity(bounds.row_upper);
    FETTLE_ASSERT(lower.size() == start.size() && upper.size() == start.size() && row_upper.size() == row_lower.size(), "sizes agree");
    Conversation conversation{program};
    const IpoptHandle problem(ipopt.create_problem(count_of(start), lower.data(), upper.data(), count_of(row_lower), row_lower.data(),
                                                   row_upper.data(), program.jacobian_entries(), program.hessian_entries(), 0, ask_value,
                                                   ask_rows, ask_gradient, ask_jacobian, ask_hessian),
                              ipopt.free_problem);
    IpoptResult result;
    if (!problem) return result;
    set_options(ipopt, problem.get(), options);
    ipopt.set_intermediate_callback(problem.get(), ask_going_on);
    result.x = start;
    result.multipliers = VectorX::Zero(row_lower.size());
    result.status =
        ipopt.solve(problem.get(), result.x.data(), nullptr, nullptr, result.multipliers.data(), nullptr, nullptr, &conversation);
    result.iterations = conversation.iterations;
    return result;
}

const char* ipopt_words(int status) {
    switch (status) {
        case Solve_Succeeded:
            return "no step near by promises a gain above the tolerance";
        case Solved_To_Acceptable_Level:
            return "the last designs differ by less than the tolerance";
        case Infeasible_Problem_Detected:
            return "no design near by comes closer to the requirements";
        case Search_Direction_Becomes_Too_Small:
            return "steps became so short that rounding hides what they gain";
        case User_Requested_Stop:
            return "stopped";
        case Maximum_Iterations_Exceeded:
            return "the most iterations that are allowed were made";
        case Restoration_Failed:
            return "no step that it tries brings the design closer to the requirements";
        case Error_In_Step_Computation:
            return "no next design could be computed";
        case Not_Enough_Degrees_Of_Freedom:
            return "there are more equations than parameters";
        case Invalid_Number_Detected:
            return "the designs next to the best one cannot be evaluated";
        default:
            return "failed";
    }
}

}  // namespace fettle::design::optimisers
