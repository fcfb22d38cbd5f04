#include <regex>
#include <string>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"

using namespace lineshaft;

TEST_CASE("no part of a reference bears the name of a field, which would hide it") {
    int parts = 0;
    for (const BlockType& type : standard_blocks().types()) {
        const std::string source(type.structured_text);
        const std::regex part("FUNCTION \"" + std::string(type.handle) + "\\.(\\w+)\"");
        for (std::sregex_iterator it(source.begin(), source.end(), part), end; it != end; ++it) {
            ++parts;
            INFO(type.name << "." << (*it)[1]);
            for (const Field& field : type.fields)
                CHECK_FALSE(same_letters(field.name, (*it)[1].str()));
        }
    }
    CHECK(parts >= 7);
}
