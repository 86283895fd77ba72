// SPDX-License-Identifier: MIT
/// A nonlinear programme in the form that Ipopt takes (Waechter and Biegler 2006), and one run of Ipopt on it:
///   minimise f(x)   subject to   lower <= x <= upper,   row_lower <= g(x) <= row_upper
/// quadratic_program.hpp makes one of each step, ipopt_optimiser.hpp one of the whole problem.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/types.hpp"

namespace fettle::design::optimisers {

/// What Ipopt asks for, at points that it chooses. An answer of false means that there is no value there: Ipopt shortens its step.
/// None of these functions may throw: they are called through C code.
class NonlinearProgram {
public:
    virtual ~NonlinearProgram() = default;

    struct Bounds {
        VectorX lower, upper;          ///< n
        VectorX row_lower, row_upper;  ///< m; infinite where there is none
    };
    virtual Bounds bounds() const = 0;
    virtual int jacobian_entries() const = 0;
    virtual int hessian_entries() const = 0;  ///< of the lower triangle; 0: unknown, Ipopt estimates it from gradients (limited memory)

    virtual bool value(const double* x, double& f) = 0;
    virtual bool gradient(const double* x, double* out) = 0;    ///< n
    virtual bool row_values(const double* x, double* out) = 0;  ///< m
    /// The places of the entries of dg/dx if `values` is null, else the values in that order.
    virtual bool jacobian(const double* x, int* row, int* column, double* values) = 0;
    /// The same of the lower triangle of factor d2f/dx2; Ipopt's multipliers are not handed on, since all rows are linear where this is
    /// used.
    virtual bool hessian(double factor, int* row, int* column, double* values) = 0;
    virtual bool goes_on() { return true; }  ///< asked once in each iteration; false ends the run
};

/// Ipopt's options by their names in its manual.
struct IpoptOptions {
    std::vector<std::pair<std::string, std::string>> words;
    std::vector<std::pair<std::string, double>> numbers;
    std::vector<std::pair<std::string, int>> integers;
};

struct IpoptResult {
    int status = -199;                                          ///< IpReturnCodes.h's ApplicationReturnStatus; -199: an internal error
    int iterations = 0;                                         ///< that were begun
    VectorX x, multipliers;                                     ///< n, m; Ipopt's sign: grad f + (dg/dx)^T multipliers - ... = 0
    bool solved() const { return status == 0 || status == 1; }  ///< to the tolerance, or to the acceptable one
};

/// Runs Ipopt, which prints nothing and reads no file of options. Deterministic. Debian's MUMPS is not safe for threads: a mutex lets one
/// thread of the process compute at a time. It is free while Ipopt asks for a value, which may take minutes (or solve another programme).
/// Throws core::base::MissingLibrary.
IpoptResult run_ipopt(NonlinearProgram& program, const VectorX& start, const IpoptOptions& options);

/// Ipopt's status in words, for people.
const char* ipopt_words(int status);

}  // namespace fettle::design::optimisers
