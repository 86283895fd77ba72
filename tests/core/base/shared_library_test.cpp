// SPDX-License-Identifier: MIT
#include "core/base/shared_library.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace fettle::core::base::shared_library_test {

namespace {

std::string fault_of(const std::string& name, const std::string& path) {
    try {
        const SharedLibrary library(name, path);
    } catch (const MissingLibrary& missing) {
        return missing.what();
    }
    return "";
}

}  // namespace

TEST_CASE("a function of a shared library is found by its name") {
    const SharedLibrary library("libm.so.6", "");
    double (*cosine)(double) = nullptr;
    library.find("cos", cosine);
    REQUIRE(cosine != nullptr);
    CHECK(cosine(0.5) == std::cos(0.5));
}

TEST_CASE("a library that is not there is named, and so is what it lacks") {
    CHECK(fault_of("libfettle_nowhere.so.7", "").find("libfettle_nowhere.so.7") != std::string::npos);
    CHECK(fault_of("libfettle_nowhere.so.7", "/nowhere/libother.so").find("libfettle_nowhere.so.7") != std::string::npos);
    CHECK(fault_of("libm.so.6", "/nowhere").empty());
    const SharedLibrary library("libm.so.6", "");
    void (*lacking)() = nullptr;
    CHECK_THROWS_AS(library.find("fettle_lacks_this", lacking), MissingLibrary);
    CHECK_THROWS_WITH(library.find("fettle_lacks_this", lacking), Catch::Contains("libm.so.6") && Catch::Contains("fettle_lacks_this"));
}

}  // namespace fettle::core::base::shared_library_test
