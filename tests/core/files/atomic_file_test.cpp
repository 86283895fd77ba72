// SPDX-License-Identifier: MIT
#include "core/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>
#include <thread>

#include "tests/support/temporary_folder.hpp"

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
    CHECK(errors[0].code == ErrorCode::file_unwritable);
    CHECK(errors[0].where == (folder.path / "taken").string());
    CHECK(fs::is_directory(folder.path / "taken" / "inside"));
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
    REQUIRE(write_file_atomically(folder.path / "file", "x").empty());
    CHECK_FALSE(write_file_atomically(folder.path / "file" / "below", "x").empty());
}

TEST_CASE("files of a set take their names together, and others go with them", "[base]") {
    const TemporaryFolder folder;
    REQUIRE(write_file_atomically(folder.path / "table", "old").empty());
    REQUIRE(write_file_atomically(folder.path / "answer", "old").empty());
    REQUIRE(write_file_atomically(folder.path / "picture", "old").empty());
    REQUIRE(write_file_atomically(folder.path / "run", "old").empty());
    FilesTogether files;
    files.keep_as(folder.path / "run", folder.path / "run.1");
    files.take_away(folder.path / "table");
    files.take_away(folder.path / "picture");
    files.take_away(folder.path / "never there");
    NewFile long_one(folder.path / "run");
    long_one.write("new ");
    CHECK(read_file(folder.path / "run").value() == "old");
    long_one.write("run");
    REQUIRE(files.add(std::move(long_one)).empty());
    REQUIRE(files.add(folder.path / "table", "new").empty());
    REQUIRE(files.add(folder.path / "answer", "new").empty());
    CHECK(read_file(folder.path / "table").value() == "old");
    CHECK(read_file(folder.path / "answer").value() == "old");
    REQUIRE(files.take_names().empty());
    CHECK(read_file(folder.path / "run").value() == "new run");
    CHECK(read_file(folder.path / "run.1").value() == "old");
    CHECK(read_file(folder.path / "table").value() == "new");
    CHECK(read_file(folder.path / "answer").value() == "new");
    CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 4);
}

TEST_CASE("a set of files that cannot be replaced leaves all of them as they were", "[base]") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name) { REQUIRE(write_file_atomically(folder.path / name, "old").empty()); };
    for (const char* name : {"a", "b", "gone", "kept", "answer"}) write(name);
    const auto contents = [&] {
        std::map<std::string, std::string> found;
        for (const auto& entry : fs::directory_iterator(folder.path))
            found[entry.path().filename().string()] = entry.is_directory() ? "folder" : read_file(entry.path()).value();
        return found;
    };
    const auto set = [&](FilesTogether& files) {
        files.keep_as(folder.path / "kept", folder.path / "kept.1");
        files.take_away(folder.path / "gone");
        for (const char* name : {"a", "new", "b", "answer"}) REQUIRE(files.add(folder.path / name, "new").empty());
    };
    const auto before = contents();
    SECTION("never taken") {
        FilesTogether files;
        set(files);
    }
    SECTION("one of them cannot be written") {
        FilesTogether files;
        set(files);
        fs::create_directory(folder.path / "taken");
        CHECK(files.add(folder.path / "taken", "new").at(0).code == ErrorCode::file_unwritable);
        fs::remove(folder.path / "taken");
    }
    SECTION("one of them cannot be renamed, after others have been") {
        FilesTogether files;
        set(files);
        fs::rename(folder.path / "b", folder.path / "b.away");
        fs::create_directories(folder.path / "b" / "inside");  // a file cannot replace it
        const Errors errors = files.take_names();
        REQUIRE(errors.size() == 1);
        CHECK(errors[0].code == ErrorCode::file_unwritable);
        CHECK(errors[0].where == (folder.path / "b").string());
        CHECK(fs::is_directory(folder.path / "b" / "inside"));
        fs::remove_all(folder.path / "b");
        fs::rename(folder.path / "b.away", folder.path / "b");
    }
    SECTION("what was to be kept is not there") {
        FilesTogether files;
        set(files);
        files.keep_as(folder.path / "nothing", folder.path / "nothing.1");
        CHECK(files.take_names().at(0).code == ErrorCode::file_unwritable);
    }
    CHECK(contents() == before);
}

TEST_CASE("a pipe is written to, not replaced", "[base]") {
    const TemporaryFolder folder;
    const fs::path pipe = folder.path / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::string got;
    std::thread reader([&] { std::getline(std::ifstream(pipe), got, '\0'); });
    const Errors errors = write_file_atomically(pipe, "through");
    reader.join();
    CHECK(errors.empty());
    CHECK(got == "through");
    CHECK(fs::is_fifo(pipe));
}

TEST_CASE("all of a text is written, or what is left of it is known", "[base]") {
    const TemporaryFolder folder;
    const std::string text(100'000, 'x');
    std::string_view left = text;
    const int file = ::open(folder.file("a").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    REQUIRE(file >= 0);
    CHECK(write_all(file, left) == 0);
    CHECK(left.empty());
    ::close(file);
    CHECK(read_file(folder.path / "a").value() == text);
    std::array<int, 2> ends{};
    REQUIRE(::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) == 0);
    left = text;  // more than a pipe holds
    CHECK(write_all(ends[1], left) == EAGAIN);
    CHECK(left.size() == text.size() - static_cast<std::size_t>(::fcntl(ends[1], F_GETPIPE_SZ)));
    ::close(ends[0]);
    ::close(ends[1]);
}

TEST_CASE("a free name is one that not even a link has", "[base]") {
    const TemporaryFolder folder;
    CHECK(free_name(folder.path / "a.b.json") == folder.path / "a.b.1.json");
    folder.write("a.b.1.json", "");
    fs::create_symlink("nowhere", folder.path / "a.b.2.json");
    CHECK(free_name(folder.path / "a.b.json") == folder.path / "a.b.3.json");
    CHECK(free_name(folder.path / "none") == folder.path / "none.1");
}

TEST_CASE("the name that the system gives to an open file is written to, not replaced", "[base]") {
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "");
    const int handle = ::open(file.c_str(), O_WRONLY | O_APPEND);
    REQUIRE(handle >= 0);
    const fs::path name = "/dev/fd/" + std::to_string(handle);
    CHECK(is_written_directly(name));
    CHECK(write_file_atomically(name, "through").empty());
    ::close(handle);
    CHECK(read_file(file).value() == "through");
    for (const fs::path& each : {fs::path("/dev/null"), fs::path("/dev/full")}) CHECK(is_written_directly(each));
    for (const fs::path& each : {fs::path(file), folder.path, folder.path / "none"}) CHECK_FALSE(is_written_directly(each));
    fs::create_symlink(file, folder.path / "link");  // of a user: replaced
    CHECK_FALSE(is_written_directly(folder.path / "link"));
}

}  // namespace fettle::core::files::atomic_file_test
