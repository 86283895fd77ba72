// SPDX-License-Identifier: MIT
// One reader as a libFuzzer target: the build says which (definition FETTLE_FUZZ_READER).
//
//     cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_targets
//     build/fuzz/bin/fuzz_ply -max_total_time=60 -timeout=5 FOLDER tests/fuzz/corpus/ply
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tests/fuzz/readers.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using fettle::tests::fuzz::readers;
    static const auto reader =
        std::find_if(readers().begin(), readers().end(), [](const auto& each) { return each.name == FETTLE_FUZZ_READER; });
    reader->read({reinterpret_cast<const char*>(data), size});
    return 0;
}
