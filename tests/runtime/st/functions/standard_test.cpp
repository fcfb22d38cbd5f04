#include "runtime/st/functions/standard.hpp"

#include <set>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/st/functions/described.hpp"
#include "runtime/st/prelude/standard_source.hpp"
#include "tests/runtime/st/instance.hpp"

using namespace lineshaft;
using st::Generic, st::StandardFunction;

namespace {

/// A type that a row's generic one stands for, and of which `is_other` is none.
std::string type_for(Generic type, bool is_other) {
    if (is_other) return type == Generic::array ? "DINT" : "ARRAY[0..1] OF STRING";
    switch (type) {
        case Generic::any:
        case Generic::any_ordered:
            return "DINT";
        case Generic::any_elementary:
            return "STRING";
        case Generic::any_magnitude:
            return "TIME";
        case Generic::any_real:
            return "LREAL";
        case Generic::any_num:
        case Generic::any_int:
            return "INT";
        case Generic::any_bit:
        case Generic::any_whole:
            return "WORD";
        case Generic::array:
            return "ARRAY[0..15] OF BOOL";
        case Generic::pointer:
            return "POINTER TO BYTE";
        case Generic::timer:
            return "TON";
        default:
            return std::string(st::name_of(type));
    }
}

/// A program that calls it; `wrong` is the number of an argument of a type that does not suit.
std::string call_of(const StandardFunction& f, int count, bool by_name, int wrong = -1) {
    std::string variables, arguments;
    for (int k = 0; k < count; ++k) {
        const int i = by_name ? count - 1 - k : k;
        const Generic type = f.parameter(static_cast<std::size_t>(i)).type;
        const std::string name = argument_name(f, i);
        const bool is_constant = name == "DIM" && i != wrong;
        const bool is_element = f.name.ends_with("_BLK") && type != Generic::any_int && i != wrong;
        variables += fmt::format("a{} : {}{};\n", i, is_element ? "ARRAY[0..3] OF " : "",
                                 type_for(type, i == wrong));
        arguments +=
            fmt::format("{}{}{}{}", k == 0 ? "" : ", ", by_name ? name + " := " : std::string(),
                        is_constant ? "1" : "a" + std::to_string(i), is_element ? "[0]" : "");
    }
    const bool has_value = f.result != Generic::nothing;
    if (has_value) variables += fmt::format("made : {};\n", type_for(f.result, false));
    return fmt::format("PROGRAM p VAR\n{}END_VAR\n{}{}({});\nEND_PROGRAM\n", variables,
                       has_value ? "made := " : "", f.name, arguments);
}

std::string mistakes(const std::string& text) {
    Diagnostics out;
    (void)st::compile({st::source(text)}, standard_blocks(), out);
    return out.empty() ? "" : text + out.render(5);
}

}  // namespace

TEST_CASE("Structured Text: a standard function takes and gives what its row says") {
    for (const StandardFunction* f : st::standard_functions()) {
        const int count = f->most > f->least ? f->least + 1 : f->least;
        CHECK(mistakes(call_of(*f, count, false)) == "");
        CHECK(mistakes(call_of(*f, count, true)) == "");
    }
}

TEST_CASE("Structured Text: a standard function refuses what its row does not say") {
    for (const StandardFunction* f : st::standard_functions()) {
        for (int i = 0; i < f->least; ++i) {
            if (f->parameters[static_cast<std::size_t>(i)].type == Generic::any) continue;
            INFO(f->signature << ", argument " << i);
            CHECK(mistakes(call_of(*f, f->least, false, i)) != "");
        }
        INFO(f->signature);
        if (f->least > 0) CHECK(mistakes(call_of(*f, f->least - 1, false)) != "");
        if (f->least > 0 && f->most == f->least)
            CHECK(mistakes(call_of(*f, f->most + 1, false)) != "");
    }
}

TEST_CASE("Structured Text: arguments beyond a row's last one are counted on from it") {
    CHECK(argument_name(*st::find_standard_function("mux"), 0) == "K");
    CHECK(argument_name(*st::find_standard_function("MUX"), 11) == "IN10");
    CHECK(argument_name(*st::find_standard_function("add"), 2) == "IN3");
    CHECK(st::find_standard_function("sine") == nullptr);
}

TEST_CASE("Structured Text: each standard function has a name of its own and says what it does") {
    for (const StandardFunction* f : st::standard_functions()) {
        CHECK(st::find_standard_function(f->name) == f);
        CHECK(f->doc.size() >= 2);
    }
}

TEST_CASE("Structured Text: the reference describes each function of the prelude, and no other") {
    std::set<std::string_view> described;
    for (const st::DescribedSubject& subject : st::described_functions())
        for (const st::DescribedFunction& f : subject.functions) {
            INFO(f.signature);
            CHECK(described.insert(f.name()).second);
            CHECK(st::find_standard_function(f.name()) == nullptr);
            CHECK(f.signature.find("(") != f.signature.npos);
            CHECK(f.doc.size() >= 2);
        }
    const std::string_view text = st::standard_source()->text;
    constexpr std::string_view word = "\nFUNCTION ";
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at)) {
        at += word.size();
        const std::string_view name = text.substr(at, text.find_first_of(" \n", at) - at);
        INFO(name);
        if (st::is_in_standard_source(name)) CHECK(described.contains(name));
    }
    for (const std::string_view of_checker :
         {"ADR", "REF", "SIZEOF", "XSIZEOF", "__ISVALIDREF", "__NEW", "__DELETE", "__POUNAME",
          "__POSITION", "TypeOf", "TypeOfElements", "IS_ARRAY"})
        CHECK(described.erase(of_checker) == 1);
    for (const std::string_view name : described) {
        INFO(name);
        CHECK(st::is_in_standard_source(name));
    }
}
