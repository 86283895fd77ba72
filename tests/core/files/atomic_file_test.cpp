// SPDX-License-Identifier: MIT
#include "fettle/core/files/atomic_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "fettle/tests/support/temporary_folder.hpp"

namespace fettle::core::files::atomic_file_test {

using namespace fettle::core::base;
using fettle::tests::support::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("a file is written whole, over an older one too, and nothing is left beside it", "[base]") {
    const TemporaryFolder folder;
    const fs::path file = folder.path / "new" / "deep" / "report.txt";
    const std::string contents("first\0line\n", 11);
    REQUIRE(write_file_atomically(file, contents).empty());
    CHECK(read_file(file).value() == contents);
    REQUIRE(write_file_atomically(file, "").empty());
    CHECK(read_file(file).value().empty());
    CHECK(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()) == 1);
}

TEST_CASE("a written file has the permissions of any new file", "[base]") {
    const TemporaryFolder folder;
    const mode_t mask = ::umask(022);
    REQUIRE(write_file_atomically(folder.path / "a", "x").empty());
    ::umask(mask);
    CHECK((fs::status(folder.path / "a").permissions() & fs::perms::all) == static_cast<fs::perms>(0644));
}

TEST_CASE("a write that fails leaves things as they were, and says why", "[base]") {
    const TemporaryFolder folder;
    fs::create_directories(folder.path / "taken" / "inside");
    const Errors errors = write_file_atomically(folder.path / "taken", "x");  // a folder cannot be replaced by a file
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].code == ErrorCode::file_unreadable);
    CHECK(errors[0].where == (folder.path / "taken").string());
    CHECK(fs::is_directory(folder.path / "taken" / "inside"));
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
    REQUIRE(write_file_atomically(folder.path / "file", "x").empty());
    CHECK_FALSE(write_file_atomically(folder.path / "file" / "below", "x").empty());
}

TEST_CASE("files that are not there, and folders, are not read", "[base]") {
    const TemporaryFolder folder;
    CHECK(read_file(folder.path / "none").errors().at(0).code == ErrorCode::file_not_found);
    CHECK(read_file(folder.path).errors().at(0).code == ErrorCode::file_unreadable);
}

}  // namespace fettle::core::files::atomic_file_test
