// SPDX-License-Identifier: MIT
// Gives readers any number of damaged samples, with any compiler: what libFuzzer does by coverage, by count.
//
//     fuzz_campaign COUNT SEED [READER...]     all readers if none is named; COUNT inputs each, of those through assimp a hundredth
//
// Each input is in DIR/READER.input ($FETTLE_FUZZ_DIR, else the working directory) while it is read, so that after a crash it is there; one
// that takes more than 5 s is kept as READER.slow.N. Exit code 1 if there was any.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/fuzz/mutations.hpp"
#include "tests/fuzz/readers.hpp"

namespace {

using fettle::tests::fuzz::Reader;

constexpr double longest = 5;  // [s]

void keep(const std::string& path, const std::string& input) { std::ofstream(path, std::ios::binary) << input; }

/// @return how many took too long
int run(const Reader& reader, long count, unsigned long seed, const std::string& folder) {
    using Clock = std::chrono::steady_clock;
    const std::string name(reader.name);
    fettle::tests::fuzz::Mutator mutator(fettle::tests::fuzz::samples(name), seed);
    int slow = 0;
    double worst = 0;
    const auto start = Clock::now();
    for (long i = 0; i < count; ++i) {
        const std::string input = mutator.next();
        keep(folder + "/" + name + ".input", input);
        const auto begin = Clock::now();
        reader.read(input);
        const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
        worst = std::max(worst, seconds);
        if (seconds > longest) keep(folder + "/" + name + ".slow." + std::to_string(slow++), input);
    }
    std::printf("%s: %ld inputs, seed %lu, %.0f s, the slowest %.2f s, %d took more than %.0f s\n", name.c_str(), count, seed,
                std::chrono::duration<double>(Clock::now() - start).count(), worst, slow, longest);
    std::fflush(stdout);
    return slow;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        std::fputs("fuzz_campaign COUNT SEED [READER...]\n", stderr);
        return 3;
    }
    const char* folder = std::getenv("FETTLE_FUZZ_DIR");
    const long inputs = std::atol(arguments[1]);
    const unsigned long seed = std::strtoul(arguments[2], nullptr, 10);
    int slow = 0, ran = 0;
    for (const Reader& reader : fettle::tests::fuzz::readers()) {
        if (count > 3 && std::find(arguments + 3, arguments + count, reader.name) == arguments + count) continue;
        slow += run(reader, reader.by_assimp ? std::max(1L, inputs / 100) : inputs, seed, folder ? folder : ".");
        ++ran;
    }
    return slow > 0 || ran == 0 ? 1 : 0;
}
