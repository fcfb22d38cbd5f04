#include "runtime/source/utf8.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("valid sequences of each length") {
    const auto check = [](std::string_view text, char32_t code) {
        const Utf8Character character = first_character(text);
        CHECK(character.valid);
        CHECK(character.code == code);
        CHECK(character.bytes == text.size());
    };
    check("A", U'A');
    check(std::string_view("\0", 1), 0);
    check("\xC2\x80", 0x80);
    check("\xDF\xBF", 0x7FF);
    check("\xE0\xA0\x80", 0x800);
    check("\xED\x9F\xBF", 0xD7FF);
    check("\xEF\xBF\xBF", 0xFFFF);
    check("\xF0\x90\x80\x80", 0x10000);
    check("\xF4\x8F\xBF\xBF", 0x10FFFF);
}

TEST_CASE("invalid sequences are one byte each") {
    for (const std::string_view text :
         {"\x80", "\xBF", "\xC0\x80", "\xC1\xBF", "\xC2", "\xC2z", "\xE0\x9F\xBF", "\xE2\x82",
          "\xED\xA0\x80", "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
        const Utf8Character character = first_character(text);
        CHECK_FALSE(character.valid);
        CHECK(character.bytes == 1);
    }
}

TEST_CASE("characters are counted, not bytes") {
    CHECK(count_characters("") == 0);
    CHECK(count_characters("a\xC3\xA4\xF0\x9F\x98\x80") == 3);
    CHECK(count_characters("\xE2\x82") == 2);
}

TEST_CASE("controls") {
    CHECK(is_control('\t'));
    CHECK(is_control(0x7F));
    CHECK(is_control(0x85));
    CHECK_FALSE(is_control(' '));
    CHECK_FALSE(is_control(0xA0));
}
