#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// What a TEST, its SETUP and its TEARDOWN may call, in the order of `test_statements`.
enum class TestCall : std::int8_t {
    none = -1,
    assert_true,
    assert_false,
    assert_eq,
    assert_neq,
    assert_gt,
    assert_lt,
    assert_ge,
    assert_le,
    assert_near,
    advance_time,
    mock,
    mock_function,
    mock_verify_called,
    mock_verify_call_count,
};

struct TestStatement {
    std::string_view name;
    int values;                         ///< arguments
    bool has_message;                   ///< a text may follow them
    Word relation = Word::end_of_file;  ///< of the two values that it asserts
};

inline constexpr TestStatement test_statements[] = {
    {"ASSERT_TRUE", 1, true},
    {"ASSERT_FALSE", 1, true},
    {"ASSERT_EQ", 2, true, Word::equal},
    {"ASSERT_NEQ", 2, true, Word::unequal},
    {"ASSERT_GT", 2, true, Word::greater},
    {"ASSERT_LT", 2, true, Word::less},
    {"ASSERT_GE", 2, true, Word::greater_or_equal},
    {"ASSERT_LE", 2, true, Word::less_or_equal},
    {"ASSERT_NEAR", 3, true},
    {"ADVANCE_TIME", 1, false},
    {"MOCK", 1, false},
    {"MOCK_FUNCTION", 2, false},
    {"MOCK_VERIFY_CALLED", 1, true},
    {"MOCK_VERIFY_CALL_COUNT", 2, true},
};

constexpr const TestStatement& info(TestCall call) {
    return test_statements[static_cast<int>(call)];
}

/// The one of a name in any case; `none` if it is none.
TestCall find_test_statement(std::string_view name);

}  // namespace lineshaft::st
