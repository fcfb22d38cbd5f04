#pragma once

#include "runtime/st/generate/places.hpp"
#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

void write_block(Writing& w, const Block& block);

// assertions.cpp

void write_test_statement(Writing& w, const Expression& e);

/// The body of a block in a build with tests begins by counting its call, and ends if it is mocked.
void count_call(Writing& w, const Location& calls, Jumps& runs);
void begin_mockable(Writing& w, const Routine& routine);

}  // namespace lineshaft::st
