// SPDX-License-Identifier: MIT
#include "core/solver/prescribed_drive.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::solver::prescribed_drive_test {

using fettle::core::solver::PrescribedDrive;

TEST_CASE("a drive starts with all that remains and goes on so while the way is free", "[prescribed_drive]") {
    PrescribedDrive drive;
    CHECK(drive.share() == 1);
    CHECK(drive.penalty() == 0);
    drive.adapt(1, false, false);
    CHECK(drive.share() == 1);
    drive.adapt(0.25, false, false);  // not short: as much as before
    CHECK(drive.share() == 1);
}

TEST_CASE("a short search makes the drive rest, then take a quarter", "[prescribed_drive]") {
    PrescribedDrive drive;
    drive.adapt(0.1, false, false);
    CHECK(drive.share() == 0);
    SECTION("until what is pushed has given way") {
        drive.adapt(1, false, false);
        CHECK(drive.share() == 0);
        drive.adapt(1, false, true);
        CHECK(drive.share() == 0.25);
        drive.adapt(1, false, false);  // more where much was possible
        CHECK(drive.share() == 0.5);
        drive.adapt(1, false, false);
        drive.adapt(1, false, false);
        CHECK(drive.share() == 1);  // never beyond
    }
    SECTION("or for twelve iterations") {
        for (int k = 0; k < 12; ++k) {
            CHECK(drive.share() == 0);
            drive.adapt(1, false, false);
        }
        CHECK(drive.share() == 0.25);
    }
}

TEST_CASE("an arrived drive changes nothing", "[prescribed_drive]") {
    PrescribedDrive drive;
    drive.adapt(0.01, true, false);
    CHECK(drive.share() == 1);
}

TEST_CASE("the penalty outweighs the slope and never falls", "[prescribed_drive]") {
    PrescribedDrive drive;
    drive.outweigh(6, 2, 1);
    CHECK(drive.penalty() == 6);  // 2 slope / taken
    CHECK(6 - drive.penalty() * 2 < 0);
    drive.outweigh(-5, 1, 1);
    CHECK(drive.penalty() == 6);
    drive.outweigh(0, 1, 10);
    CHECK(drive.penalty() == 10);
}

TEST_CASE("driving less is tried down to a share of 1e-4", "[prescribed_drive]") {
    PrescribedDrive drive;
    drive.outweigh(1, 1, 0);
    CHECK(drive.try_less());
    CHECK(drive.penalty() == 20);
    int quarters = 0;
    while (drive.try_less() && quarters < 100) {
        drive.adapt(0, false, false);
        drive.adapt(1, false, true);
        ++quarters;
    }
    CHECK(quarters == 7);  // 4^-7 is below 1e-4
    CHECK(drive.share() == 1e-4);
    CHECK_FALSE(drive.try_less());
}

TEST_CASE("fifty steps in a row that bring hardly anything are a stall", "[prescribed_drive]") {
    PrescribedDrive drive;
    for (int k = 0; k < 49; ++k) drive.count_stalls(9e-4);
    CHECK_FALSE(drive.is_stalled());
    drive.count_stalls(2e-3);  // it moves again: counted anew
    for (int k = 0; k < 49; ++k) drive.count_stalls(0);
    CHECK_FALSE(drive.is_stalled());
    drive.count_stalls(0);
    CHECK(drive.is_stalled());
}

}  // namespace fettle::core::solver::prescribed_drive_test
