// SPDX-License-Identifier: MIT
// Every reader takes the samples, and some hundred damaged ones, without harm. Millions more: campaign.cpp, libfuzzer.cpp.
#include <catch2/catch.hpp>
#include <string>

#include "tests/fuzz/mutations.hpp"
#include "tests/fuzz/readers.hpp"

namespace fettle::tests::fuzz::corpus_test {

TEST_CASE("Every reader has samples, and takes them damaged and whole") {
    for (const Reader& reader : readers()) {
        CAPTURE(reader.name);
        const std::vector<std::string> all = samples(std::string(reader.name));
        REQUIRE_FALSE(all.empty());
        for (const std::string& sample : all) CHECK_NOTHROW(reader.read(sample));
        Mutator mutator(all, 1);
        for (int i = 0; i < (reader.by_assimp ? 2 : 50); ++i) {
            const std::string input = mutator.next();
            CHECK_NOTHROW(reader.read(input));
        }
    }
}

TEST_CASE("Inputs that were found to do harm stay harmless") {
    const std::string nul(1, '\0');
    for (const Reader& reader : readers()) {
        CAPTURE(reader.name);
        std::string deep;
        for (int i = 0; i < 100'000; ++i) deep += i % 2 ? "{\"a\":" : "[";
        for (const std::string& input :
             {std::string(), nul, std::string("ply\nformat ascii 1.0\n"), std::string("PK\5\6") + std::string(18, '\0'), deep})
            if (!reader.by_assimp) CHECK_NOTHROW(reader.read(input));
    }
}

TEST_CASE("The same seed damages in the same way") {
    const auto sequence = [](std::uint64_t seed) {
        Mutator mutator(samples("obj"), seed);
        std::string all;
        for (int i = 0; i < 100; ++i) all += mutator.next();
        return all;
    };
    CHECK(sequence(1) == sequence(1));
    CHECK(sequence(1) != sequence(2));
}

}  // namespace fettle::tests::fuzz::corpus_test
