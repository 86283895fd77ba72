// SPDX-License-Identifier: MIT
/// Everything of fettle that reads a file from outside, each as one function of bytes: what the fuzz targets (libfuzzer.cpp), the campaign
/// (campaign.cpp) and the fast test (corpus_test.cpp) share. A reader may refuse what it is given; it must not crash, abort, throw, read
/// out of bounds or take long.
#pragma once

#include <string_view>
#include <vector>

namespace fettle::tests::fuzz {

struct Reader {
    std::string_view name;  ///< and the folder of its samples in corpus/
    void (*read)(std::string_view bytes);
    bool by_assimp = false;  ///< in a process of its own: a hundred times as slow
};

const std::vector<Reader>& readers();

}  // namespace fettle::tests::fuzz
