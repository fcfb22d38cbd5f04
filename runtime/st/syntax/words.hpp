#pragma once

#include <algorithm>
#include <array>
#include <iterator>

#include "runtime/st/syntax/tree.hpp"

/// The words of the grammar by what they do.
namespace lineshaft::st {

struct PouWords {
    Word begin, end;
    PouKind kind;
};

inline constexpr PouWords pou_words[] = {
    {Word::program_, Word::end_program_, PouKind::program},
    {Word::organization_block_, Word::end_organization_block_, PouKind::program},
    {Word::function_block_, Word::end_function_block_, PouKind::function_block},
    {Word::function_, Word::end_function_, PouKind::function},
    {Word::data_block_, Word::end_data_block_, PouKind::data_block},
    {Word::class_, Word::end_class_, PouKind::function_block},
    {Word::interface_, Word::end_interface_, PouKind::interface},
    {Word::method_, Word::end_method_, PouKind::method}};

struct SectionWord {
    Word word;
    Section section;
};

inline constexpr SectionWord section_words[] = {
    {Word::var_, Section::local},         {Word::var_stat_, Section::static_},
    {Word::var_input_, Section::input},   {Word::var_output_, Section::output},
    {Word::var_in_out_, Section::in_out}, {Word::var_temp_, Section::temp},
    {Word::var_global_, Section::global}, {Word::var_external_, Section::external}};

/// Words that are names wherever a name may stand.
inline constexpr Word soft_words[] = {
    Word::abstract_, Word::version_,    Word::test_,      Word::setup_,
    Word::teardown_, Word::action_,     Word::class_,     Word::final_,
    Word::at_,       Word::internal_,   Word::using_,     Word::property_,
    Word::network_,  Word::method_,     Word::override_,  Word::interface_,
    Word::type_,     Word::namespace_,  Word::begin_,     Word::pointer_,
    Word::private_,  Word::public_,     Word::protected_, Word::configuration_,
    Word::super_,    Word::implements_, Word::union_};

// That may be spelt wrong where they begin or end something.
inline constexpr Word declaration_words[] = {Word::program_,        Word::organization_block_,
                                             Word::function_block_, Word::function_,
                                             Word::data_block_,     Word::type_};
inline constexpr Word variable_words[] = {Word::var_,        Word::var_stat_, Word::var_input_,
                                          Word::var_output_, Word::var_temp_, Word::var_in_out_};
inline constexpr Word end_words[] = {Word::end_var_, Word::end_struct_, Word::end_type_};
inline constexpr auto statement_words = [] {
    using enum Word;
    return std::array{if_,
                      case_,
                      for_,
                      while_,
                      repeat_,
                      exit_,
                      continue_,
                      return_,
                      else_,
                      elsif_,
                      until_,
                      end_if_,
                      end_case_,
                      end_for_,
                      end_while_,
                      end_repeat_,
                      end_function_,
                      end_function_block_,
                      end_program_,
                      end_method_,
                      end_organization_block_,
                      end_data_block_};
}();

/// Names of the types that find_elementary() has.
inline constexpr std::string_view elementary_names[] = {
    "BOOL",  "SINT",          "INT",   "DINT",           "LINT",  "USINT",
    "UINT",  "UDINT",         "ULINT", "BYTE",           "WORD",  "DWORD",
    "LWORD", "REAL",          "LREAL", "TIME",           "LTIME", "STRING",
    "DATE",  "LDATE",         "TOD",   "TIME_OF_DAY",    "LTOD",  "LTIME_OF_DAY",
    "DT",    "DATE_AND_TIME", "LDT",   "LDATE_AND_TIME", "CHAR"};

constexpr bool is_end(Word word) {
    return word >= Word::end_action_ && word <= Word::end_while_;
}

constexpr bool is_name(Word word) {
    return word == Word::name || std::ranges::find(soft_words, word) != std::end(soft_words);
}

/// Null for a word that begins no program organization unit.
constexpr const PouWords* find_pou(Word word) {
    const auto* it = std::ranges::find(pou_words, word, &PouWords::begin);
    return it == std::end(pou_words) ? nullptr : it;
}

constexpr bool ends_pou(Word word) {
    return std::ranges::find(pou_words, word, &PouWords::end) != std::end(pou_words);
}

/// `+` of `+=`, of an assignment that reckons.
constexpr Word operator_of(Word assignment) {
    return assignment == Word::plus_assign    ? Word::plus
           : assignment == Word::minus_assign ? Word::minus
           : assignment == Word::times_assign ? Word::times
                                              : Word::divided;
}

/// Null for a word that begins no section of variables.
constexpr const SectionWord* find_section(Word word) {
    const auto* it = std::ranges::find(section_words, word, &SectionWord::word);
    return it == std::end(section_words) ? nullptr : it;
}

}  // namespace lineshaft::st
