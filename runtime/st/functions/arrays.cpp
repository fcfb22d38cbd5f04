#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

// clang-format off
constexpr StandardFunction arrays[] = {
    {"LOWER_BOUND(ARR: ARRAY; DIM: ANY_INT): DINT", "the least index in dimension DIM, from 1 on",
     Typing::lower_bound, nullptr},
    {"UPPER_BOUND(ARR: ARRAY; DIM: ANY_INT): DINT", "the greatest index in dimension DIM, from 1 on",
     Typing::upper_bound, nullptr},
    {"CountOfElements(IN: ARRAY): DINT", "how many elements the array has, in all its dimensions",
     Typing::element_count, nullptr},
    {"MOVE_BLK(IN: ANY; COUNT: ANY_INT; OUT: ANY)", "copies COUNT elements from IN on, of an array, to those from OUT on, or none where there are fewer",
     Rewriting::move_block, Eno::elements},
    {"UMOVE_BLK(IN: ANY; COUNT: ANY_INT; OUT: ANY)", "the same as MOVE_BLK", Rewriting::move_block, Eno::elements},
    {"FILL_BLK(IN: ANY; COUNT: ANY_INT; OUT: ANY)", "writes IN to COUNT elements of an array, or members of a structure, from OUT on, or to none where there are fewer",
     Rewriting::fill_block, Eno::elements},
    {"UFILL_BLK(IN: ANY; COUNT: ANY_INT; OUT: ANY)", "the same as FILL_BLK", Rewriting::fill_block, Eno::elements},
    {"DEMUX(K: ANY_INT; IN: ANY; OUT0, ...: ANY)", "writes IN to the output of number K, from 0 on, or to OUTELSE if there is none",
     Rewriting::demux, Eno::chosen},
};
// clang-format on

}  // namespace

constinit const Subject array_functions{"arrays", arrays};

}  // namespace lineshaft::st
