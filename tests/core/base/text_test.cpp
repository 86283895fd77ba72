// SPDX-License-Identifier: MIT
#include "core/base/text.hpp"

#include <catch2/catch.hpp>

namespace fettle::core::base::text_test {

TEST_CASE("What a terminal may have: no control characters, no bytes that are no UTF-8; all else as it is", "[base]") {
    CHECK(shown("pin 1\n\tøl 歯車 😀") == "pin 1\n\tøl 歯車 😀");
    CHECK(shown("a\033[2Jb\rc\x7f") == "a\\x1b[2Jb\\x0dc\\x7f");
    CHECK(shown("csi \xC2\x9B"
                "2J") == "csi \\x9b2J");  // U+009B, which terminals take for ESC [
    CHECK(shown(std::string_view("nul\0", 4)) == "nul\\x00");
    CHECK(shown("\xff") == "\\xff");
    CHECK(shown("cut \xE6\xAD") == "cut \\xe6\\xad");
    CHECK(shown("long \xC0\xAF") == "long \\xc0\\xaf");           // "/" in two bytes
    CHECK(shown("half \xED\xA0\x80") == "half \\xed\\xa0\\x80");  // a surrogate
    CHECK(shown("far \xF4\x90\x80\x80") == "far \\xf4\\x90\\x80\\x80");
    CHECK(shown("a\u202Egnp.b\u2066c") == "a\\u202egnp.b\\u2066c");  // would be read from right to left
    CHECK(shown("fin\u2028") == "fin\\u2028");
    CHECK(shown_on_one_line("a\nb\tc") == "a b c");
}

TEST_CASE("Names are text on one line", "[base]") {
    CHECK(name_fault("").empty());
    CHECK(name_fault("bore ø 3 mm, -left").empty());
    CHECK(name_fault("a\033b") == "holds the control character \\x1b");
    CHECK(name_fault("a\nb") == "holds the control character \\x0a");
    CHECK(name_fault("a\xC2\x85"
                     "b") == "holds the control character \\x85");
    CHECK(name_fault("a\xff") == "is not UTF-8: byte \\xff");
    CHECK(is_utf8("歯"));
    CHECK_FALSE(is_utf8("\xE6"));
}

TEST_CASE("Text in XML is what it was when it is read again, and what XML does not have is shown", "[base]") {
    CHECK(xml_text("a<b>&\"c\"\n\t") == "a&lt;b&gt;&amp;&quot;c&quot;&#10;&#9;");
    CHECK(xml_text("a\033b\xff") == "a\\x1bb\\xff");
    CHECK(xml_text("\xEF\xBF\xBF") == "\xEF\xBF\xBD");  // U+FFFF is no character of XML
}

TEST_CASE("A share is told with two digits, and without an exponent", "[base]") {
    CHECK(percent(0.0123) == "1.2%");
    CHECK(percent(0.98) == "98%");
    CHECK(percent(1.2345) == "123%");
    CHECK(percent(0) == "0%");
}

TEST_CASE("A field of a table is quoted where it must be, and no formula for a spreadsheet", "[base]") {
    CHECK(csv_cell("pin") == "pin");
    CHECK(csv_cell("a,b") == "\"a,b\"");
    CHECK(csv_cell("say \"a\"") == "\"say \"\"a\"\"\"");
    CHECK(csv_cell("a\rb") == "\"a\rb\"");
    CHECK(csv_cell("=1+1") == "'=1+1");
    CHECK(csv_cell("@a,b") == "\"'@a,b\"");
    CHECK(csv_cell("a=b") == "a=b");
    for (const char* name : {"pin", "=1+1", "-left", "+right", "@x", "'quoted'", "'=x", "''-x", "'", ""}) {
        CAPTURE(name);
        CHECK(csv_word(csv_cell(name)) == name);  // none of these is quoted
    }
}

TEST_CASE("A star stands for any letters, and many of them take no time", "[base]") {
    CHECK(matches_pattern("pin*", "pin"));
    CHECK(matches_pattern("*_hand", "left_hand"));
    CHECK(matches_pattern("a*b*c", "a1b2b3c"));
    CHECK(matches_pattern("**", ""));
    CHECK_FALSE(matches_pattern("pin*", "a pin"));
    CHECK_FALSE(matches_pattern("a*b", "ab c"));
    CHECK_FALSE(matches_pattern("", "a"));
    std::string stars;
    for (int i = 0; i < 1000; ++i) stars += "*a";
    CHECK_FALSE(matches_pattern(stars + "b", std::string(2000, 'a')));
}

}  // namespace fettle::core::base::text_test
