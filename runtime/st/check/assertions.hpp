#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

// What others have for tests: SIMATIC AX in `AxUnit.Assert`, as `Equal(expected := 5, actual :=
// x)`, and who has TEST_PROGRAM, as `ASSERT_EQUAL(5, x)`, where what is expected comes first. Any
// build with tests knows them, in blocks too; no source declares them, since they take values of
// every type that ASSERT_EQ and the others take.

/// `AxUnit`, `AxUnit.Assert`
bool is_namespace_of_assertions(std::string_view path);

/// The call as one of ASSERT_EQ and the others; null if it is no such call.
Expression* assertion_call(Checking& c, const Expression& call);

}  // namespace lineshaft::st
