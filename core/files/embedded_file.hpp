// SPDX-License-Identifier: MIT
/// A file as bytes of the program, put in by the assembler: no compiler reads it, however long it is.
///
///     FETTLE_EMBEDDED_FILE(fettle_page, "/path/of/page.html")      outside of namespaces; makes std::string_view fettle_page()
///
/// ccache does not see that the file has changed: of the source that has this line, OBJECT_DEPENDS names the file and
/// SKIP_UNITY_BUILD_INCLUSION is on.
#pragma once

#include <cstddef>
#include <string_view>

/// @param NAME  of the whole program: the two ends of the file are symbols.
/// @param PATH  a string literal.
// clang-format off
#define FETTLE_EMBEDDED_FILE(NAME, PATH)                                                                              \
    asm(".pushsection .rodata\n"                                                                                      \
        ".global " #NAME "_begin\n"                                                                                   \
        ".hidden " #NAME "_begin\n"                                                                                   \
        ".global " #NAME "_end\n"                                                                                     \
        ".hidden " #NAME "_end\n"                                                                                     \
        #NAME "_begin:\n"                                                                                             \
        ".incbin \"" PATH "\"\n"                                                                                      \
        #NAME "_end:\n"                                                                                               \
        ".popsection\n");                                                                                             \
    extern "C" {                                                                                                      \
    extern const char NAME##_begin[] __attribute__((visibility("hidden")));                                           \
    extern const char NAME##_end[] __attribute__((visibility("hidden")));                                             \
    }                                                                                                                 \
    static std::string_view NAME() { return {NAME##_begin, static_cast<std::size_t>(NAME##_end - NAME##_begin)}; }
// clang-format on
