// SPDX-License-Identifier: MIT
#include "core/files/input_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/read_record.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/json_keys.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fettle::core::files::input_file_test {

using namespace fettle::core::base;
using fettle::tests::support::TemporaryFolder;

TEST_CASE("what is no regular file is not read, and not waited for", "[base]") {
    const TemporaryFolder folder;
    CHECK(read_file(folder.path / "none").errors().at(0).code == ErrorCode::file_not_found);
    CHECK(read_file(folder.write("file", "") + "/below").errors().at(0).code == ErrorCode::file_not_found);
    const std::string pipe = folder.file("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);  // which nobody writes into
    for (const std::string& other : {pipe, folder.path.string(), std::string("/dev/zero"), std::string("/dev/null")}) {
        INFO(other);
        const auto text = read_file(other);
        REQUIRE_FALSE(text);
        CHECK(text.errors().at(0).code == ErrorCode::file_unreadable);
        CHECK(text.errors().at(0).where == other);
        CHECK_FALSE(has_top_level_key(other, "fettle_scene"));
    }
}

TEST_CASE("a file is read in pieces, to its end", "[base]") {
    const TemporaryFolder folder;
    std::string text(300'000, 'x');
    text += '\0';
    const std::string path = folder.write("file", text);
    Result<InputFile> file = InputFile::open(path);
    REQUIRE(file);
    std::string read;
    for (std::string_view next = file->next(); !next.empty(); next = file->next()) read += next;
    CHECK(read == text);
    CHECK_FALSE(file->failed());
}

TEST_CASE("what is read is recorded, by the threads that help, too, with what stood there", "[base]") {
    const TemporaryFolder folder;
    std::vector<std::string> paths;
    for (int i = 0; i < 20; ++i) paths.push_back(folder.write(std::to_string(i), std::to_string(i % 2)));
    const auto read = [&](const std::string& path) { REQUIRE(read_file(path)); };
    read(paths[0]);  // nobody records it
    ReadRecord::Files before, after;
    {
        const ReadRecord record;
        parallel_for(20, 1, [&](int i) { static_cast<void>(read_file(paths[i])); });
        static_cast<void>(read_file(folder.path / "none"));
        before = record.files();
    }
    CHECK(before.size() == 20);
    folder.write("3", "other");
    {
        const ReadRecord record;
        for (int i = 0; i < 10; ++i) read(paths[i]);
        {
            const ReadRecord inner;
            for (int i = 10; i < 19; ++i) read(paths[i]);
            CHECK(inner.files().size() == 9);
            const ReadRecord apart(ReadRecord::Outer::apart);
            read(folder.write("made to be read once", ""));
        }
        record_file(paths[19]);
        after = record.files();
    }
    CHECK(after.size() == 20);
    ReadRecord::Files changed;
    std::set_difference(after.begin(), after.end(), before.begin(), before.end(), std::inserter(changed, changed.end()));
    REQUIRE(changed.size() == 1);
    CHECK(changed.begin()->first == paths[3]);
}

}  // namespace fettle::core::files::input_file_test
